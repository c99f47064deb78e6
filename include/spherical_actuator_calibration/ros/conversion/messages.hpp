#pragma once

/// The messages of this package, as sac::msg: types of the core and messages may share a short name
/// (sac::JointAxis, sac::msg::JointAxis). Include the generated headers beside this one.
namespace spherical_actuator_calibration {}

namespace sac {
namespace msg = ::spherical_actuator_calibration;
}  // namespace sac
