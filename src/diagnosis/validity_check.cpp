#include "spherical_actuator_calibration/diagnosis/validity_check.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <map>
#include <set>
#include <string_view>

#include "spherical_actuator_calibration/base/text_format.hpp"
#include "spherical_actuator_calibration/estimation/distributions.hpp"

namespace sac {
namespace {

/// Largest rms norm of a common error that passes as these measurements did with 1 %.
double boundOf(const HeldOutGroup& group) {
  constexpr double kUnnoticed = 0.01;
  // Residuals that are smaller than expected by luck promise nothing.
  const double judged = std::max(group.chi_square, group.freedom());
  const double excess = chiSquareNonCentrality(group.freedom(), judged, kUnnoticed);
  return std::sqrt(excess / group.sensitivity);
}

/// The newest of the held-out samples, and of each coil the newest that it is on in: a change of
/// one coil shows in no other. Ids ascend.
std::set<std::uint32_t> newestHeldOut(const std::vector<Sample>& samples,
                                      double current_threshold) {
  std::set<std::uint32_t> newest;
  std::map<std::size_t, std::size_t> of_coil;
  for (auto sample = samples.rbegin(); sample != samples.rend(); ++sample) {
    if (!sample->validation) {
      continue;
    }
    bool is_wanted = newest.size() < kCheckedSamples;
    const bool tells_coils = sample->has_torque;
    for (const Excitation& excitation : excitedCoils(*sample, current_threshold)) {
      is_wanted = (tells_coils && of_coil[excitation.coil]++ < kCheckedSamplesOfACoil) || is_wanted;
    }
    if (is_wanted) {
      newest.insert(sample->id);
    }
  }
  return newest;
}

std::vector<Sample> heldOutOf(const std::vector<Sample>& samples) {
  std::vector<Sample> held_out;
  std::copy_if(samples.begin(), samples.end(), std::back_inserter(held_out), [](const Sample& one) {
    return one.validation;
  });
  return held_out;
}

/// Those that judge, and those in use, of which a cycle may have rejected some.
std::vector<Sample> judgedSamples(const CalibrationSession& session, CheckedSamples checked) {
  const std::vector<Sample>& all = session.samples();
  if (checked == CheckedSamples::kAll) {
    return all;
  }
  const std::set<std::uint32_t> newest =
      newestHeldOut(all, session.config().estimation.current_threshold);
  std::vector<Sample> judged;
  std::copy_if(all.begin(), all.end(), std::back_inserter(judged), [&](const Sample& sample) {
    return !sample.validation || newest.count(sample.id) > 0;
  });
  return judged;
}

/// None where every coil is judged, or torques are not modelled.
std::vector<std::size_t> coilsNotJudged(const Actuator& actuator,
                                        const HeldOutValidation& validation) {
  std::vector<std::size_t> others;
  for (std::size_t coil = 0; coil < actuator.coils.size() && actuator.torque_curve; ++coil) {
    if (validation.told_coils.count(coil) == 0) {
      others.push_back(coil);
    }
  }
  return others;
}

/// Those of the cycles that succeeded, or of the one that made the description that the session
/// starts from.
UsualOutliers outliersOf(const CalibrationSession& session) {
  const std::vector<CycleReport>& reports = session.reports();
  const auto& before = session.start().calibration;
  const bool has_success = std::any_of(
      reports.begin(), reports.end(), [](const CycleReport& one) { return one.success; });
  if (has_success || !before || before->cycles.empty() || before->cycles.back().samples_used == 0) {
    return usualOutliers(reports);
  }
  const CycleRecord& cycle = before->cycles.back();
  return {static_cast<double>(cycle.samples_rejected) / static_cast<double>(cycle.samples_used),
          {}};
}

/// Of torques that of the coil that is judged least: a change of one shows in no other.
std::string boundsInWords(const std::vector<HeldOutGroup>& groups) {
  std::string orientations;
  double torques = 0.0;
  for (const HeldOutGroup& group : groups) {
    if (group.name == kOrientations) {
      orientations = format("%.2g mrad (99 %%)", 1e3 * boundOf(group));
    } else {
      torques = std::max(torques, boundOf(group));
    }
  }
  if (!(torques > 0.0)) {
    return orientations;
  }
  return orientations + (orientations.empty() ? "" : ", torques of each coil judged to ") +
         format("%.2g mN.m (99 %%)", 1e3 * torques);
}

/// Of coils of which an outlier tells last, or nothing else.
std::string doubtInWords(const std::vector<std::size_t>& coils, CheckedSamples checked) {
  return checked == CheckedSamples::kAll
             ? "In doubt: all torques of " + coilsInWords(coils) +
                   " are outliers. Record others, and check again."
             : "In doubt: the newest held-out torque of " + coilsInWords(coils) +
                   " is an outlier. Capture another one for validation, and check again.";
}

/// What no sample tells of.
std::string unseenInWords(const std::vector<std::size_t>& coils,
                          const std::vector<Sample>& held_out) {
  if (coils.empty()) {
    return {};
  }
  const bool has_torques = std::any_of(
      held_out.begin(), held_out.end(), [](const Sample& one) { return one.has_torque; });
  return !has_torques
             ? " No sample has a torque: nothing is said of poles and coils; capture one with each "
               "coil."
             : " No sample judges " + coilsInWords(coils) +
                   ": nothing is said of them; capture one with each, where a pole is near it.";
}

/// What a few poses leave out: a joint shows where it turns.
std::string fewPosesInWords(const std::vector<Sample>& held_out) {
  constexpr std::size_t kFewest = 3;
  constexpr double kApart = 0.1;  // [rad]
  std::vector<Eigen::Vector3d> poses;
  for (std::size_t n = 0; n < held_out.size() && poses.size() < kFewest; ++n) {
    const Sample& sample = held_out[n];
    const bool is_new = std::none_of(poses.begin(), poses.end(), [&](const Eigen::Vector3d& pose) {
      return (pose - sample.joint_position).cwiseAbs().maxCoeff() < kApart;
    });
    if (is_new) {
      poses.push_back(sample.joint_position);
    }
  }
  return poses.size() < kFewest
             ? format(
                   " The samples are of %s: elsewhere more may be off; capture %zu poses or more.",
                   poses.size() == 1 ? "one pose" : "two poses",
                   kFewest)
             : "";
}

/// Of groups that contradict: one coil after the other rarely changes. But a torque of several
/// coils is in the group of each.
std::string severalInWords(const std::vector<HeldOutGroup>& groups,
                           const std::vector<Sample>& held_out,
                           double current_threshold) {
  constexpr std::string_view kNewest = "the newest of ";
  std::set<std::string> coils;
  for (const HeldOutGroup& group : groups) {
    if (group.name == kOrientations) {
      return {};
    }
    coils.insert(group.name.rfind(kNewest, 0) == 0 ? group.name.substr(kNewest.size())
                                                   : group.name);
  }
  const bool are_together = std::any_of(held_out.begin(), held_out.end(), [&](const Sample& one) {
    return one.has_torque && excitedCoils(one, current_threshold).size() > 1;
  });
  if (coils.size() > 1 && are_together) {
    return " They were excited together, so that one of them may be all: hold out torques of one "
           "coil each to tell which.";
  }
  return coils.size() > 1 ? " Several coils at once: a joint, or the rotor on it, that has moved "
                            "by less than the "
                            "tracker shows turns all poles against them, too."
                          : "";
}

}  // namespace

ValidityCheck checkValidity(const CalibrationSession& session, CheckedSamples checked) {
  ValidityCheck check;
  const std::vector<Sample> judged = judgedSamples(session, checked);
  const std::vector<Sample> held_out = heldOutOf(judged);
  const HeldOutValidation validation = validateHeldOut(
      session.model(), judged, session.state(), session.config().estimation, outliersOf(session));
  if (!validation.hasVerdict()) {
    check.message =
        "Nothing can be told: capture some poses for validation, 3 or more, and check again.";
    return check;
  }
  const std::string changed = inWords(validation.contradicting());
  const bool agrees = validation.probability >= kLeastProbability;
  const std::vector<std::size_t>& doubted =
      checked == CheckedSamples::kAll ? validation.undecided_coils : validation.doubtful_coils;
  if (agrees && !doubted.empty()) {
    check.message = doubtInWords(doubted, checked);
    return check;
  }
  const Actuator& actuator = session.start().actuator;
  check.is_valid = agrees;
  if (check.is_valid) {
    check.message = format(
                        "Valid to %s, by %zu held-out samples%s. This holds beside the "
                        "registrations: frames that "
                        "were off when the unit was calibrated, and still are, show in no sample.",
                        boundsInWords(validation.groups).c_str(),
                        validation.samples,
                        validation.outliers > 0
                            ? format(" (%zu outliers, as rare as the others', are not judged)",
                                     validation.outliers)
                                  .c_str()
                            : "") +
                    fewPosesInWords(held_out) +
                    unseenInWords(coilsNotJudged(actuator, validation), held_out);
    return check;
  }
  check.message = changed.empty() ? format(
                                        "Not valid any more: the held-out samples together misfit "
                                        "(probability %.2g).",
                                        validation.probability)
                                  : "Not valid any more: changed are " + changed + ".";
  check.message += severalInWords(
      validation.contradicting(), held_out, session.config().estimation.current_threshold);
  const Actuator in_force = session.model().space().actuatorAt(session.state().belief.x);
  check.changes = diagnoseWiring(in_force, held_out, session.config()).mistakes;
  for (const Diagnosis& change : check.changes) {
    check.message += " " + change.message;
  }
  if (check.changes.empty()) {
    check.message += " Capture new samples and calibrate again.";
  }
  return check;
}

}  // namespace sac
