#include "spherical_actuator_calibration/study/model_error.hpp"

#include <gtest/gtest.h>

#include "support/scenarios.hpp"

namespace sac {
namespace {

CalibratedDescription knownTo(double stddev) {
  CalibratedDescription description;
  description.actuator = scenarios::paperNominal();
  for (JointStddev& joint : description.stddevs.joints) {
    joint.offset = joint.axis_u = joint.axis_v = stddev;
  }
  AxisStddev axis;
  axis.polar = axis.azimuth = stddev;
  description.stddevs.poles.assign(description.actuator.poles.size(), axis);
  description.stddevs.coils.assign(description.actuator.coils.size(), axis);
  return description;
}

TEST(ModelError, IsThatOfADrawingWhereNothingIsKnown) {
  CalibratedDescription drawing;
  drawing.actuator = scenarios::paperNominal();
  EXPECT_EQ(likelyModelError(drawing), 0.03);
  CalibratedDescription partly = knownTo(1e-4);
  partly.stddevs.coils.back().azimuth = {};
  EXPECT_EQ(likelyModelError(partly), 0.03);
  partly = knownTo(1e-4);
  partly.stddevs.joints[1].axis_v = {};
  EXPECT_EQ(likelyModelError(partly), 0.03);
  partly.actuator.has_joints = false;
  EXPECT_LT(likelyModelError(partly), 0.03);
}

// Of a rotor without joints nobody knows them.
TEST(DescriptionAsDrawn, IsOneThatLeavesAnAngleOpen) {
  EXPECT_FALSE(isAsDrawn(knownTo(1e-4)));
  CalibratedDescription partly = knownTo(1e-4);
  partly.stddevs.poles[2].azimuth.reset();
  EXPECT_TRUE(isAsDrawn(partly));
  partly = knownTo(1e-4);
  partly.stddevs.coils[4].polar.reset();
  EXPECT_TRUE(isAsDrawn(partly));
  partly = knownTo(1e-4);
  partly.stddevs.joints[1].offset.reset();
  EXPECT_TRUE(isAsDrawn(partly));
  partly.actuator.has_joints = false;
  EXPECT_FALSE(isAsDrawn(partly));
}

TEST(ModelError, FollowsTheLeastKnownParameter) {
  EXPECT_EQ(likelyModelError(knownTo(1e-5)), 0.005);
  CalibratedDescription description = knownTo(1e-5);
  description.stddevs.poles.front().polar = 2e-3;
  EXPECT_DOUBLE_EQ(likelyModelError(description), 8e-3);
  EXPECT_EQ(likelyModelError(knownTo(0.1)), 0.03);
}

}  // namespace
}  // namespace sac
