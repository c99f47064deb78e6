#include "spherical_actuator_calibration/assessment/model_choice.hpp"

#include <string>
#include <vector>

#include <gtest/gtest.h>

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

TEST(ModelChoice, HasNothingToCompareWithoutEffects) {
  EXPECT_TRUE(compareEffects({scenarios::paperNominal()}, biasedSession(0.0), {}).empty());
}

}  // namespace
}  // namespace sac
