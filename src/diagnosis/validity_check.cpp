#include "spherical_actuator_calibration/diagnosis/validity_check.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include <boost/math/distributions/non_central_chi_squared.hpp>

#include "spherical_actuator_calibration/base/numbering.hpp"
#include "spherical_actuator_calibration/base/text_format.hpp"
#include "spherical_actuator_calibration/estimation/chi_square_limit.hpp"

namespace sac {
namespace {

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

/// The samples in use, with only the newest of the held-out ones held out.
std::vector<Sample> newestHeldOut(const std::vector<Sample>& samples) {
  std::vector<Sample> newest;
  for (auto sample = samples.rbegin(); sample != samples.rend() && newest.size() < kCheckedSamples;
       ++sample) {
    if (sample->validation) {
      newest.push_back(*sample);
    }
  }
  std::reverse(newest.begin(), newest.end());
  return newest;
}

/// Orientations, and torques by the coil that is on: "the orientation", "coil 3".
std::map<std::string, Group> groupsOf(const std::vector<Sample>& samples,
                                      const HeldOutValidation& validation,
                                      double current_threshold) {
  std::map<std::string, Group> groups;
  for (const SampleResidual& residual : validation.residuals) {
    if (residual.rejected) {
      continue;
    }
    if (residual.quantity == Quantity::kOrientation) {
      groups["the orientation"].add(residual);
      continue;
    }
    const auto sample = std::find_if(
        samples.begin(), samples.end(), [&](const Sample& one) { return one.id == residual.id; });
    const std::vector<Excitation> excited = excitedCoils(*sample, current_threshold);
    groups[excited.size() == 1 ? "coil " + std::to_string(numberOf(excited.front().coil))
                               : "several coils together"]
        .add(residual);
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

std::string boundsInWords(const std::map<std::string, Group>& groups) {
  std::string text;
  Group torques;
  for (const auto& [name, group] : groups) {
    if (name == "the orientation") {
      text = format("%.2g mrad (99 %%)", 1e3 * group.bound());
    } else {
      torques.observations += group.observations;
      torques.squared_residual += group.squared_residual;
      torques.chi_square += group.chi_square;
    }
  }
  if (torques.observations > 0) {
    text +=
        (text.empty() ? "" : ", torques to ") + format("%.2g mN.m (99 %%)", 1e3 * torques.bound());
  }
  return text;
}

}  // namespace

ValidityCheck checkValidity(const CalibrationSession& session) {
  ValidityCheck check;
  const std::vector<Sample> newest = newestHeldOut(session.samples());
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
  const std::map<std::string, Group> groups =
      groupsOf(newest, validation, session.config().estimation.current_threshold);
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
        "Valid to %s, by %zu held-out samples%s. This holds beside the registrations: frames that "
        "were off when the unit was calibrated, and still are, show in no sample.",
        boundsInWords(groups).c_str(),
        validation.samples,
        validation.outliers > 0
            ? format(" (%zu outliers, as rare as the others', are not judged)", validation.outliers)
                  .c_str()
            : "");
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
