#include "spherical_actuator_calibration/calibration/held_out_validation.hpp"

#include <algorithm>

#include "cycle_conclusion.hpp"
#include "spherical_actuator_calibration/base/text_format.hpp"

namespace sac {

double outlierRate(const CycleReport& report) {
  const auto rejected = std::count_if(
      report.residuals.begin(), report.residuals.end(), [](const SampleResidual& residual) {
        return residual.rejected;
      });
  const std::size_t count = std::max<std::size_t>(1, report.residuals.size());
  return static_cast<double>(rejected) / static_cast<double>(count);
}

HeldOutValidation validationOf(const HeldOutMotion& motion) {
  HeldOutValidation result;
  result.samples = motion.windows;
  result.torques = motion.windows;
  result.torque_rms = motion.torque_rms;
  result.orientations = motion.orientations;
  result.orientation_rms = motion.orientation_rms;
  result.reduced_chi_square = motion.reduced_chi_square;
  result.probability = motion.probability;
  for (const ObservationResidual& from : motion.residuals) {
    const auto id = static_cast<std::uint32_t>(from.observation.sample + 1);
    result.residuals.push_back(reportedResidual(from, id));
  }
  return result;
}

const HeldOutValidation& severer(const HeldOutValidation& one, const HeldOutValidation& other) {
  if (!one.hasVerdict()) {
    return other.samples > 0 ? other : one;
  }
  return other.hasVerdict() && other.probability < one.probability ? other : one;
}

std::string verdict(const HeldOutValidation& validation) {
  if (!validation.hasVerdict() && validation.unjudged_torques > 0) {
    return "The held-out samples are torques of coils that are not calibrated: calibrate these "
           "first.";
  }
  if (!validation.hasVerdict()) {
    return "No held-out sample can judge: capture some poses with validation set.";
  }
  std::string text = format("%zu held-out samples:", validation.samples);
  if (validation.orientations > 0) {
    text += format(" orientation rms %.3g mrad,", 1e3 * validation.orientation_rms);
  }
  if (validation.torques > 0) {
    text += format(" torque rms %.3g mN.m,", 1e3 * validation.torque_rms);
  }
  if (validation.unjudged_torques > 0) {
    text += format(" %zu torques of coils that are not calibrated are not judged,",
                   validation.unjudged_torques);
  }
  if (validation.repeated > 0) {
    text += format(" %zu measurements that repeat others bit for bit are not judged,",
                   validation.repeated);
  }
  if (validation.outliers > 0) {
    text += format(" %zu outliers, no more than among the others, are not judged,",
                   validation.outliers);
  }
  text += format(" reduced chi-square %.3g (probability %.2g): ",
                 validation.reduced_chi_square,
                 validation.probability);
  if (validation.probability < kLeastProbability) {
    return text +
           "they contradict the parameters in force. Look at the largest standardized residuals; "
           "then calibrate again.";
  }
  return text + "they agree with the parameters within the stated uncertainties.";
}

}  // namespace sac
