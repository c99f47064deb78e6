#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "spherical_actuator_calibration/actuator/spherical_joint.hpp"
#include "spherical_actuator_calibration/actuator/torque_model.hpp"
#include "spherical_actuator_calibration/base/rotations.hpp"
#include "spherical_actuator_calibration/calibration/calibration_cycles.hpp"
#include "spherical_actuator_calibration/estimation/open_directions.hpp"
#include "support/scenarios.hpp"

namespace sac {
namespace {

constexpr double kTolerance = 0.02;  // standard deviation of manufacturing errors [rad]
constexpr double kInterval95 = 1.959963984540054;

/// The paper's session without its tracker.
std::vector<Sample> torquesOnly(const Actuator& truth, scenarios::Generator& generator) {
  std::vector<Sample> samples =
      scenarios::paperSession(truth, scenarios::Tracker::kFirstTenPoses, generator);
  samples.erase(
      std::remove_if(
          samples.begin(), samples.end(), [](const Sample& sample) { return !sample.has_torque; }),
      samples.end());
  for (Sample& sample : samples) {
    sample.has_orientation = false;
  }
  return samples;
}

CalibrationState priorOf(const ParameterSpace& space) {
  ManufacturingTolerance tolerance;
  tolerance.joint_offset = kTolerance;
  tolerance.joint_axis = kTolerance;
  tolerance.pole = kTolerance;
  tolerance.coil = kTolerance;
  return nominalState(space, tolerance);
}

/// A unit whose coordinates are drawn from the prior, measured without a tracker and refined.
struct Trial {
  CalibrationModel model{ParameterSpace(scenarios::paperNominal())};
  CalibrationState prior = priorOf(model.space());
  Eigen::VectorXd truth = Eigen::VectorXd::Zero(model.space().size());
  CycleOutcome outcome;

  explicit Trial(std::uint64_t seed) {
    scenarios::Generator generator(seed);
    std::normal_distribution<double> error(0.0, kTolerance);
    for (double& coordinate : truth) {
      coordinate = error(generator);
    }
    const Actuator actuator = model.space().actuatorAt(truth);
    outcome = runCycle(model, torquesOnly(actuator, generator), prior, {Cycle::kRefine}, options());
  }

