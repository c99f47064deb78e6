#include "spherical_actuator_calibration/diagnosis/validity_check.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <set>

#include <boost/math/distributions/non_central_chi_squared.hpp>

#include "spherical_actuator_calibration/base/numbering.hpp"
#include "spherical_actuator_calibration/base/text_format.hpp"
#include "spherical_actuator_calibration/estimation/chi_square_limit.hpp"

namespace sac {
namespace {

constexpr char kOrientations[] = "the orientation";

/// Residuals that one kind of change would show in.
struct Group {
  std::size_t observations = 0;
  double squared_residual = 0.0;  ///< Σ ‖r‖²
  double chi_square = 0.0;

  void add(const SampleResidual& residual) {
    observations += 1;
    squared_residual += residual.residual * residual.residual;
    chi_square += 3.0 * residual.standardized * residual.standardized;
  }

  double freedom() const { return 3.0 * static_cast<double>(observations); }

  /// Of a misfit at least this large by chance.
  double probability() const { return chiSquareProbability(freedom(), chi_square); }

  /// Largest rms norm of a common error that passes as these residuals did with 1 %.
  double bound() const {
    constexpr double kUnnoticed = 0.01;
    // Residuals that are smaller than expected by luck promise nothing.
    const double judged = std::max(chi_square, freedom());
    const double excess =
        boost::math::non_central_chi_squared::find_non_centrality(freedom(), judged, kUnnoticed);
    const double variance = squared_residual / std::max(chi_square, 1e-300);
    return std::sqrt(excess * variance / static_cast<double>(observations));
  }
};

/// The newest of the held-out samples, and of each coil the newest that it is on in: a change of
/// one coil shows in no other.
std::vector<Sample> newestHeldOut(const std::vector<Sample>& samples, double current_threshold) {
  std::vector<Sample> newest;
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
      newest.push_back(*sample);
    }
  }
  std::reverse(newest.begin(), newest.end());
  return newest;
}

std::vector<Sample> allHeldOut(const std::vector<Sample>& samples) {
  std::vector<Sample> all;
  std::copy_if(samples.begin(), samples.end(), std::back_inserter(all), [](const Sample& sample) {
    return sample.validation;
  });
  return all;
}

/// "3, 5, 7"; empty where samples with torques tell of every coil, or there are none.
std::string coilsNotSeen(const Actuator& actuator,
                         const std::vector<Sample>& samples,
                         double current_threshold) {
  std::set<std::size_t> seen;
  for (const Sample& sample : samples) {
    for (const Excitation& excitation : excitedCoils(sample, current_threshold)) {
      if (sample.has_torque) {
        seen.insert(excitation.coil);
      }
    }
  }
  std::string numbers;
  for (std::size_t coil = 0; coil < actuator.coils.size() && !seen.empty(); ++coil) {
    if (seen.count(coil) == 0) {
      numbers += (numbers.empty() ? "" : ", ") + std::to_string(numberOf(coil));
    }
  }
  return numbers;
}

std::string coilsInWords(const std::vector<Excitation>& excited) {
  constexpr std::size_t kMostNamed = 3;
  if (excited.size() > kMostNamed) {
    return "several coils together";
  }
  std::string words;
  for (const Excitation& excitation : excited) {
    words += (words.empty() ? "coil " : " with coil ") + std::to_string(numberOf(excitation.coil));
  }
  return words.empty() ? "torques without current" : words;
}

/// Orientations, and torques by the coils that are on: "the orientation", "coil 3", "coil 3 with
/// coil 7".
std::map<std::string, Group> groupsOf(const std::vector<Sample>& samples,
                                      const HeldOutValidation& validation,
                                      double current_threshold) {
  std::map<std::string, Group> groups;
  for (const SampleResidual& residual : validation.residuals) {
    if (residual.rejected) {
      continue;
    }
    if (residual.quantity == Quantity::kOrientation) {
      groups[kOrientations].add(residual);
      continue;
    }
    const auto sample = std::find_if(
        samples.begin(), samples.end(), [&](const Sample& one) { return one.id == residual.id; });
    groups[coilsInWords(excitedCoils(*sample, current_threshold))].add(residual);
  }
  return groups;
}

