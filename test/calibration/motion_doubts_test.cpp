#include "motion_doubts.hpp"

#include <string>
#include <vector>

#include <Eigen/Core>

#include <gtest/gtest.h>

namespace sac {
namespace {

/// The only doubt, which has to say this.
void expectOne(const MotionEstimate& found, const std::string& part) {
  const std::vector<std::string> doubts = motionDoubts(found, {});
  ASSERT_EQ(doubts.size(), 1U);
  EXPECT_NE(doubts[0].find(part), std::string::npos) << doubts[0];
}

TEST(MotionDoubts, AreNoneOfNoiseAsItIsStated) {
  MotionEstimate found;
  EXPECT_TRUE(motionDoubts(found, {}).empty());
  found.alignment = {1.15, 0.05};
  EXPECT_TRUE(motionDoubts(found, {}).empty());
}

TEST(MotionDoubts, SayWhatToDoWhereResidualsLeanOnTheParameters) {
  MotionEstimate found;
  found.alignment = {1.44, 0.05};
  expectOne(found, "moves the parameters 1.20 times as far");
  expectOne(found, "(told from 1.10 times on)");
  expectOne(found, "Record coil_setpoints");
}

TEST(MotionDoubts, SayThatTheTrackersNoiseIsNotWhite) {
  MotionEstimate found;
  found.tracker_colour = 9.0;
  found.summary.orientation_stddev = 3e-3;
  expectOne(found, "3.0 times as far off as white noise of 1 mrad");
  expectOne(found, "look for a filter or a vibration of the tracker");
}

/// Of one value.
UnmodelledError errorOf(UnmodelledError::Kind kind, const Eigen::VectorXd& value, double stddev) {
  UnmodelledError error;
  error.kind = kind;
  error.joint = 2;
  error.value = value;
  error.covariance = stddev * stddev * Eigen::MatrixXd::Identity(value.size(), value.size());
  error.most_shifted = "pole_1/polar";
  error.shift = -2.5;
  error.distance = 4.5;
  return error;
}

TEST(MotionDoubts, NameTheErrorThatIsSurest) {
  using Kind = UnmodelledError::Kind;
  MotionEstimate found;
  found.unmodelled = {errorOf(Kind::kTurn, Eigen::Vector2d(6e-5, 8e-5), 1e-5),
                      errorOf(Kind::kCurve, Eigen::VectorXd::Constant(1, 6e-4), 4e-5)};
  expectOne(found, "a torque curve that is wider in angle by 0.060 +- 0.004 %");
  expectOne(found, "off by 4.5 standard deviations, pole_1/polar by 2.5 of its own: measure");
  found.unmodelled.pop_back();
  expectOne(found, "readings of joint 3 that err once a turn, by 0.1 mrad");
  // Residuals that are larger than their noise tell less.
  found.estimate.covariance_scale = 2.0;
  EXPECT_TRUE(motionDoubts(found, {}).empty());
}

TEST(MotionDoubts, NameNoErrorThatMattersToNoParameter) {
  using Kind = UnmodelledError::Kind;
  MotionEstimate found;
  for (const Kind kind : {Kind::kScale, Kind::kCurrentClock, Kind::kTrackerClock}) {
    found.unmodelled = {errorOf(kind, Eigen::Vector3d(1e-4, 0.0, 0.0), 1e-5)};
    found.unmodelled[0].distance = 0.5;
    EXPECT_TRUE(motionDoubts(found, {}).empty());
  }
  // Its mean, which nothing tells, may be as large as the rest.
  found.unmodelled[0].kind = Kind::kTrackerDrift;
  expectOne(found, "a tracker that drifts, by 0.058 mrad rms");
}

}  // namespace
}  // namespace sac
