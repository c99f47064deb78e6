#include "spherical_actuator_calibration/diagnosis/diagnosis.hpp"

namespace sac {

const std::vector<std::string>& wiringCauses() {
  static const std::vector<std::string> causes = {"joint_sign",
                                                  "joint_swap",
                                                  "joint_degrees",
                                                  "joint_scale",
                                                  "joint_index",
                                                  "joint_wrapped",
                                                  "joint_slipped",
                                                  "tilt_turned",
                                                  "orientation_inverted",
                                                  "quaternion_order",
                                                  "tracker_frame",
                                                  "marker_frame",
                                                  "tracker_moved",
                                                  "marker_moved",
                                                  "torque_frame",
                                                  "torque_in_stator_frame",
                                                  "torque_sign",
                                                  "torque_unit",
                                                  "torque_axis",
                                                  "torque_clipped",
                                                  "torque_stuck",
                                                  "current_sign",
                                                  "current_unit",
                                                  "coil_sign",
                                                  "coil_swap",
                                                  "coil_circle",
                                                  "coil_shift",
                                                  "coil_dead",
                                                  "coil_gain",
                                                  "pole_polarity",
                                                  "pole_missing",
                                                  "pole_gain",
                                                  "rows_shifted"};
  return causes;
}

}  // namespace sac
