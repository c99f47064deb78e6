#include "spherical_actuator_calibration/measurement/sample.hpp"

#include <functional>
#include <limits>
#include <string>

#include <gtest/gtest.h>

#include "spherical_actuator_calibration/base/error.hpp"
#include "spherical_actuator_calibration/base/rotations.hpp"
#include "support/error_message.hpp"

namespace sac {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

Sample goodSample() {
  Sample sample;
  sample.id = 7;
  sample.joint_stddev.setConstant(1e-5);
  sample.has_orientation = true;
  sample.R_stator_rotor = rotationExp(Eigen::Vector3d(0.1, 0.2, 0.3));
  sample.orientation_stddev = 1e-4;
  sample.has_torque = true;
  sample.torque_stddev = 1e-4;
  sample.current = Eigen::VectorXd::Zero(4);
  sample.duration = 1.0;
  return sample;
}

std::string messageAfter(const std::function<void(Sample&)>& spoil) {
  Sample sample = goodSample();
  spoil(sample);
  return errorMessage<DataError>([&sample] { validate(sample, 4); });
}

TEST(SampleValidation, TakesAGoodSample) {
  EXPECT_NO_THROW(validate(goodSample(), 4));
  Sample bare;
  EXPECT_NO_THROW(validate(bare, 4));
}

TEST(SampleValidation, NamesTheFieldThatIsNotFinite) {
  for (const double bad : {kNaN, kInfinity, -kInfinity}) {
    EXPECT_EQ(messageAfter([bad](Sample& s) { s.joint_position.z() = bad; }),
              "Sample 7: joint_position is not finite.");
    EXPECT_EQ(messageAfter([bad](Sample& s) { s.joint_stddev.x() = bad; }),
              "Sample 7: joint_stddev is not finite.");
    EXPECT_EQ(messageAfter([bad](Sample& s) { s.R_stator_rotor(1, 2) = bad; }),
              "Sample 7: orientation is not finite.");
    EXPECT_EQ(messageAfter([bad](Sample& s) { s.torque.y() = bad; }),
              "Sample 7: torque is not finite.");
    EXPECT_EQ(messageAfter([bad](Sample& s) { s.current[3] = bad; }),
              "Sample 7: current is not finite.");
    EXPECT_EQ(messageAfter([bad](Sample& s) { s.duration = bad; }),
              "Sample 7: duration is not finite.");
    EXPECT_EQ(messageAfter([bad](Sample& s) { s.orientation_stddev = bad; }),
              "Sample 7: orientation_stddev is not finite.");
    EXPECT_EQ(messageAfter([bad](Sample& s) { s.torque_stddev = bad; }),
              "Sample 7: torque_stddev is not finite.");
  }
}

TEST(SampleValidation, StampsAreTimesOfRos) {
  constexpr Stamp kEnd = 4'294'967'296'000'000'000;
  for (const Stamp bad : {Stamp{-5}, kEnd, std::numeric_limits<Stamp>::max()}) {
    EXPECT_EQ(messageAfter([bad](Sample& s) { s.stamp = bad; }), "Sample 7: stamp is no time.");
    EXPECT_EQ(messageAfter([bad](Sample& s) { s.dwell = bad; }), "Sample 7: dwell is no time.");
  }
  EXPECT_EQ(messageAfter([](Sample& s) { s.stamp = kEnd - 1; }), "no exception");
}

TEST(SampleValidation, RefusesNegativeUncertainty) {
  EXPECT_EQ(messageAfter([](Sample& s) { s.joint_stddev.y() = -1e-9; }),
            "Sample 7: joint_stddev is negative.");
  EXPECT_EQ(messageAfter([](Sample& s) { s.orientation_stddev = -1e-9; }),
            "Sample 7: orientation_stddev is negative.");
  EXPECT_EQ(messageAfter([](Sample& s) { s.torque_stddev = -1e-9; }),
            "Sample 7: torque_stddev is negative.");
  EXPECT_EQ(messageAfter([](Sample& s) { s.duration = -1.0; }), "Sample 7: duration is negative.");
}

TEST(SampleValidation, RefusesWhatIsNoRotation) {
  const std::string expected = "Sample 7: orientation is not a rotation.";
  EXPECT_EQ(messageAfter([](Sample& s) { s.R_stator_rotor *= 1.0 + 1e-5; }), expected);
  EXPECT_EQ(messageAfter([](Sample& s) { s.R_stator_rotor *= -1.0; }), expected);
  EXPECT_EQ(messageAfter([](Sample& s) { s.R_stator_rotor.setZero(); }), expected);
}

TEST(SampleValidation, NeedsOneCurrentPerCoilWhereThereIsTorque) {
  EXPECT_EQ(messageAfter([](Sample& s) { s.current.resize(0); }),
            "Sample 7: current has 0 entries, but the actuator has 4 coils.");
  EXPECT_EQ(messageAfter([](Sample& s) {
              s.current.resize(0);
              s.has_torque = false;
            }),
            "no exception");
}

}  // namespace
}  // namespace sac
