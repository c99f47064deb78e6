#include "spherical_actuator_calibration/ros/conversion/progress_conversion.hpp"

#include <algorithm>
#include <cstdlib>
#include <iterator>
#include <string>

#include "spherical_actuator_calibration/base/error.hpp"
#include "spherical_actuator_calibration/base/numbering.hpp"

namespace sac {
namespace {

std::vector<msg::CoilPattern> patternsToRos(const std::vector<CoilPattern>& patterns) {
  std::vector<msg::CoilPattern> messages;
  messages.reserve(patterns.size());
  std::transform(patterns.begin(), patterns.end(), std::back_inserter(messages), patternToRos);
  return messages;
}

}  // namespace

msg::CoilPattern patternToRos(const CoilPattern& pattern) {
  msg::CoilPattern message;
  for (const SignedCoil& coil : pattern) {
    message.coils.push_back(coil.sign * static_cast<std::int32_t>(numberOf(coil.coil)));
  }
  return message;
}

CoilPattern patternFromRos(const std::vector<std::int32_t>& signed_numbers, std::size_t coils) {
  CoilPattern pattern;
  std::size_t before = 0;
  for (const std::int32_t signed_number : signed_numbers) {
    const auto number =
        static_cast<std::size_t>(std::abs(static_cast<std::int64_t>(signed_number)));
    if (number <= before || number > coils) {
      throw ConfigError("coils: numbers from 1 to " + std::to_string(coils) +
                        " in ascending order, negative where the current is.");
    }
    pattern.push_back({indexOf(number).value(), signed_number < 0 ? -1 : 1});
    before = number;
  }
  return pattern;
}

PoseToMeasure poseFromRos(const msg::PosePatterns& message, std::size_t coils) {
  PoseToMeasure pose;
  pose.joint_position = Eigen::Vector3d(message.joint_position.data());
  if (!pose.joint_position.allFinite()) {
    throw ConfigError("joint_position: an angle is not finite.");
  }
  for (const msg::CoilPattern& pattern : message.patterns) {
    if (pattern.coils.empty()) {
      throw ConfigError("patterns: each has a coil; without current it goes without saying.");
    }
    pose.patterns.push_back(patternFromRos(pattern.coils, coils));
  }
  pose.validation = message.validation != 0;
  return pose;
}

msg::PosePatterns poseToRos(const PoseToMeasure& pose) {
  msg::PosePatterns message;
  std::copy_n(
      pose.joint_position.data(), pose.joint_position.size(), message.joint_position.begin());
  message.patterns = patternsToRos(pose.patterns);
  message.validation = static_cast<std::uint8_t>(pose.validation);
  return message;
}

msg::PoseProgress progressToRos(const PoseProgress& progress) {
  msg::PoseProgress message;
  message.pose = poseToRos(progress.pose());
  message.has_current = static_cast<std::uint8_t>(progress.hasCurrent());
  message.has_sample = static_cast<std::uint8_t>(progress.hasSample());
  message.is_measured = static_cast<std::uint8_t>(progress.isMeasured());
  message.missing = patternsToRos(progress.missing());
  return message;
}

std::vector<msg::PoseProgress> progressToRos(const std::vector<PoseProgress>& poses) {
  std::vector<msg::PoseProgress> messages;
  messages.reserve(poses.size());
  std::transform(
      poses.begin(), poses.end(), std::back_inserter(messages), [](const PoseProgress& pose) {
        return progressToRos(pose);
      });
  return messages;
}

}  // namespace sac