/// At which the last cycle that succeeded rejected single measurements, or the one that made the
/// description that the session starts from.
double usualOutlierRate(const CalibrationSession& session) {
  const std::vector<CycleReport>& reports = session.reports();
  const auto last = std::find_if(
      reports.rbegin(), reports.rend(), [](const CycleReport& one) { return one.success; });
  if (last != reports.rend()) {
    return outlierRate(*last);
  }
  const auto& before = session.start().calibration;
  if (!before || before->cycles.empty() || before->cycles.back().samples_used == 0) {
    return 0.0;
  }
  const CycleRecord& cycle = before->cycles.back();
  return static_cast<double>(cycle.samples_rejected) / static_cast<double>(cycle.samples_used);
}

/// Of torques that of the coil that is judged least: a change of one shows in no other.
std::string boundsInWords(const std::map<std::string, Group>& groups) {
  std::string text;
  double torques = 0.0;
  for (const auto& [name, group] : groups) {
    if (name == kOrientations) {
      text = format("%.2g mrad (99 %%)", 1e3 * group.bound());
    } else {
      torques = std::max(torques, group.bound());
    }
  }
  if (torques > 0.0) {
    text += (text.empty() ? "" : ", torques of each coil judged to ") +
            format("%.2g mN.m (99 %%)", 1e3 * torques);
  }
  return text;
}

/// What no sample tells of.
std::string unseenInWords(const std::string& coils) {
  return coils.empty() ? ""
                       : " No sample judges coils " + coils +
                             ": nothing is said of them; capture one with each.";
}

}  // namespace

ValidityCheck checkValidity(const CalibrationSession& session, CheckedSamples checked) {
  ValidityCheck check;
  const double threshold = session.config().estimation.current_threshold;
  const std::vector<Sample> newest = checked == CheckedSamples::kAll
                                         ? allHeldOut(session.samples())
                                         : newestHeldOut(session.samples(), threshold);
  const HeldOutValidation validation = validateHeldOut(session.model(),
                                                       newest,
                                                       session.state(),
                                                       session.config().estimation,
                                                       usualOutlierRate(session));
  if (!validation.hasVerdict()) {
    check.message =
        "Nothing can be told: capture some poses for validation, 3 or more, and check again.";
    return check;
  }
  const std::map<std::string, Group> groups = groupsOf(newest, validation, threshold);
  const double least = kLeastProbability / static_cast<double>(groups.size() + 1);
  std::string changed;
  for (const auto& [name, group] : groups) {
    const double probability = group.probability();
    if (probability < least) {
      changed += (changed.empty() ? "" : ", ") + name +
                 format(" (chi-square %.3g of %.0f, probability %.2g)",
                        group.chi_square,
                        group.freedom(),
                        probability);
    }
  }
  check.is_valid = changed.empty() && validation.probability >= least;
  if (check.is_valid) {
    check.message = format(
                        "Valid to %s, by %zu held-out samples%s. This holds beside the "
                        "registrations: frames that "
                        "were off when the unit was calibrated, and still are, show in no sample.",
                        boundsInWords(groups).c_str(),
                        validation.samples,
                        validation.outliers > 0
                            ? format(" (%zu outliers, as rare as the others', are not judged)",
                                     validation.outliers)
                                  .c_str()
                            : "") +
                    unseenInWords(coilsNotSeen(session.start().actuator, newest, threshold));
    return check;
  }
  check.message = changed.empty() ? format(
                                        "Not valid any more: the held-out samples together misfit "
                                        "(probability %.2g).",
                                        validation.probability)
                                  : "Not valid any more: changed are " + changed + ".";
  const Actuator in_force = session.model().space().actuatorAt(session.state().belief.x);
  check.changes = diagnoseWiring(in_force, newest, session.config()).mistakes;
  for (const Diagnosis& change : check.changes) {
    check.message += " " + change.message;
  }
  if (check.changes.empty()) {
    check.message += " Capture new samples and calibrate again.";
  }
  return check;
}

}  // namespace sac
