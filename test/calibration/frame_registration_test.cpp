#include "spherical_actuator_calibration/calibration/frame_registration.hpp"

#include <gtest/gtest.h>

#include "spherical_actuator_calibration/actuator/spherical_joint.hpp"
#include "spherical_actuator_calibration/base/pi.hpp"
#include "spherical_actuator_calibration/base/rotations.hpp"
#include "support/scenarios.hpp"

namespace sac {
namespace {

const Eigen::Vector3d& trackerTurn() {
  static const Eigen::Vector3d turn(0.9, -2.4, 0.7);
  return turn;
}

const Eigen::Vector3d& markerTurn() {
  static const Eigen::Vector3d turn(-0.3, 0.2, 1.1);
  return turn;
}

class FrameRegistrationTest : public testing::Test {
 protected:
  TrackedPose poseOf(const Actuator& truth, const Eigen::Vector3d& q, double noise) {
    TrackedPose pose;
    pose.id = next_id_++;
    pose.joint_position = q;
    pose.R_tracker_marker = rotationExp(trackerTurn()).transpose() *
                            rotationExp(scenarios::uniformNoise(noise, generator_)) *
                            rotorOrientation(jointGeometry(truth), q) * rotationExp(markerTurn());
    pose.orientation_stddev = scenarios::uniformStddev(kNoise);
    return pose;
  }

  std::vector<TrackedPose> posesOf(const Actuator& truth,
                                   const std::vector<Eigen::Vector3d>& joints,
                                   double noise) {
    std::vector<TrackedPose> poses;
    poses.reserve(joints.size());
    for (const Eigen::Vector3d& q : joints) {
      poses.push_back(poseOf(truth, q, noise));
    }
    return poses;
  }

  std::vector<TrackedPose> randomPoses(std::size_t count, double noise = kNoise) {
    return posesOf(described_.actuator, scenarios::randomPoses(count, 0.5, generator_), noise);
  }

  FrameRegistration registered(const std::vector<TrackedPose>& poses) const {
    return registerFrames(described_, poses, options_);
  }

  static double trackerError(const FrameRegistration& result) {
    return rotationLog(rotationExp(trackerTurn()) * result.R_stator_tracker.transpose()).norm();
  }
  static double markerError(const FrameRegistration& result) {
    return rotationLog(rotationExp(markerTurn()) * result.R_rotor_marker.transpose()).norm();
  }

