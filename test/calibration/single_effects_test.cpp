#include "single_effects.hpp"

#include <cmath>
#include <numeric>
#include <optional>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "spherical_actuator_calibration/base/rotations.hpp"
#include "spherical_actuator_calibration/estimation/distributions.hpp"
#include "spherical_actuator_calibration/estimation/estimator.hpp"
#include "support/scenarios.hpp"

namespace sac {
namespace {

/// A session of the paper's protocol, and what is estimated from it.
class SingleEffectsTest : public ::testing::Test {
 protected:
  SingleEffectsTest() {
    scenarios::Generator generator(5);
    truth_ = scenarios::perturbed(scenarios::paperNominal(), 0.02, 0.02, generator);
    samples_ = scenarios::paperSession(truth_, scenarios::Tracker::kEveryPose, generator);
    Stamp stamp = 0;
    for (Sample& sample : samples_) {
      sample.stamp = ++stamp;
    }
  }

  EstimationProblem problemOf(const CalibrationModel& model) const {
    const Eigen::Index size = model.space().size();
    EstimationProblem problem;
    problem.model = &model;
    problem.samples = &samples_;
    for (std::size_t n = 0; n < samples_.size(); ++n) {
      if (samples_[n].has_orientation) {
        problem.observations.push_back({n, Quantity::kOrientation});
      }
      if (samples_[n].has_torque) {
        problem.observations.push_back({n, Quantity::kTorque});
      }
    }
    problem.prior = {Eigen::VectorXd::Zero(size), 9e-4 * Eigen::MatrixXd::Identity(size, size)};
    problem.free.resize(static_cast<std::size_t>(size));
    std::iota(problem.free.begin(), problem.free.end(), 0);
    return problem;
  }

  std::optional<SingleEffect> found() const {
    const CalibrationModel model{ParameterSpace(scenarios::paperNominal())};
    const EstimationProblem problem = problemOf(model);
    return effectEvidence(problem, estimate(problem, options_), options_, nullptr).found;
  }

  /// χ² of a fit that models such effects.
  double misfit(const EffectSelection& effects) const {
    const CalibrationModel model{ParameterSpace(scenarios::paperNominal(), effects)};
    const Estimate fit = estimate(problemOf(model), options_);
    EXPECT_EQ(fit.termination, Termination::kConverged);
    return fit.reduced_chi_square * fit.degrees_of_freedom;
  }

  void turnTorques(const Eigen::Vector3d& by) {
    for (Sample& sample : samples_) {
      sample.torque = rotationExp(by) * sample.torque;
    }
  }

  Actuator truth_;
  std::vector<Sample> samples_;
  EstimationOptions options_;
};

TEST_F(SingleEffectsTest, ASoundSessionShowsNone) {
  EXPECT_FALSE(found());
}

TEST_F(SingleEffectsTest, ATurnedTorqueFrameIsAsSignificantAsAFitThatModelsItSays) {
  turnTorques({1.5e-3, -1e-3, 1e-3});
  const std::optional<SingleEffect> effect = found();
  ASSERT_TRUE(effect);
  // Turned together, marker and torque frame are as they were: either explains it.
  EXPECT_TRUE(effect->name == "torque_registration" || effect->name == "marker_registration")
      << effect->name;
  EffectSelection selection;
  const double before = misfit(selection);
  selection[effect->name] = true;
  const double drop = before - misfit(selection);
  // Some 150 things are tried, each of which could have shown as much.
  const double of_fit = chiSquareProbability(3.0, drop);
  EXPECT_NEAR(
      std::log(effect->probability / 150.0), std::log(of_fit), 0.1 * std::abs(std::log(of_fit)));
}

TEST_F(SingleEffectsTest, AFirstCoilThatIsTooStrongIsNamed) {
  for (Sample& sample : samples_) {
    sample.torque *= sample.has_torque && std::abs(sample.current[0]) > 0.0 ? 1.03 : 1.0;
  }
  const std::optional<SingleEffect> effect = found();
  ASSERT_TRUE(effect);
  EXPECT_EQ(effect->name, "coil_1/gain");
}

TEST_F(SingleEffectsTest, AJointWhoseReadingsAreTooLargeIsNamed) {
  for (Sample& sample : samples_) {
    sample.joint_position[2] *= 1.005;
  }
  const std::optional<SingleEffect> effect = found();
  ASSERT_TRUE(effect);
  EXPECT_EQ(effect->name, "joint_3/scale");
}

TEST_F(SingleEffectsTest, AJointThatStepsIsNamedWithThePlace) {
  for (Sample& sample : samples_) {
    sample.joint_position[1] += sample.id > 70 ? 3e-3 : 0.0;
  }
  const std::optional<SingleEffect> effect = found();
  ASSERT_TRUE(effect);
  EXPECT_EQ(effect->name.rfind("joint_2/offset after sample ", 0), 0U) << effect->name;
  const double place = std::stod(effect->name.substr(effect->name.rfind(' ')));
  EXPECT_NEAR(place, 70.0, 4.0);
}

}  // namespace
}  // namespace sac
