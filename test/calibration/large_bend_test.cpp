// A rotor that is off its axes by much more than the tracker's noise.
#include <cmath>
#include <memory>
#include <vector>

#include <gtest/gtest.h>

#include "spherical_actuator_calibration/actuator/spherical_joint.hpp"
#include "spherical_actuator_calibration/base/rotations.hpp"
#include "spherical_actuator_calibration/calibration/calibration_session.hpp"
#include "support/scenarios.hpp"

namespace sac {
namespace {

constexpr double kTrackerNoise = 2e-4;  // [rad], uniform within ±

Eigen::Vector3d bend(const Eigen::Vector3d& q, double size) {
  return size * Eigen::Vector3d(std::sin(2.5 * q[0] + q[2]),
                                std::cos(2.0 * q[1] - q[2]),
                                std::sin(2.0 * q[2]) * std::cos(q[0]));
}

class LargeBend : public ::testing::Test {
 protected:
  Eigen::Matrix3d orientation(const Eigen::Vector3d& reading) const {
    Eigen::Vector3d q = reading;
    q[2] *= scale_;
    return rotationExp(bend(reading, size_)) * rotorOrientation(jointGeometry(truth_), q);
  }

  CalibrationSession calibrated() {
    scenarios::Generator generator(7);
    std::vector<Sample> samples;
    for (const Eigen::Vector3d& q : scenarios::randomPoses(100, 0.35, generator)) {
      Sample sample;
      sample.id = static_cast<std::uint32_t>(samples.size() + 1);
      sample.joint_position = q;
      sample.has_orientation = true;
      sample.R_stator_rotor =
          rotationExp(scenarios::uniformNoise(kTrackerNoise, generator)) * orientation(q);
      sample.orientation_stddev = scenarios::uniformStddev(kTrackerNoise);
      samples.push_back(sample);
    }
    CalibrationSession session({scenarios::paperNominal()}, samples, {});
    session.run({Cycle::kJoint});
    return session;
  }

  /// At poses that were not measured [rad].
  double rmsError(const CalibrationSession& session) const {
    constexpr int kPoses = 200;
    scenarios::Generator generator(8);
    double sum = 0.0;
    for (const Eigen::Vector3d& q : scenarios::randomPoses(kPoses, 0.3, generator)) {
      const Eigen::Matrix3d R = rotorOrientation(jointGeometry(session.actuator()), q);
      sum += rotationLog(orientation(q) * R.transpose()).squaredNorm();
    }
    return std::sqrt(sum / kPoses);
  }

  Actuator truth_ = scenarios::paperTruth();
  double size_ = 1.5e-3;  // [rad]
  double scale_ = 1.0;    // of the third joint
};

TEST_F(LargeBend, IsInTheMap) {
  const CalibrationSession session = calibrated();
  const CycleReport& report = session.reports().back();
  ASSERT_TRUE(report.success) << report.message;
  EXPECT_TRUE(session.orientationMap().map) << session.orientationMap().sentence;
  EXPECT_LT(rmsError(session), 0.25 * size_);
}

// What turns the rotor by more than bearings and bending do is a mistake, however smooth it is.
TEST_F(LargeBend, BeyondWhatMachinesHaveIsRefused) {
  size_ = 0.02;
  const CalibrationSession bent = calibrated();
  EXPECT_FALSE(bent.reports().back().success);
  EXPECT_FALSE(bent.orientationMap().map);
  size_ = 0.0;
  scale_ = 1.01;
  const CalibrationSession scaled = calibrated();
  EXPECT_FALSE(scaled.reports().back().success);
  EXPECT_FALSE(scaled.orientationMap().map);
}

}  // namespace
}  // namespace sac
