#include "spherical_actuator_calibration/calibration/cycle_selection.hpp"

#include <algorithm>
#include <charconv>
#include <cstddef>
#include <iterator>
#include <utility>

#include "samples_per_coil.hpp"
#include "spherical_actuator_calibration/base/error.hpp"
#include "spherical_actuator_calibration/base/numbering.hpp"
#include "spherical_actuator_calibration/calibration/cycle_demand.hpp"

namespace sac {
namespace {

[[noreturn]] void throwUnknown(const std::string& word) {
  throw ConfigError("The cycle \"" + word +
                    "\" is unknown: give joint, poles:J, coil:J (J counts coils from 1), coils, "
                    "refine or motion, separated by commas.");
}

/// The coil of a number: digits only, from 1.
std::optional<std::size_t> parseCoil(const std::string& digits, const std::string& word) {
  std::size_t number = 0;
  const char* end = digits.data() + digits.size();
  const std::from_chars_result result = std::from_chars(digits.data(), end, number);
  if (result.ec != std::errc{} || result.ptr != end || number == 0) {
    throwUnknown(word);
  }
  return indexOf(number);
}

CycleRequest parseCycle(const std::string& word) {
  if (word == "joint") {
    return {Cycle::kJoint};
  }
  if (word == "coils") {
    return {Cycle::kCoil};
  }
  if (word == "refine") {
    return {Cycle::kRefine};
  }
  if (word == "motion") {
    return {Cycle::kMotion};
  }
  const std::size_t colon = word.find(':');
  const std::string name = word.substr(0, colon);
  if (colon == std::string::npos || (name != "poles" && name != "coil")) {
    throwUnknown(word);
  }
  return {name == "poles" ? Cycle::kPoles : Cycle::kCoil, parseCoil(word.substr(colon + 1), word)};
}

/// Samples that serve, of one pose at most so many, up to `enough` in all. Poses differ by the
/// least motion in some joint.
template <typename Serves>
std::size_t samplesOfPoses(const std::vector<Sample>& samples,
                           double least_motion,
                           std::size_t most_of_a_pose,
                           std::size_t enough,
                           const Serves& serves) {
  std::vector<std::pair<Eigen::Vector3d, std::size_t>> poses;
  std::size_t count = 0;
  for (const Sample& sample : samples) {
    if (count == enough) {
      break;
    }
    if (sample.validation || !serves(sample)) {
      continue;
    }
    auto pose = std::find_if(poses.begin(), poses.end(), [&](const auto& known) {
      return (known.first - sample.joint_position).cwiseAbs().maxCoeff() < least_motion;
    });
    if (pose == poses.end()) {
      pose = poses.insert(poses.end(), {sample.joint_position, 0});
    }
    count += ++pose->second <= most_of_a_pose ? 1 : 0;
  }
  return count;
}

bool hasOrientation(const Sample& sample) {
  return sample.has_orientation;
}

bool hasTorque(const Sample& sample) {
  return sample.has_torque;
}

}  // namespace

std::vector<std::size_t> samplesPerCoil(const CalibrationModel& model,
                                        const std::vector<Sample>& samples,
                                        const EstimationOptions& options) {
  std::vector<std::size_t> counts(model.hasTorqueModel() ? model.space().coils() : 0, 0);
  if (counts.empty()) {
    return counts;
  }
  for (const Sample& sample : samples) {
    if (sample.validation || !sample.has_torque) {
      continue;
    }
    const std::vector<Excitation> excited = excitedCoils(sample, options.current_threshold);
    if (excited.size() == 1) {
      ++counts.at(excited.front().coil);
    }
  }
  return counts;
}

std::vector<CycleRequest> parseCycles(const std::string& text) {
  std::vector<CycleRequest> requests;
  for (std::size_t begin = 0; begin <= text.size();) {
    const std::size_t end = std::min(text.find(',', begin), text.size());
    requests.push_back(parseCycle(text.substr(begin, end - begin)));
    begin = end + 1;
  }
  return requests;
}

std::vector<CycleRequest> expandCoils(const std::vector<CycleRequest>& requests,
                                      const CalibrationModel& model,
                                      const std::vector<Sample>& samples,
                                      const EstimationOptions& options) {
  const std::vector<std::size_t> counts = samplesPerCoil(model, samples, options);
  std::vector<CycleRequest> expanded;
  const auto is_covered = [&](std::size_t coil) {
    return std::any_of(expanded.begin(), expanded.end(), [&](const CycleRequest& request) {
      return request.coil == coil;
    });
  };
  for (const CycleRequest& request : requests) {
    if (request.cycle != Cycle::kCoil || request.coil) {
      expanded.push_back(request);
      continue;
    }
    for (std::size_t coil = 0; coil < counts.size(); ++coil) {
      if (counts[coil] > 0 && !is_covered(coil)) {
        expanded.push_back({Cycle::kCoil, coil});
      }
    }
  }
  return expanded;
}

std::vector<CycleRequest> possibleCycles(const CalibrationModel& model,
                                         const std::vector<Sample>& samples,
                                         const EstimationOptions& options) {
  std::vector<CycleRequest> requests;
  const bool has_orientations =
      std::any_of(samples.begin(), samples.end(), [](const Sample& sample) {
        return sample.has_orientation && !sample.validation;
      });
  if (has_orientations) {
    requests.push_back({Cycle::kJoint});
  }
  const std::vector<std::size_t> counts = samplesPerCoil(model, samples, options);
  const auto most = std::max_element(counts.begin(), counts.end());
  const bool has_torques = most != counts.end() && *most > 0;
  if (has_torques) {
    const auto coil = static_cast<std::size_t>(std::distance(counts.begin(), most));
    requests.push_back({Cycle::kPoles, coil});
    requests.push_back({Cycle::kCoil});
  }
  const bool models_effects = model.space().effects().size() > 0;
  if (has_torques || (has_orientations && models_effects)) {
    requests.push_back({Cycle::kRefine});
  }
  return expandCoils(requests, model, samples, options);
}

std::size_t usefulOrientations(const std::vector<Sample>& samples,
                               const EstimationOptions& options,
                               std::size_t enough) {
  constexpr std::size_t kMostOfAPose = 3;
  return samplesOfPoses(samples, options.min_joint_motion, kMostOfAPose, enough, hasOrientation);
}

std::vector<CycleRequest> nextCycles(const CalibrationModel& model,
                                     const std::vector<Sample>& samples,
                                     const EstimationOptions& options) {
  const std::vector<std::size_t> counts = samplesPerCoil(model, samples, options);
  const auto has_poses = [&](std::size_t needed, const auto& serves) {
    return samplesOfPoses(samples, options.min_joint_motion, 1, needed, serves) == needed;
  };
  std::vector<CycleRequest> cycles;
  const auto has_samples = [&](const CycleRequest& request) {
    const std::size_t needed = demandOf(request.cycle, model.space().poles()).needed;
    switch (request.cycle) {
      case Cycle::kJoint:
        return has_poses(needed, hasOrientation);
      case Cycle::kPoles:
      case Cycle::kCoil:
        return counts.at(request.coil.value()) >= needed;
      case Cycle::kRefine:
      case Cycle::kMotion:
        break;
    }
    // What one cycle has enough of, all at once have; without, torques of several coils at a time.
    return !cycles.empty() || has_poses(needed, hasTorque);
  };
  bool has_poles = false;
  for (const CycleRequest& request : possibleCycles(model, samples, options)) {
    if (!has_samples(request)) {
      continue;
    }
    has_poles = has_poles || request.cycle == Cycle::kPoles;
    if (request.cycle != Cycle::kCoil || has_poles) {
      cycles.push_back(request);
    }
  }
  return cycles;
}

std::string cycleText(const CycleRequest& request) {
  const bool has_coil = request.cycle == Cycle::kPoles || request.cycle == Cycle::kCoil;
  return cycleName(request.cycle) +
         (has_coil ? ":" + std::to_string(numberOrZero(request.coil)) : "");
}

}  // namespace sac
