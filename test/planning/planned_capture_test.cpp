#include "spherical_actuator_calibration/planning/planned_capture.hpp"

#include <limits>

#include <gtest/gtest.h>

#include "planning/current_threshold.hpp"
#include "spherical_actuator_calibration/measurement/current_tolerance.hpp"
#include "spherical_actuator_calibration/planning/sample_at_pose.hpp"

namespace sac {
namespace {

constexpr Stamp kRest = 7;

class PlannedCaptureTest : public ::testing::Test {
 protected:
  PlannedCaptureTest() {
    planned_.joint_position = Eigen::Vector3d(0.1, -0.2, 0.3);
    planned_.pattern = {{0, 1}, {2, -1}};
    planned_.current = 2.0;
    sample_.joint_position = planned_.joint_position;
    sample_.has_orientation = true;
    sample_.has_torque = true;
    sample_.current = Eigen::Vector3d(1.9, 0.01, -2.1);
    sample_.dwell = kRest;
    zero_ = sample_;
    zero_.current = Eigen::Vector3d(0.001, 0.0, -0.02);
    held_ = {zero_};
  }

  CaptureFlaw flaw() const { return captureFlaw(sample_, planned_, held_, kThreshold); }

  PlannedCapture planned_;
  Sample sample_;
  Sample zero_;
  std::vector<Sample> held_;
};

TEST_F(PlannedCaptureTest, TakesWhatServesThePlan) {
  EXPECT_EQ(flaw(), CaptureFlaw::kNone);
  EXPECT_EQ(flawName(flaw()), "");
  EXPECT_EQ(flawInWords(flaw()), "");
}

TEST_F(PlannedCaptureTest, RefusesASampleWithoutOrientation) {
  sample_.has_orientation = false;
  EXPECT_EQ(flaw(), CaptureFlaw::kOrientation);
}

TEST_F(PlannedCaptureTest, RefusesAnotherPattern) {
  sample_.current[2] = 2.1;
  EXPECT_EQ(flaw(), CaptureFlaw::kCurrents);
  sample_.current[2] = -0.04;
  EXPECT_EQ(flaw(), CaptureFlaw::kCurrents);
  sample_.current = Eigen::Vector3d(1.9, 0.05, -2.1);
  EXPECT_EQ(flaw(), CaptureFlaw::kCurrents);
}

TEST_F(PlannedCaptureTest, NamesACoilThatDoesNotCarryWhatIsCommanded) {
  const auto amiss = [this](double a, double b, double c) {
    return coilAmiss(planned_, Eigen::Vector3d(a, b, c), kThreshold);
  };
  EXPECT_FALSE(amiss(1.81, 0.03, -2.19).has_value());
  EXPECT_EQ(amiss(1.79, 0.0, -2.0), 0U);
  EXPECT_EQ(amiss(2.0, 0.05, -2.0), 1U);
  EXPECT_EQ(amiss(2.0, 0.0, 2.0), 2U);
  EXPECT_EQ(amissInWords(planned_, 2),
            "Coil 3 does not carry its current: check the amplifier and the coil driver.");
  EXPECT_EQ(amissInWords(planned_, 1),
            "Coil 2 is not free of current: check the amplifier and the coil driver.");
  EXPECT_EQ(coilAmiss(planned_, Eigen::Vector2d(2.0, 0.0), kThreshold), 2U);
  planned_.pattern.clear();
  EXPECT_FALSE(amiss(0.03, -0.03, 0.0).has_value());
  EXPECT_EQ(amiss(0.0, -0.05, 0.0), 1U);
}

TEST_F(PlannedCaptureTest, ALeastCurrentIsToldFromNone) {
  planned_.pattern = {{0, 1}};
  planned_.current = leastExcitation(kThreshold);
  EXPECT_EQ(coilAmiss(planned_, Eigen::Vector3d::Zero(), kThreshold), 0U);
  EXPECT_FALSE(coilAmiss(planned_, Eigen::Vector3d(kThreshold, 0.0, 0.0), kThreshold).has_value());
}

TEST_F(PlannedCaptureTest, NeedsATorqueWhereThereIsCurrent) {
  sample_.has_torque = false;
  EXPECT_EQ(flaw(), CaptureFlaw::kTorque);
  planned_.pattern.clear();
  sample_.current.setZero();
  EXPECT_EQ(flaw(), CaptureFlaw::kNone);
}

TEST_F(PlannedCaptureTest, RefusesARotorAwayFromThePose) {
  sample_.joint_position[1] += kPoseTolerance + 0.001;
  EXPECT_EQ(flaw(), CaptureFlaw::kPose);
  sample_.joint_position[1] -= 0.002;
  EXPECT_EQ(flaw(), CaptureFlaw::kNone);
  planned_.joint_position[0] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(flaw(), CaptureFlaw::kPose);
}

// Its torque still contains what acts without current.
TEST_F(PlannedCaptureTest, NeedsTheSampleWithoutCurrentOfItsRest) {
  sample_.dwell = kRest + 1;
  EXPECT_EQ(flaw(), CaptureFlaw::kRest);
  held_.push_back(sample_);
  EXPECT_EQ(flaw(), CaptureFlaw::kRest);
  zero_.dwell = sample_.dwell;
  held_.push_back(zero_);
  EXPECT_EQ(flaw(), CaptureFlaw::kNone);
}

TEST_F(PlannedCaptureTest, TheOneWithoutCurrentNeedsNoOther) {
  planned_.pattern.clear();
  EXPECT_EQ(captureFlaw(zero_, planned_, {}, kThreshold), CaptureFlaw::kNone);
}

TEST_F(PlannedCaptureTest, EachFlawHasANameAndASentence) {
  for (const CaptureFlaw flaw : {CaptureFlaw::kExcitation,
                                 CaptureFlaw::kOrientation,
                                 CaptureFlaw::kCurrents,
                                 CaptureFlaw::kTorque,
                                 CaptureFlaw::kPose,
                                 CaptureFlaw::kRest}) {
    EXPECT_FALSE(flawName(flaw).empty());
    EXPECT_EQ(flawInWords(flaw).back(), '.');
  }
}

TEST_F(PlannedCaptureTest, WithoutCurrentItTakesThreeTimesAsLong) {
  EXPECT_EQ(captureDuration(planned_, 0.5, 60.0), 0.5);
  planned_.pattern.clear();
  EXPECT_EQ(captureDuration(planned_, 0.5, 60.0), 1.5);
  EXPECT_EQ(captureDuration(planned_, 30.0, 60.0), 60.0);
  EXPECT_EQ(captureDuration(planned_, 70.0, 60.0), 70.0) << "it is refused by what it is";
}

}  // namespace
}  // namespace sac
