#include "spherical_actuator_calibration/diagnosis/session_diagnosis.hpp"

#include <random>

#include <gtest/gtest.h>

#include "spherical_actuator_calibration/diagnosis/validity_check.hpp"
#include "support/scenarios.hpp"

namespace sac {
namespace {

class SessionDiagnosis : public ::testing::Test {
 protected:
  CalibrationSession session(const Actuator& truth, unsigned seed) {
    scenarios::Generator generator(seed);
    return {{scenarios::paperNominal()},
            scenarios::paperSession(truth, scenarios::Tracker::kEveryPose, generator),
            {}};
  }
};

TEST_F(SessionDiagnosis, NamesNothingWhereAllIsWell) {
  EXPECT_TRUE(diagnose(session(scenarios::paperTruth(), 1)).empty());
}

// Six torques of one coil; the amplifier measures a milliampere in the others, as it does.
TEST_F(SessionDiagnosis, SaysNothingOfCoilsThatAreOff) {
  constexpr std::size_t kCoil = 2;
  for (unsigned seed = 0; seed < 20; ++seed) {
    scenarios::Generator generator(seed);
    const Actuator truth = scenarios::perturbed(scenarios::paperNominal(), 0.03, 0.02, generator);
    const std::vector<Eigen::Vector3d> poses = scenarios::randomPoses(6, 0.3, generator);
    std::vector<Sample> samples =
        scenarios::torqueSamples(truth, poses, kCoil, 1.5, 1e-4, 1e-4, generator);
    std::normal_distribution<double> ampere(0.0, 1e-3);
    for (Sample& sample : samples) {
      for (Eigen::Index coil = 0; coil < sample.current.size(); ++coil) {
        sample.current[coil] += ampere(generator);
      }
    }
    const std::vector<Diagnosis> mistakes =
        diagnoseMistakes({{scenarios::paperNominal()}, samples, {}});
    EXPECT_TRUE(mistakes.empty()) << seed << ": " << mistakes.front().message;
  }
}

TEST_F(SessionDiagnosis, NamesTheStrengthThatTheMagnetsLost) {
  Actuator truth = scenarios::paperTruth();
  for (PoleAxis& pole : truth.poles) {
    pole.gain = 0.96;
  }
  const std::vector<Diagnosis> diagnoses = diagnose(session(truth, 2));
  ASSERT_FALSE(diagnoses.empty());
  EXPECT_EQ(diagnoses.front().cause, "strength_scale") << diagnoses.front().message;
  EXPECT_NE(diagnoses.front().message.find("-4.0"), std::string::npos) << diagnoses.front().message;
}

class Validity : public SessionDiagnosis {
 protected:
  /// A calibrated session, with further poses of another truth held out.
  ValidityCheck checked(const Actuator& now) {
    CalibrationSession calibrated = session(scenarios::paperTruth(), 3);
    calibrated.run({Cycle::kJoint});
    calibrated.run({Cycle::kRefine});
    scenarios::Generator generator(4);
    const std::vector<Eigen::Vector3d> poses = scenarios::randomPoses(6, 0.3, generator);
    for (Sample& sample : scenarios::orientationSamples(
             now, poses, 1e-3, scenarios::uniformStddev(1e-3), generator)) {
      sample.id += 1000;
      sample.validation = true;
      calibrated.add(sample);
    }
    return checkValidity(calibrated);
  }
};

TEST_F(Validity, IsToldWithWhatItWouldHaveNoticed) {
  const ValidityCheck check = checked(scenarios::paperTruth());
  EXPECT_TRUE(check.is_valid) << check.message;
  EXPECT_NE(check.message.find("mrad (99 %)"), std::string::npos) << check.message;
}

TEST_F(Validity, EndsWhenAJointWasMoved) {
  Actuator now = scenarios::paperTruth();
  now.joints[1].offset += 3e-3;
  const ValidityCheck check = checked(now);
  EXPECT_FALSE(check.is_valid);
  EXPECT_NE(check.message.find("the orientation"), std::string::npos) << check.message;
}

TEST_F(Validity, CannotBeToldWithoutHeldOutSamples) {
  const ValidityCheck check = checkValidity(session(scenarios::paperTruth(), 5));
  EXPECT_FALSE(check.is_valid);
  EXPECT_NE(check.message.find("validation"), std::string::npos) << check.message;
}

}  // namespace
}  // namespace sac
