#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "spherical_actuator_calibration/actuator/description_file.hpp"
#include "spherical_actuator_calibration/calibration/calibration_config.hpp"
#include "spherical_actuator_calibration/calibration/frame_registration.hpp"

namespace sac {

struct LiveRegistrationOptions {
  std::string ns = "/actuator";  ///< namespace of the actuator's topics
  std::size_t poses = 12;        ///< so many different ones are enough
  double duration = 1.0;         ///< that a pose is averaged over [s]
};

/// Starts ROS for the live form: name of the node register_frames; SIGINT and SIGTERM end the wait.
void initializeRos(int argc, char** argv);

/// The description on the parameter server. Throws ConfigError as loadDescriptionParameter().
CalibratedDescription describedActuator(const std::string& ns);

/// Takes a pose of every rest of the rotor, while an operator or coils turn it, and says so on the
/// standard output; returns when there are enough that give a registration, or at a signal.
std::vector<TrackedPose> takePosesLive(const CalibratedDescription& description,
                                       const CalibrationConfig& config,
                                       const LiveRegistrationOptions& options);

}  // namespace sac
