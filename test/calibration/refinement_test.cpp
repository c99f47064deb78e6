#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "spherical_actuator_calibration/calibration/calibration_cycles.hpp"
#include "support/calibration_trials.hpp"
#include "support/scenarios.hpp"

namespace sac {
namespace {

/// Ten tracker poses, 30 torque poses of coil 1, four of each other coil, tilt ±0.3, the paper's
/// noise.
class Refinement : public testing::Test {
 protected:
  Refinement() { std::iota(all_.begin(), all_.end(), 0); }

  /// Poles and coils as of a session's first samples; the refinement starts from the joint cycle.
  CycleOutcome refine(const std::vector<Sample>& samples) const {
    CalibrationState state = nominalState(space_, ManufacturingTolerance());
    for (const CycleRequest& request : {CycleRequest{Cycle::kJoint}, {Cycle::kPoles, 0}}) {
      const CycleOutcome outcome = runCycle(model_, samples, state, request, options_);
      EXPECT_TRUE(outcome.report.success) << outcome.report.message;
      state = outcome.state;
    }
    return runCycle(model_, samples, state, kRefine, options_);
  }

  /// Ratio to the bound of all parameters, joints, poles and coils, and their coverage, over
  /// trials.
  void checkTrials(scenarios::Tracker tracker) const {
    TrialStatistics everything;
    TrialStatistics joints;
    TrialStatistics poles;
    TrialStatistics coils;
    for (std::uint64_t seed = 0; seed < 300; ++seed) {
      scenarios::Generator generator(seed);
      const Actuator truth = scenarios::perturbed(scenarios::paperNominal(), 0.03, 0.02, generator);
      const std::vector<Sample> samples = scenarios::paperSession(truth, tracker, generator);
      const CycleOutcome outcome = refine(samples);
      ASSERT_TRUE(outcome.report.success) << outcome.report.message;
      EXPECT_EQ(outcome.report.samples_rejected, 0u) << outcome.report.message;
      const Eigen::VectorXd x_true = space_.coordinatesOf(truth);
      const Eigen::MatrixXd bound = cramerRaoBound(model_, samples, kRefine, all_, x_true);
      everything.add(outcome.state.belief, x_true, all_, bound);
      const auto add_group = [&](TrialStatistics& group, Eigen::Index first, Eigen::Index last) {
        const std::vector<Eigen::Index> free(all_.begin() + first, all_.begin() + last);
        group.add(outcome.state.belief,
                  x_true,
                  free,
                  bound.block(first, first, last - first, last - first));
      };
      add_group(joints, 0, space_.pole(0));
      add_group(poles, space_.pole(0), space_.coil(0));
      add_group(coils, space_.coil(0), space_.size());
    }
    RecordProperty("error_over_bound", std::to_string(everything.errorOverBound()));
    RecordProperty("coverage", std::to_string(everything.coverage()));
    EXPECT_LE(everything.meanErrorOverBound(), 1.03);
    EXPECT_LE(joints.meanErrorOverBound(), 1.03);
    EXPECT_LE(poles.meanErrorOverBound(), 1.03);
    EXPECT_LE(coils.meanErrorOverBound(), 1.03);
    EXPECT_GE(everything.coverage(), 0.94);
    EXPECT_LE(everything.coverage(), 0.96);
  }