  static EstimationOptions options() { return {}; }
};

TEST(StatorRotations, TurnTheRotorAtEveryPoseAndChangeNoTorque) {
  constexpr double kStep = 1e-6;
  const ParameterSpace space(scenarios::paperNominal());
  scenarios::Generator generator(1);
  const Eigen::VectorXd x =
      space.coordinatesOf(scenarios::perturbed(scenarios::paperNominal(), 0.05, 0.05, generator));
  const Eigen::MatrixXd rotations = statorRotations(space, x);
  for (const Eigen::Vector3d& q : scenarios::randomPoses(5, 0.5, generator)) {
    for (int k = 0; k < 3; ++k) {
      const Actuator before = space.actuatorAt(x);
      const Actuator after = space.actuatorAt(x + kStep * rotations.col(k));
      const Eigen::Matrix3d R_before = rotorOrientation(jointGeometry(before.joints), q);
      const Eigen::Matrix3d R_after = rotorOrientation(jointGeometry(after.joints), q);
      const Eigen::Vector3d turned = rotationLog(R_after * R_before.transpose()) / kStep;
      EXPECT_LT((turned - Eigen::Vector3d::Unit(k)).norm(), 1e-4);
      const Eigen::Matrix3Xd change = R_after.transpose() * torqueGeometry(after).coils_stator -
                                      R_before.transpose() * torqueGeometry(before).coils_stator;
      EXPECT_LT(change.norm() / kStep, 1e-4);
    }
  }
}

TEST(TorqueOnlyRefinement, NamesTheThreeRotationsThatNoTorqueTells) {
  for (std::uint64_t seed = 1; seed <= 100; ++seed) {
    const Trial trial(seed);
    const CycleReport& report = trial.outcome.report;
    ASSERT_TRUE(report.success) << report.message;
    ASSERT_EQ(report.open_directions.size(), 3U) << report.message;
    for (std::size_t k = 0; k < 3; ++k) {
      EXPECT_EQ(report.open_directions[k].name,
                std::string("a common rotation of joints and coils about stator ") + "xyz"[k]);
      EXPECT_GT(report.open_directions[k].stddev, 1e-3);
    }
    EXPECT_NE(report.message.find("70 of 73 directions identified"), std::string::npos)
        << report.message;
    for (const ParameterEstimate& estimate : report.estimates) {
      const bool is_pole = estimate.name.rfind("pole_", 0) == 0;
      EXPECT_TRUE(estimate.observable || !is_pole) << estimate.name;
      EXPECT_LT(estimate.stddev, is_pole ? 1e-3 : kTolerance) << estimate.name;
    }
    EXPECT_GT(std::count_if(report.estimates.begin(),
                            report.estimates.end(),
                            [](const ParameterEstimate& e) { return !e.observable; }),
              40);
  }
}

TEST(TorqueOnlyRefinement, DoesNotGuessTheRotations) {
  const Trial trial(11);
  const Eigen::VectorXd moved = trial.outcome.state.belief.x - trial.prior.belief.x;
  for (const OpenDirection& open : trial.outcome.report.open_directions) {
    EXPECT_LT(std::abs(open.direction.dot(moved)), 0.1 * open.stddev) << open.name;
  }
  EXPECT_GT(moved.norm(), 0.05);
}

TEST(TorqueOnlyRefinement, ItsIntervalsHoldTheTruth) {
  constexpr int kTrials = 60;
  int held = 0;
  int poles_held = 0;
  int poles = 0;
  int all = 0;
  for (int seed = 1; seed <= kTrials; ++seed) {
    const Trial trial(static_cast<std::uint64_t>(100 + seed));
    ASSERT_TRUE(trial.outcome.report.success) << trial.outcome.report.message;
    const ParameterBelief& belief = trial.outcome.state.belief;
    const ParameterSpace& space = trial.model.space();
    for (Eigen::Index p = 0; p < space.size(); ++p) {
      const double limit = kInterval95 * std::sqrt(belief.covariance(p, p));
      const bool holds = std::abs(belief.x[p] - trial.truth[p]) <= limit;
      const bool is_pole = p >= space.pole(0) && p < space.coil(0);
      (is_pole ? poles_held : held) += holds ? 1 : 0;
      ++(is_pole ? poles : all);
    }
  }
  EXPECT_NEAR(static_cast<double>(poles_held) / poles, 0.95, 0.025);
  // Three directions make up nearly all of it, so that few numbers are independent.
  EXPECT_NEAR(static_cast<double>(held) / all, 0.95, 0.04);
}

TEST(TorqueOnlyRefinement, OneCoilAloneTellsThePoles) {
  scenarios::Generator generator(5);
  const Actuator truth = scenarios::perturbed(scenarios::paperNominal(), 0.03, 0.02, generator);
  const CalibrationModel model{ParameterSpace(scenarios::paperNominal())};
  const std::vector<Sample> samples =
      scenarios::torqueSamples(truth,
                               scenarios::posesThatSeeEveryPole(truth, 0, 40, 0.5, generator),
                               0,
                               2.0,
                               5e-4,
                               scenarios::uniformStddev(5e-4),
                               generator);
  const CycleOutcome outcome =
      runCycle(model, samples, priorOf(model.space()), {Cycle::kRefine}, {});
  ASSERT_TRUE(outcome.report.success) << outcome.report.message;
  EXPECT_FALSE(outcome.report.open_directions.empty()) << outcome.report.message;
  for (const ParameterEstimate& estimate : outcome.report.estimates) {
    if (estimate.name.rfind("pole_", 0) == 0) {
      EXPECT_TRUE(estimate.observable) << estimate.name;
    }
  }
}

TEST(TorqueOnlyRefinement, AnUnseenPoleIsHeldByItself) {
  scenarios::Generator generator(3);
  const Actuator truth = scenarios::perturbed(scenarios::paperNominal(), 0.03, 0.02, generator);
  const CalibrationModel model{ParameterSpace(scenarios::paperNominal())};
  std::vector<Sample> samples = torquesOnly(truth, generator);
  const TorqueGeometry geometry = torqueGeometry(truth);
  samples.erase(
      std::remove_if(
          samples.begin(),
          samples.end(),
          [&](const Sample& sample) {
            const Eigen::Matrix3Xd coils =
                rotorOrientation(jointGeometry(truth.joints), sample.joint_position).transpose() *
                geometry.coils_stator;
            for (Eigen::Index j = 0; j < coils.cols(); ++j) {
              if (sample.current[j] != 0.0 &&
                  coils.col(j).dot(geometry.poles_rotor.col(4)) > std::cos(0.65)) {
                return true;
              }
            }
            return false;
          }),
      samples.end());
  const CycleOutcome outcome =
      runCycle(model, samples, priorOf(model.space()), {Cycle::kRefine}, {});
  ASSERT_TRUE(outcome.report.success) << outcome.report.message;
  EXPECT_EQ(outcome.report.open_directions.size(), 3U) << outcome.report.message;
  EXPECT_NE(outcome.report.message.find("Pole 5 is seen by no sample"), std::string::npos)
      << outcome.report.message;
  for (const ParameterEstimate& estimate : outcome.report.estimates) {
    if (estimate.name.rfind("pole_", 0) == 0) {
      EXPECT_EQ(estimate.observable, estimate.name.rfind("pole_5/", 0) != 0) << estimate.name;
    }
    if (estimate.name.rfind("pole_5/", 0) == 0) {
      EXPECT_DOUBLE_EQ(estimate.value, estimate.initial);
    }
  }
}

}  // namespace
}  // namespace sac