  static constexpr double kNoise = 1e-3;  // [rad]
  scenarios::Generator generator_{7};
  std::uint32_t next_id_ = 1;
  CalibratedDescription described_{scenarios::paperNominal(), {}, std::nullopt};
  EstimationOptions options_;
};

TEST_F(FrameRegistrationTest, IsExactForAMachineAsDescribed) {
  for (int trial = 0; trial < 20; ++trial) {
    const FrameRegistration result = registered(randomPoses(6, 0.0));
    ASSERT_TRUE(result.success) << result.message;
    EXPECT_LT(trackerError(result), 1e-9);
    EXPECT_LT(markerError(result), 1e-9);
    EXPECT_LT(result.residual_rms, 1e-9);
  }
}

TEST_F(FrameRegistrationTest, JointsAsMadeAreInTheUncertaintyNotInTheResiduals) {
  const Actuator truth = scenarios::perturbed(described_.actuator, 0.03, 0.03, generator_);
  const FrameRegistration result =
      registered(posesOf(truth, scenarios::randomPoses(12, 0.5, generator_), kNoise));
  ASSERT_TRUE(result.success) << result.message;
  EXPECT_LT(result.residual_rms, 2.0 * kNoise);
  EXPECT_GT(trackerError(result), 3e-3);
  const Eigen::Vector3d stddev = result.covariance.diagonal().head<3>().cwiseSqrt();
  EXPECT_GT(stddev.minCoeff(), 0.01);
  EXPECT_LT(stddev.maxCoeff(), 0.06);
  EXPECT_LT(result.noise_covariance.diagonal().cwiseSqrt().maxCoeff(), kNoise);
}

TEST_F(FrameRegistrationTest, NoiseIsWhatOtherMeasurementsOfThePosesWouldMoveTheResultBy) {
  const Actuator truth = scenarios::perturbed(described_.actuator, 0.03, 0.03, generator_);
  const std::vector<Eigen::Vector3d> joints = scenarios::randomPoses(60, 0.5, generator_);
  constexpr int kTrials = 30;
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  Eigen::Vector3d squares = Eigen::Vector3d::Zero();
  Eigen::Vector3d variance = Eigen::Vector3d::Zero();
  for (int trial = 0; trial < kTrials; ++trial) {
    const FrameRegistration result = registered(posesOf(truth, joints, kNoise));
    ASSERT_TRUE(result.success) << result.message;
    const Eigen::Vector3d error =
        rotationLog(rotationExp(trackerTurn()) * result.R_stator_tracker.transpose());
    sum += error;
    squares += error.cwiseAbs2();
    variance += result.noise_covariance.diagonal().head<3>() / kTrials;
  }
  const Eigen::Vector3d scatter = (squares - sum.cwiseAbs2() / kTrials) / (kTrials - 1);
  const Eigen::Vector3d ratio = variance.cwiseQuotient(scatter).cwiseSqrt();
  EXPECT_GT(ratio.minCoeff(), 0.6);
  EXPECT_LT(ratio.maxCoeff(), 1.7);
}

TEST_F(FrameRegistrationTest, StatedJointsTakeThePlaceOfTolerances) {
  for (JointStddev& joint : described_.stddevs.joints) {
    joint.offset = joint.axis_u = joint.axis_v = 2e-4;
  }
  const FrameRegistration result = registered(randomPoses(20));
  ASSERT_TRUE(result.success) << result.message;
  EXPECT_LT(result.covariance.diagonal().cwiseSqrt().maxCoeff(), 1e-3);
  EXPECT_LT(trackerError(result), 1e-3);
}

TEST_F(FrameRegistrationTest, TooFewPosesAreCountedWithoutRepetitions) {
  std::vector<TrackedPose> poses = randomPoses(5);
  poses.push_back(poses.front());
  const FrameRegistration result = registered(poses);
  EXPECT_FALSE(result.success);
  EXPECT_NE(result.message.find("There are 5 different poses; at least 6"), std::string::npos)
      << result.message;
}

TEST_F(FrameRegistrationTest, NamesTheJointThatMustTurn) {
  std::vector<Eigen::Vector3d> joints;
  for (int n = 0; n < 12; ++n) {
    joints.emplace_back(0.05 * (n % 2), 0.02 * (n % 3), 0.5 * n);
  }
  const FrameRegistration result = registered(posesOf(described_.actuator, joints, kNoise));
  EXPECT_FALSE(result.success);
  EXPECT_NE(result.message.find("turn joint 2 (joint_2) further"), std::string::npos)
      << result.message;
}

TEST_F(FrameRegistrationTest, HalfTurnsAloneAreToldApartByNothing) {
  std::vector<Eigen::Vector3d> joints;
  for (const double tilt : {0.0, kPi}) {
    for (const double spin : {0.0, kPi}) {
      joints.emplace_back(tilt, 0.0, spin);
      joints.emplace_back(tilt + 0.055, 0.0, spin);
    }
  }
  options_.tolerance.joint_offset = 0.2;
  const FrameRegistration result = registered(posesOf(described_.actuator, joints, kNoise));
  EXPECT_FALSE(result.success);
  EXPECT_NE(result.message.find("half a turn apart"), std::string::npos) << result.message;
}

TEST_F(FrameRegistrationTest, LeavesAnOutlierOutAndTellsIt) {
  std::vector<TrackedPose> poses = randomPoses(12);
  poses[4].R_tracker_marker *= rotationExp({0.02, 0.0, 0.01});
  const FrameRegistration result = registered(poses);
  ASSERT_TRUE(result.success) << result.message;
  EXPECT_EQ(result.poses_used, 11u);
  EXPECT_TRUE(result.poses[4].rejected);
  ASSERT_EQ(result.notes.size(), 1u);
  EXPECT_EQ(result.notes[0].find("Pose 5 contradicts"), 0u) << result.notes[0];
  EXPECT_LT(result.residual_rms, 2.0 * kNoise);
}

TEST_F(FrameRegistrationTest, NoiseBeyondWhatIsStatedWidensTheResult) {
  const std::vector<TrackedPose> quiet = randomPoses(15);
  std::vector<TrackedPose> loud = quiet;
  for (TrackedPose& pose : loud) {
    pose.R_tracker_marker *= rotationExp(scenarios::uniformNoise(2.0 * kNoise, generator_));
  }
  const FrameRegistration result = registered(loud);
  ASSERT_TRUE(result.success) << result.message;
  EXPECT_EQ(result.poses_used, 15u);
  ASSERT_EQ(result.notes.size(), 1u);
  EXPECT_NE(result.notes[0].find("times as much as stated"), std::string::npos);
  EXPECT_GT(result.noise_covariance.trace(), 1.1 * registered(quiet).noise_covariance.trace());
}

TEST_F(FrameRegistrationTest, NamesMistakesOfWiring) {
  const std::vector<TrackedPose> poses = randomPoses(12);
  std::vector<TrackedPose> inverted = poses;
  std::vector<TrackedPose> reversed = poses;
  std::vector<TrackedPose> in_degrees = poses;
  for (std::size_t n = 0; n < poses.size(); ++n) {
    inverted[n].R_tracker_marker.transposeInPlace();
    reversed[n].joint_position[2] *= -1.0;
    in_degrees[n].joint_position /= kOneDegree;
  }
  EXPECT_NE(registered(inverted).message.find("base in the marker"), std::string::npos);
  EXPECT_NE(registered(reversed).message.find("one joint counts the wrong way"), std::string::npos)
      << registered(reversed).message;
  EXPECT_NE(registered(in_degrees).message.find("in degrees"), std::string::npos);
}

TEST_F(FrameRegistrationTest, AnotherOrderOfTheQuaternionFitsAsTheInverseDoes) {
  std::vector<TrackedPose> inverted = randomPoses(12);
  std::vector<TrackedPose> reordered = inverted;
  for (std::size_t n = 0; n < inverted.size(); ++n) {
    const Eigen::Quaterniond q(inverted[n].R_tracker_marker);
    reordered[n].R_tracker_marker = Eigen::Quaterniond(q.z(), q.w(), q.x(), q.y()).matrix();
    inverted[n].R_tracker_marker.transposeInPlace();
  }
  const FrameRegistration as_inverted = registered(inverted);
  const FrameRegistration as_reordered = registered(reordered);
  EXPECT_NEAR(as_reordered.reduced_chi_square / as_inverted.reduced_chi_square, 1.0, 1e-6);
  for (const char* const cause : {"invert it", "w, x, y, z of its quaternion"}) {
    EXPECT_NE(as_inverted.message.find(cause), std::string::npos) << as_inverted.message;
    EXPECT_NE(as_reordered.message.find(cause), std::string::npos) << as_reordered.message;
  }
}

TEST_F(FrameRegistrationTest, ArgumentOfTheLaunchFileIsTheRotation) {
  EXPECT_EQ(launchArgument(rotationExp({0.0, 0.0, kPi / 2.0})),
            "0 0 0 0 0 0.707106781187 0.707106781187");
}

}  // namespace
}  // namespace sac
