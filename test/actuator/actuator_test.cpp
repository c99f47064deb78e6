#include "spherical_actuator_calibration/actuator/actuator.hpp"

#include <cmath>
#include <functional>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "spherical_actuator_calibration/base/error.hpp"
#include "spherical_actuator_calibration/base/pi.hpp"
#include "support/error_message.hpp"

namespace sac {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

Actuator validActuator() {
  Actuator actuator;
  actuator.name = "test";
  actuator.joints = {JointAxis{"joint_1", Eigen::Vector3d::UnitX(), 0.0},
                     JointAxis{"joint_2", Eigen::Vector3d::UnitY(), 0.0},
                     JointAxis{"joint_3", Eigen::Vector3d::UnitZ(), 0.0}};
  actuator.poles = {PoleAxis{}, PoleAxis{0.0, 0.8, -1, 1.0}};
  actuator.coils = {CoilAxis{0.26, 0.0, 1.0}};
  actuator.torque_curve = TorqueCurveDescription{AngleUnit::kDegree, {0.0, 0.05}, 2.0, 28.0, 32.0};
  return actuator;
}

TEST(Actuator, AcceptsAValidDescription) {
  EXPECT_NO_THROW(validate(validActuator()));
}

TEST(Actuator, AcceptsAJointAlone) {
  Actuator actuator = validActuator();
  actuator.poles.clear();
  actuator.coils.clear();
  actuator.torque_curve.reset();
  EXPECT_NO_THROW(validate(actuator));
  EXPECT_FALSE(actuator.hasTorqueModel());
}

TEST(Actuator, NamesTheKeyThatIsWrong) {
  using Change = std::function<void(Actuator&)>;
  const std::vector<std::pair<std::string, Change>> cases = {
      {"joints[1].axis", [](Actuator& a) { a.joints[1].axis *= 1.01; }},
      {"joints[1].axis", [](Actuator& a) { a.joints[1].axis.x() = kNaN; }},
      {"joints[2].offset", [](Actuator& a) { a.joints[2].offset = kNaN; }},
      {"joints[2].name", [](Actuator& a) { a.joints[2].name = "joint_1"; }},
      {"poles[1].polar", [](Actuator& a) { a.poles[1].polar = 1.6; }},
      {"poles[1].azimuth", [](Actuator& a) { a.poles[1].azimuth = HUGE_VAL; }},
      {"poles[1].polarity", [](Actuator& a) { a.poles[1].polarity = 0; }},
      {"poles[1].gain", [](Actuator& a) { a.poles[1].gain = 0.0; }},
      {"coils[0].polar", [](Actuator& a) { a.coils[0].polar = -1.6; }},
      {"coils[0].azimuth", [](Actuator& a) { a.coils[0].azimuth = kNaN; }},
      {"coils[0].gain", [](Actuator& a) { a.coils[0].gain = -1.0; }},
      {"torque_curve.coefficients", [](Actuator& a) { a.torque_curve->coefficients.clear(); }},
      {"workspace.tilt_limit", [](Actuator& a) { a.workspace.tilt_limit = 0.0; }},
      {"workspace.tilt_limit", [](Actuator& a) { a.workspace.tilt_limit = 1.6; }},
  };
  for (const auto& [key, change] : cases) {
    Actuator actuator = validActuator();
    change(actuator);
    const std::string message = errorMessage<ConfigError>([&] { validate(actuator); });
    EXPECT_EQ(message.find(key), 0U) << key << ": " << message;
  }
}

TEST(Actuator, TellsTheAllowedRange) {
  Actuator actuator = validActuator();
  actuator.poles[1].polar = 2.1;
  EXPECT_EQ(errorMessage<ConfigError>([&] { validate(actuator); }),
            "poles[1].polar: 2.1 is outside [-1.5708, 1.5708] rad.");
}

TEST(AxisAngles, FollowTheElevationFromTheEquator) {
  EXPECT_TRUE(axisFromAngles(0.0, 0.0).isApprox(Eigen::Vector3d::UnitX(), 1e-15));
  EXPECT_TRUE(axisFromAngles(0.0, kPi / 2.0).isApprox(Eigen::Vector3d::UnitY(), 1e-15));
  EXPECT_TRUE(axisFromAngles(kPi / 2.0, 0.3).isApprox(Eigen::Vector3d::UnitZ(), 1e-15));
}

TEST(AxisAngles, ComeBackFromTheAxis) {
  for (const double polar : {-1.5, -0.2618, 0.0, 1e-9, 0.2618, 1.5707}) {
    for (const double azimuth : {-7.0, -kPi, 0.0, 0.02, 3.1416, 5.5, 20.0}) {
      const AxisAngles angles = anglesFromAxis(axisFromAngles(polar, azimuth), azimuth + 0.05);
      EXPECT_NEAR(angles.polar, polar, 1e-15);
      // The azimuth's precision falls with the distance from the polar axis.
      EXPECT_NEAR(angles.azimuth, azimuth, 1e-14 / std::cos(polar));
    }
  }
}

TEST(AxisAngles, KeepTheHintWhereTheAzimuthIsUndefined) {
  EXPECT_EQ(anglesFromAxis(Eigen::Vector3d::UnitZ(), 1.25).azimuth, 1.25);
  EXPECT_EQ(anglesFromAxis(-Eigen::Vector3d::UnitZ(), -9.0).azimuth, -9.0);
  EXPECT_DOUBLE_EQ(anglesFromAxis(-Eigen::Vector3d::UnitZ(), -9.0).polar, -kPi / 2.0);
}

}  // namespace
}  // namespace sac
