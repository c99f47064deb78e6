#include "spherical_actuator_calibration/measurement/sample.hpp"

#include <cmath>
#include <string>

#include <Eigen/LU>

#include "spherical_actuator_calibration/base/error.hpp"

namespace sac {
namespace {

constexpr double kRotationTolerance = 1e-6;

/// Checks the fields of one sample; messages name it.
class SampleCheck {
 public:
  explicit SampleCheck(const Sample& sample)
      : name_("Sample " + std::to_string(sample.id) + ": ") {}

  void require(bool condition, const std::string& sentence) const {
    if (!condition) {
      throw DataError(name_ + sentence);
    }
  }

  /// Where no uncertainty is stated, another one is assumed for the whole.
  void requirePart(double value, double whole, const std::string& field) const {
    requireUncertainty(value, field);
    require(value <= whole || whole == 0.0, field + " exceeds the whole uncertainty.");
  }

  void requireUncertainty(double value, const std::string& field) const {
    require(std::isfinite(value), field + " is not finite.");
    require(value >= 0.0, field + " is negative.");
  }

 private:
  std::string name_;
};

bool isRotation(const Eigen::Matrix3d& R) {
  const double deviation = (R * R.transpose() - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff();
  return deviation <= kRotationTolerance && R.determinant() > 0.0;
}

}  // namespace

void validate(const Sample& sample, std::size_t coils) {
  const SampleCheck check(sample);
  check.require(sample.joint_position.allFinite(), "joint_position is not finite.");
  for (Eigen::Index k = 0; k < sample.joint_stddev.size(); ++k) {
    check.requireUncertainty(sample.joint_stddev[k], "joint_stddev");
    check.requirePart(sample.joint_shared_stddev[k], sample.joint_stddev[k], "joint_shared_stddev");
  }
  check.requireUncertainty(sample.duration, "duration");
  check.require(sample.current.allFinite(), "current is not finite.");
  if (sample.has_orientation) {
    check.require(sample.R_stator_rotor.allFinite(), "orientation is not finite.");
    check.require(isRotation(sample.R_stator_rotor), "orientation is not a rotation.");
    check.requireUncertainty(sample.orientation_stddev, "orientation_stddev");
  }
  if (sample.has_torque) {
    check.require(sample.torque.allFinite(), "torque is not finite.");
    check.requireUncertainty(sample.torque_stddev, "torque_stddev");
    check.requirePart(sample.torque_shared_stddev, sample.torque_stddev, "torque_shared_stddev");
    check.require(static_cast<std::size_t>(sample.current.size()) == coils,
                  "current has " + std::to_string(sample.current.size()) +
                      " entries, but the actuator has " + std::to_string(coils) + " coils.");
  }
}

}  // namespace sac
