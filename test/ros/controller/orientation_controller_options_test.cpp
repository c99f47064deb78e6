#include "spherical_actuator_calibration/ros/controller/orientation_controller_options.hpp"

#include <vector>

#include <gtest/gtest.h>

#include "spherical_actuator_calibration/actuator/description_file.hpp"
#include "support/source_dir.hpp"

namespace sac {
namespace {

std::vector<double> controllerNumbers(const OrientationControllerOptions& options) {
  const Eigen::Matrix3d& J = options.rotor.inertia;
  return {J(0, 0),
          J(1, 1),
          J(2, 2),
          options.rotor.unbalance.norm(),
          options.gains.proportional,
          options.gains.derivative,
          options.motion_gains.proportional,
          options.motion_gains.derivative,
          options.disturbance.bandwidth,
          options.disturbance.largest_torque,
          options.allocation.current_limit,
          options.total_current_limit,
          options.square_current_limit,
          options.allocation.least_singular_value,
          options.largest_age,
          options.velocity_cutoff,
          options.workspace_margin,
          options.largest_tracking_error,
          options.reference.natural_frequency,
          options.reference.largest_rate,
          options.reference.largest_acceleration,
          options.reference.largest_gap};
}

TEST(OrientationControllerOptions, TheShippedFileTellsDefaults) {
  const Actuator design = loadDescription(SOURCE_DIR "/config/pm_spherical_8x24.yaml").actuator;
  const OrientationControllerNodeOptions defaults =
      readOrientationControllerOptions(YamlMap::parse("{}", "c.yaml"), design);
  const OrientationControllerNodeOptions shipped = readOrientationControllerOptions(
      YamlMap::load(SOURCE_DIR "/config/orientation_controller.yaml"), design);
  EXPECT_EQ(shipped.stator_frame, defaults.stator_frame);
  EXPECT_EQ(controllerNumbers(shipped.controller), controllerNumbers(defaults.controller));
}

}  // namespace
}  // namespace sac