  static constexpr CycleRequest kRefine{Cycle::kRefine};
  const CalibrationModel model_{ParameterSpace(scenarios::paperNominal())};
  const ParameterSpace& space_ = model_.space();
  const EstimationOptions options_{};
  std::vector<Eigen::Index> all_ = std::vector<Eigen::Index>(73);
};

TEST_F(Refinement, NamesAxesThatHaveTwoPlacesInOneSentence) {
  scenarios::Generator generator(4);
  std::vector<Sample> samples = scenarios::paperSession(
      scenarios::paperTruth(), scenarios::Tracker::kFirstTenPoses, generator);
  // One torque is left of each of these coils.
  for (const Eigen::Index coil : {5, 22}) {
    const auto excites = [coil](const Sample& sample) {
      return sample.has_torque && std::abs(sample.current[coil]) > 1.0;
    };
    const auto first = std::find_if(samples.begin(), samples.end(), excites);
    ASSERT_NE(first, samples.end());
    samples.erase(std::remove_if(first + 1, samples.end(), excites), samples.end());
  }
  const CycleReport report = refine(samples).report;
  ASSERT_TRUE(report.success) << report.message;
  const std::string places = "Ambiguous: other places of coil 6 and coil 23 explain their torques";
  EXPECT_NE(report.message.find(places), std::string::npos) << report.message;
}

TEST_F(Refinement, ReachesTheBoundWithTheTrackerAtTenPoses) {
  checkTrials(scenarios::Tracker::kFirstTenPoses);
}

TEST_F(Refinement, ReachesTheBoundWithTheTrackerAtEveryPose) {
  checkTrials(scenarios::Tracker::kEveryPose);
}

TEST_F(Refinement, UsesSamplesWithSeveralCoilsAtOnce) {
  scenarios::Generator generator(77);
  const Actuator truth = scenarios::perturbed(scenarios::paperNominal(), 0.03, 0.02, generator);
  std::vector<Sample> samples =
      scenarios::paperSession(truth, scenarios::Tracker::kFirstTenPoses, generator);
  const double before = refine(samples).report.torque_uncertainty;
  for (const Eigen::Vector3d& q : scenarios::randomPoses(40, 0.3, generator)) {
    samples.push_back(scenarios::mixedTorqueSample(truth, q, {1.5, -1.0, 2.0}, generator));
  }
  const CycleOutcome outcome = refine(samples);
  ASSERT_TRUE(outcome.report.success) << outcome.report.message;
  EXPECT_EQ(outcome.report.samples_used, 172u);
  EXPECT_LT(outcome.report.torque_uncertainty, before);
  EXPECT_NEAR(outcome.report.reduced_chi_square, 1.0, 0.2);
}

// Errors of the readings weigh by how the torque changes with them, which parameters decide.
TEST_F(Refinement, DoesNotDependOnTheCyclesBeforeIt) {
  constexpr double kReadingNoise = 2e-4;
  scenarios::Generator generator(79);
  const Actuator truth = scenarios::perturbed(scenarios::paperNominal(), 0.03, 0.02, generator);
  std::vector<Sample> samples =
      scenarios::paperSession(truth, scenarios::Tracker::kFirstTenPoses, generator);
  std::normal_distribution<double> noise(0.0, kReadingNoise);
  for (Sample& sample : samples) {
    sample.joint_stddev.setConstant(kReadingNoise);
    sample.joint_position += Eigen::Vector3d::NullaryExpr([&] { return noise(generator); });
  }
  const CycleOutcome after_others = refine(samples);
  CalibrationState start = nominalState(space_, ManufacturingTolerance());
  const CycleOutcome by_itself = runCycle(model_, samples, start, kRefine, options_);
  start.belief.x = after_others.state.belief.x;
  const CycleOutcome from_there = runCycle(model_, samples, start, kRefine, options_);
  for (const CycleOutcome& outcome : {by_itself, from_there}) {
    ASSERT_TRUE(outcome.report.success) << outcome.report.message;
    const Eigen::VectorXd apart = outcome.state.belief.x - after_others.state.belief.x;
    EXPECT_LT(apart.lpNorm<Eigen::Infinity>(), 1e-12);
  }
}

TEST_F(Refinement, LeavesCoilsWithoutSamplesAlone) {
  scenarios::Generator generator(78);
  const Actuator truth = scenarios::perturbed(scenarios::paperNominal(), 0.03, 0.02, generator);
  std::vector<Sample> samples =
      scenarios::paperSession(truth, scenarios::Tracker::kFirstTenPoses, generator);
  const auto excites_coil_24 = [](const Sample& sample) {
    return sample.has_torque && sample.current[23] != 0.0;
  };
  samples.erase(std::remove_if(samples.begin(), samples.end(), excites_coil_24), samples.end());
  const CycleOutcome outcome = refine(samples);
  ASSERT_TRUE(outcome.report.success) << outcome.report.message;
  EXPECT_EQ(outcome.report.estimates.size(), 71u);
  EXPECT_FALSE(outcome.state.identified[static_cast<std::size_t>(space_.coil(23))]);
  EXPECT_EQ(outcome.state.belief.x.tail<2>(), Eigen::Vector2d::Zero());
}

}  // namespace
}  // namespace sac
