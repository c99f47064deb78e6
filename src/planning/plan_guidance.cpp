#include "spherical_actuator_calibration/planning/plan_guidance.hpp"

#include <algorithm>
#include <cstddef>

#include "spherical_actuator_calibration/base/numbering.hpp"
#include "spherical_actuator_calibration/base/pi.hpp"
#include "spherical_actuator_calibration/base/text_format.hpp"
#include "spherical_actuator_calibration/estimation/calibration_model.hpp"

namespace sac {
namespace {

constexpr double kSamePose = 0.1;  // [rad]

bool isAt(const Sample& sample, const PlannedPose& pose) {
  return !sample.validation &&
         (sample.joint_position - pose.joint_position).cwiseAbs().maxCoeff() <= kSamePose;
}

/// Coils of the pose that no sample there excites alone.
std::vector<std::size_t> openCoils(const PlannedPose& pose,
                                   const std::vector<Sample>& samples,
                                   double current_threshold) {
  std::vector<std::size_t> open = pose.coils;
  for (const Sample& sample : samples) {
    if (!isAt(sample, pose)) {
      continue;
    }
    const std::vector<Excitation> excited = excitedCoils(sample, current_threshold);
    if (excited.size() == 1) {
      open.erase(std::remove(open.begin(), open.end(), excited.front().coil), open.end());
    }
  }
  return open;
}

bool hasSample(const PlannedPose& pose, const std::vector<Sample>& samples) {
  return std::any_of(
      samples.begin(), samples.end(), [&](const Sample& sample) { return isAt(sample, pose); });
}

std::string coilsInWords(const std::vector<std::size_t>& coils) {
  std::string text;
  for (std::size_t i = 0; i < coils.size(); ++i) {
    text += (i == 0 ? "" : i + 1 == coils.size() ? " and " : ", ");
    text += std::to_string(numberOf(coils[i]));
  }
  return text;
}

}  // namespace

std::string planStep(const std::vector<PlannedPose>& poses,
                     const std::vector<Sample>& samples,
                     double current_threshold) {
  std::size_t measured = 0;
  const PlannedPose* next = nullptr;
  std::vector<std::size_t> next_coils;
  for (const PlannedPose& pose : poses) {
    const std::vector<std::size_t> open = openCoils(pose, samples, current_threshold);
    if (open.empty() && hasSample(pose, samples)) {
      ++measured;
    } else if (next == nullptr) {
      next = &pose;
      next_coils = open;
    }
  }
  if (next == nullptr) {
    return "";
  }
  const Eigen::Vector3d& q = next->joint_position;
  const Eigen::Vector3d degrees = q / kOneDegree;
  std::string text = format(
      "Go on with the plan, %zu of %zu poses are measured: turn the rotor to "
      "joints %.2f, %.2f, %.2f rad (%.0f, %.0f, %.0f deg) and capture",
      measured,
      poses.size(),
      q.x(),
      q.y(),
      q.z(),
      degrees.x(),
      degrees.y(),
      degrees.z());
  if (!next_coils.empty()) {
    text += " without current, then with coil " + coilsInWords(next_coils) +
            (next_coils.size() == 1 ? " excited" : " excited in turn");
  }
  return text + ".";
}

}  // namespace sac
