#include "spherical_actuator_calibration/diagnosis/validity_check.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "spherical_actuator_calibration/actuator/spherical_joint.hpp"
#include "spherical_actuator_calibration/actuator/torque_model.hpp"
#include "spherical_actuator_calibration/base/rotations.hpp"
#include "support/scenarios.hpp"

namespace sac {
namespace {

constexpr double kNoise = 1e-3;  // [rad]

std::vector<Sample> orientations(std::size_t poses, unsigned seed) {
  scenarios::Generator generator(seed);
  const std::vector<Eigen::Vector3d> where = scenarios::randomPoses(poses, 0.3, generator);
  return scenarios::orientationSamples(
      scenarios::paperTruth(), where, kNoise, scenarios::uniformStddev(kNoise), generator);
}

void spoil(Sample& sample) {
  sample.R_stator_rotor = rotationExp({0.02, 0.0, -0.02}) * sample.R_stator_rotor;
}

/// Calibrates from 40 poses, of which so many are far off, and checks 8 with so many.
ValidityCheck checked(std::size_t spoilt_in_use, std::size_t spoilt_held_out) {
  std::vector<Sample> samples = orientations(40, 3);
  for (std::size_t n = 0; n < spoilt_in_use; ++n) {
    spoil(samples[7 * n]);
  }
  CalibrationSession session({scenarios::paperNominal()}, samples, {});
  EXPECT_TRUE(session.run({Cycle::kJoint}).success);
  std::vector<Sample> later = orientations(8, 4);
  for (std::size_t n = 0; n < later.size(); ++n) {
    later[n].id += 1000;
    later[n].validation = true;
    if (n < spoilt_held_out) {
      spoil(later[n]);
    }
    session.add(later[n]);
  }
  return checkValidity(session);
}

TEST(ValidityCheck, ExcusesOutliersThatAreAsRareAsAmongTheSamplesInUse) {
  const ValidityCheck check = checked(4, 1);
  EXPECT_TRUE(check.is_valid) << check.message;
  EXPECT_NE(check.message.find("1 outliers"), std::string::npos) << check.message;
}

TEST(ValidityCheck, ExcusesNoneWhereNoneWereInUse) {
  EXPECT_FALSE(checked(0, 1).is_valid);
}

TEST(ValidityCheck, ExcusesNoMoreThanAreUsual) {
  EXPECT_FALSE(checked(4, 4).is_valid);
}

// One glitch among the samples in use excuses no coil of which nothing else tells.
TEST(ValidityCheck, DoubtsACoilWhoseOnlyTorqueIsAnOutlier) {
  scenarios::Generator generator(5);
  std::vector<Sample> samples =
      scenarios::paperSession(scenarios::paperTruth(), scenarios::Tracker::kEveryPose, generator);
  for (std::size_t n = 0; n < samples.size(); ++n) {
    samples[n].id = static_cast<std::uint32_t>(n + 1);
  }
  std::vector<Sample> later(samples.begin(), samples.begin() + 20);
  samples[41].torque.x() += 0.03;
  CalibrationSession session({scenarios::paperNominal()}, samples, {});
  ASSERT_TRUE(session.run({Cycle::kRefine}).success);
  const auto captured = [&](std::uint32_t id, double error) {
    Sample sample =
        *std::find_if(later.begin(), later.end(), [](const Sample& one) { return one.has_torque; });
    sample.id = id;
    sample.validation = true;
    sample.R_stator_rotor = rotationExp({0.0, 0.0, 1e-8 * id}) * sample.R_stator_rotor;
    sample.torque += Eigen::Vector3d(error, 1e-8 * id, 0.0);
    return sample;
  };
  for (std::size_t n = 0; n < later.size(); ++n) {
    Sample sample = later[n];
    sample.id += 1000;
    sample.validation = true;
    sample.torque.y() += 1e-6;
    sample.R_stator_rotor = rotationExp({0.0, 1e-6, 0.0}) * sample.R_stator_rotor;
    session.add(sample);
  }
  ASSERT_TRUE(checkValidity(session).is_valid) << checkValidity(session).message;
  session.add(captured(2000, 0.03));
  const ValidityCheck check = checkValidity(session);
  EXPECT_FALSE(check.is_valid) << check.message;
  EXPECT_NE(check.message.find("In doubt"), std::string::npos) << check.message;
  session.add(captured(2001, 0.0));
  EXPECT_TRUE(checkValidity(session).is_valid) << checkValidity(session).message;
  session.add(captured(2002, 0.031));
  session.add(captured(2003, 0.029));
  EXPECT_NE(checkValidity(session).message.find("changed are coil"), std::string::npos)
      << checkValidity(session).message;
}

// Orientations say nothing of coils, and one pose little of the joints.
/// What a check says after coil 4 has lost a tenth of its strength, by torques of it and others.
std::string saidOfAWeakCoil(bool with_another) {
  scenarios::Generator generator(6);
  CalibrationSession session(
      {scenarios::paperNominal()},
      scenarios::paperSession(scenarios::paperTruth(), scenarios::Tracker::kEveryPose, generator),
      {});
  EXPECT_TRUE(session.run({Cycle::kRefine}).success);
  Actuator unit = scenarios::paperTruth();
  unit.coils[3].gain = 0.9;
  const JointGeometry joints = jointGeometry(unit);
  std::uint32_t id = 5000;
  for (const Eigen::Vector3d& q : scenarios::randomPoses(48, 0.3, generator)) {
    Sample sample;
    sample.id = id++;
    sample.validation = true;
    sample.joint_position = q;
    sample.current = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(unit.coils.size()));
    sample.current[id % sample.current.size()] = 2.0;
    if (with_another) {
      sample.current[3] = 2.0;
    }
    sample.has_torque = true;
    sample.torque_stddev = 5e-4;
    sample.torque = rotorTorque(TorqueCurve(*unit.torque_curve),
                                torqueGeometry(unit),
                                rotorOrientation(joints, q),
                                sample.current) +
                    scenarios::uniformNoise(5e-4, generator);
    session.add(sample);
  }
  const ValidityCheck check = checkValidity(session, CheckedSamples::kAll);
  EXPECT_FALSE(check.is_valid);
  return check.message;
}

TEST(ValidityCheck, BlamesNoJointForACoilThatIsExcitedWithOthers) {
  const auto says = [](const std::string& message, const char* words) {
    return message.find(words) != std::string::npos;
  };
  const std::string alone = saidOfAWeakCoil(false);
  EXPECT_TRUE(says(alone, "coil 4")) << alone;
  EXPECT_FALSE(says(alone, "excited together")) << alone;
  const std::string together = saidOfAWeakCoil(true);
  EXPECT_TRUE(says(together, "excited together")) << together;
  EXPECT_FALSE(says(together, "a joint")) << together;
}

TEST(ValidityCheck, TellsWhatOrientationsOfOnePoseLeaveOut) {
  CalibrationSession session({scenarios::paperNominal()}, orientations(40, 3), {});
  ASSERT_TRUE(session.run({Cycle::kJoint}).success);
  const std::vector<Sample> later = orientations(8, 4);
  const auto capture = [&](std::size_t n, std::uint32_t id) {
    Sample sample = later[n];
    sample.id = id;
    sample.validation = true;
    sample.R_stator_rotor = rotationExp({0.0, 0.0, 1e-9 * id}) * sample.R_stator_rotor;
    session.add(sample);
    return checkValidity(session).message;
  };
  capture(0, 1000);
  const std::string one = capture(0, 1001);
  EXPECT_NE(one.find("samples are of one pose"), std::string::npos) << one;
  EXPECT_NE(one.find("No sample has a torque: nothing is said of poles and coils"),
            std::string::npos)
      << one;
  EXPECT_NE(capture(1, 1002).find("samples are of two poses"), std::string::npos);
  EXPECT_EQ(capture(2, 1003).find("samples are of"), std::string::npos);
}

TEST(ValidityCheck, PromisesNothingOfFramesThatWereOffBefore) {
  const ValidityCheck check = checked(0, 0);
  EXPECT_TRUE(check.is_valid) << check.message;
  EXPECT_NE(check.message.find("frames that were off when the unit was calibrated"),
            std::string::npos)
      << check.message;
}

}  // namespace
}  // namespace sac
