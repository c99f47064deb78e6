#include "spherical_actuator_calibration/calibration/held_out_validation.hpp"

#include <algorithm>
#include <iterator>
#include <utility>

#include "cycle_conclusion.hpp"
#include "spherical_actuator_calibration/base/numbering.hpp"
#include "spherical_actuator_calibration/base/text_format.hpp"
#include "spherical_actuator_calibration/estimation/distributions.hpp"

namespace sac {

double HeldOutGroup::probability() const {
  return chiSquareProbability(freedom(), std::max(chi_square, 0.0));
}

double HeldOutValidation::leastOfAGroup() const {
  return kLeastProbability / static_cast<double>(groups.size() + 1);
}

std::vector<HeldOutGroup> HeldOutValidation::contradicting() const {
  std::vector<HeldOutGroup> found;
  std::copy_if(groups.begin(), groups.end(), std::back_inserter(found), [this](const auto& group) {
    return group.probability() < leastOfAGroup();
  });
  std::sort(found.begin(), found.end(), [](const HeldOutGroup& one, const HeldOutGroup& other) {
    const auto rank = [](const HeldOutGroup& group) {
      return std::pair(group.probability(), -group.chi_square / group.freedom());
    };
    return rank(one) < rank(other);
  });
  return found;
}

std::string inWords(const std::vector<HeldOutGroup>& groups) {
  constexpr std::size_t kMostNamed = 4;
  std::string words;
  for (std::size_t n = 0; n < std::min(kMostNamed, groups.size()); ++n) {
    const HeldOutGroup& group = groups[n];
    words += (words.empty() ? "" : ", ") + group.name +
             format(" (chi-square %.3g of %.0f, probability %.2g)",
                    group.chi_square,
                    group.freedom(),
                    group.probability());
  }
  return groups.size() > kMostNamed ? words + format(" and %zu more", groups.size() - kMostNamed)
                                    : words;
}

std::string coilsInWords(const std::vector<std::size_t>& coils) {
  std::string words = coils.size() == 1 ? "coil " : "coils ";
  for (const std::size_t coil : coils) {
    words += (coil == coils.front() ? "" : ", ") + std::to_string(numberOf(coil));
  }
  return words;
}

UsualOutliers usualOutliers(const std::vector<CycleReport>& reports) {
  UsualOutliers outliers;
  for (const CycleReport& report : reports) {
    if (!report.success) {
      continue;
    }
    std::size_t rejected = 0;
    for (const SampleResidual& residual : report.residuals) {
      rejected += residual.rejected ? 1U : 0U;
      // Those of a motion are of windows.
      if (residual.quantity == Quantity::kTorque && !report.motion) {
        outliers.torques[residual.id] = residual.rejected;
      }
    }
    const std::size_t count = std::max<std::size_t>(1, report.residuals.size());
    outliers.rate = static_cast<double>(rejected) / static_cast<double>(count);
  }
  return outliers;
}

HeldOutValidation validationOf(const HeldOutMotion& motion) {
  HeldOutValidation result;
  result.is_of_windows = true;
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
  std::string text = format("%zu held-out %s:", validation.samples, validation.things());
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
    text += format(" %zu measurements that repeat others are not judged,", validation.repeated);
  }
  if (validation.outliers > 0) {
    text += format(" %zu outliers, no more than among the others, are not judged,",
                   validation.outliers);
  }
  text += format(" reduced chi-square %.3g (probability %.2g): ",
                 validation.reduced_chi_square,
                 validation.probability);
  const std::vector<HeldOutGroup> contradicting = validation.contradicting();
  if (!contradicting.empty()) {
    return text + "they contradict the parameters in force, by " + inWords(contradicting) +
           ". Look at the largest standardized residuals; then calibrate again.";
  }
  if (validation.probability < kLeastProbability) {
    return text +
           "they contradict the parameters in force. Look at the largest standardized residuals; "
           "then calibrate again.";
  }
  text += "they agree with the parameters within the stated uncertainties.";
  if (validation.torques > validation.unjudged_torques && !validation.judgesCoils()) {
    text +=
        " No torque says anything of poles and coils: hold out others, with poles near the coil.";
  }
  if (!validation.undecided_coils.empty()) {
    text += " Torques of " + coilsInWords(validation.undecided_coils) +
            " are outliers alone: hold out others.";
  }
  return text;
}

}  // namespace sac
