#include "spherical_actuator_calibration/measurement/sample.hpp"

#include <cmath>
#include <string>

#include <Eigen/LU>

#include "spherical_actuator_calibration/actuator/inverse_kinematics.hpp"
#include "spherical_actuator_calibration/base/error.hpp"

namespace sac {
namespace {

constexpr double kRotationTolerance = 1e-6;

/// The first that a stamp of ROS cannot hold: 2^32 s.
constexpr Stamp kEndOfTime = (Stamp{1} << 32U) * 1'000'000'000;

/// Checks the fields of one sample; messages name it. Words are made of what is wrong alone: most
/// samples are right, and there are many.
class SampleCheck {
 public:
  explicit SampleCheck(const Sample& sample) : id_(sample.id) {}

  void require(bool condition, const char* sentence) const {
    if (!condition) {
      fail(sentence);
    }
  }

  /// Where no uncertainty is stated, another one is assumed for the whole.
  void requirePart(double value, double whole, const char* field) const {
    requireUncertainty(value, field);
    if (!(value <= whole || whole == 0.0)) {
      fail(std::string(field) + " exceeds the whole uncertainty.");
    }
  }

  void requireUncertainty(double value, const char* field) const {
    if (!std::isfinite(value)) {
      fail(std::string(field) + " is not finite.");
    }
    if (value < 0.0) {
      fail(std::string(field) + " is negative.");
    }
  }

  void requireCurrents(const Eigen::VectorXd& current, std::size_t coils) const {
    if (static_cast<std::size_t>(current.size()) != coils) {
      fail("current has " + std::to_string(current.size()) + " entries, but the actuator has " +
           std::to_string(coils) + " coils.");
    }
  }

 private:
  [[noreturn]] void fail(const std::string& sentence) const {
    throw DataError("Sample " + std::to_string(id_) + ": " + sentence);
  }

  std::uint32_t id_;
};

bool isTime(Stamp stamp) {
  return stamp >= 0 && stamp < kEndOfTime;
}

bool isRotation(const Eigen::Matrix3d& R) {
  const double deviation = (R * R.transpose() - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff();
  return deviation <= kRotationTolerance && R.determinant() > 0.0;
}

}  // namespace

Sample trackedSample(Sample sample, double default_stddev) {
  SampleCheck(sample).require(sample.has_orientation,
                              "it has no orientation, which alone tells where a rotor without "
                              "joints is.");
  sample.joint_position = freeRotorAngles(sample.R_stator_rotor);
  if (sample.joint_stddev.isZero(0.0)) {
    const bool is_stated = sample.orientation_stddev > 0.0;
    sample.joint_stddev.setConstant(is_stated ? sample.orientation_stddev : default_stddev);
  }
  return sample;
}

void validate(const Sample& sample, std::size_t coils) {
  const SampleCheck check(sample);
  check.require(isTime(sample.stamp), "stamp is no time.");
  check.require(isTime(sample.dwell), "dwell is no time.");
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
    check.requireCurrents(sample.current, coils);
  }
}

}  // namespace sac
