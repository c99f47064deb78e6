#include "spherical_actuator_calibration/assessment/model_choice.hpp"

#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "spherical_actuator_calibration/actuator/spherical_joint.hpp"
#include "spherical_actuator_calibration/base/rotations.hpp"
#include "support/scenarios.hpp"

namespace sac {
namespace {

/// The paper's session with a torque bias [N·m] in every torque.
std::vector<Sample> biasedSession(double bias) {
  scenarios::Generator generator(4);
  std::vector<Sample> samples =
      scenarios::paperSession(scenarios::paperTruth(), scenarios::Tracker::kEveryPose, generator);
  for (Sample& sample : samples) {
    sample.torque.x() += sample.has_torque ? bias : 0.0;
  }
  return samples;
}

CalibrationConfig modelling(const std::vector<std::string>& effects) {
  CalibrationConfig config;
  for (const std::string& effect : effects) {
    config.effects[effect] = true;
  }
  return config;
}

TEST(ModelChoice, PrefersTheEffectThatIsThere) {
  const std::vector<ModelFit> fits = compareEffects(
      {scenarios::paperNominal()}, biasedSession(2.7e-3), modelling({"torque_bias"}));
  ASSERT_EQ(fits.size(), 2U);
  EXPECT_EQ(fits[0].parameters, 73U);
  EXPECT_EQ(fits[1].parameters, 76U);
  EXPECT_GT(fits[0].reduced_chi_square, 3.0);
  EXPECT_NEAR(fits[1].reduced_chi_square, 1.0, 0.25);
  EXPECT_GT(fits[0].bic, fits[1].bic + 10.0);
  const std::vector<std::string> lines = describe(fits);
  EXPECT_EQ(lines[0].find("best"), std::string::npos);
  EXPECT_NE(lines[1].find("best"), std::string::npos);
}

TEST(ModelChoice, AdvisesAgainstAnEffectThatIsNotThere) {
  const std::vector<ModelFit> fits =
      compareEffects({scenarios::paperNominal()}, biasedSession(0.0), modelling({"torque_bias"}));
  EXPECT_LT(fits[0].bic, fits[1].bic);
}

TEST(ModelChoice, LeavesEachEffectOutInTurn) {
  const std::vector<ModelFit> fits = compareEffects({scenarios::paperNominal()},
                                                    biasedSession(2.7e-3),
                                                    modelling({"torque_bias", "strength_scale"}));
  ASSERT_EQ(fits.size(), 4U);
  EXPECT_EQ(fits[2].effects, "without torque_bias");
  EXPECT_EQ(fits[3].effects, "without strength_scale");
  EXPECT_LT(fits[3].bic, fits[1].bic);
  EXPECT_GT(fits[2].bic, fits[1].bic + 10.0);
}

// What the samples cannot tell stays at zero: its error is in the misfit of the comparison.
TEST(ModelChoice, TellsWhatTheSamplesCannotTell) {
  const std::vector<ModelFit> fits =
      compareEffects({scenarios::paperNominal()},
                     biasedSession(0.0),
                     modelling({"torque_bias", "tracker_registration"}));
  ASSERT_EQ(fits.size(), 4U);
  EXPECT_TRUE(fits[0].not_told.empty());
  EXPECT_EQ(fits[1].not_told, std::vector<std::string>{"tracker_registration"});
  EXPECT_EQ(fits[2].not_told, std::vector<std::string>{"tracker_registration"});
  EXPECT_TRUE(fits[3].not_told.empty());
  const std::vector<std::string> lines = describe(fits);
  EXPECT_NE(lines[1].find("(the samples cannot tell tracker_registration)"), std::string::npos)
      << lines[1];
  EXPECT_EQ(lines[3].find("cannot tell"), std::string::npos) << lines[3];
}

// A joint that reads wrong by twice its harmonics; a tilt sensor that is sound.
TEST(ModelChoice, PredictsRegionsThatItHasNotSeen) {
  Actuator truth = scenarios::paperTruth();
  truth.joints[2].correction.harmonics = {2e-3, -1e-3, 0.0, 0.0};
  scenarios::Generator generator(8);
  std::vector<Sample> samples = scenarios::orientationSamples(
      truth, scenarios::randomPoses(60, 0.4, generator), 2e-4, 1.2e-4, generator);
  for (Sample& sample : samples) {
    sample.R_stator_rotor = rotationExp(scenarios::uniformNoise(2e-4, generator)) *
                            rotorOrientation(jointGeometry(truth), sample.joint_position);
  }
  const std::vector<ModelFit> fits =
      compareEffects({scenarios::paperNominal()}, samples, modelling({"encoder_harmonics"}));
  ASSERT_EQ(fits.size(), 2U);
  ASSERT_TRUE(fits[0].held_out);
  ASSERT_TRUE(fits[1].held_out);
  EXPECT_GT(*fits[0].held_out, 1e-3);
  EXPECT_LT(*fits[1].held_out, 4e-4);
  EXPECT_EQ(&bestOf(fits), &fits[1]);
  EXPECT_NE(describe(fits)[1].find("regions held out 0."), std::string::npos);
}

TEST(ModelChoice, PrefersWhatPredictsOverWhatFits) {
  std::vector<ModelFit> fits(2);
  fits[0].converged = fits[1].converged = true;
  fits[0].bic = 100.0;
  fits[1].bic = 80.0;
  EXPECT_EQ(&bestOf(fits), &fits[1]);
  fits[0].held_out = 1e-3;
  EXPECT_EQ(&bestOf(fits), &fits[1]) << "only one of them was tried";
  fits[1].held_out = 2e-3;
  EXPECT_EQ(&bestOf(fits), &fits[0]);
}

TEST(ModelChoice, PrefersWhatConverged) {
  std::vector<ModelFit> fits(3);
  fits[0].converged = fits[2].converged = true;
  fits[0].bic = 100.0;
  fits[1].bic = 10.0;
  fits[2].bic = 90.0;
  EXPECT_EQ(&bestOf(fits), &fits[2]);
  fits[0].held_out = 1e-3;
  fits[2].held_out = 2e-3;
  EXPECT_EQ(&bestOf(fits), &fits[0]) << "what did not converge predicts nothing";
}

TEST(ModelChoice, HasNothingToCompareWithoutEffects) {
  EXPECT_TRUE(compareEffects({scenarios::paperNominal()}, biasedSession(0.0), {}).empty());
}

}  // namespace
}  // namespace sac
