/// Plans with patterns of several coils at once, and the bound that they are told against.

#include <algorithm>
#include <cmath>
#include <numeric>
#include <set>
#include <vector>

#include <Eigen/Core>

#include <gtest/gtest.h>

#include "coil_visits.hpp"
#include "design_bound.hpp"
#include "pattern_bound.hpp"
#include "pattern_search.hpp"
#include "planning/planning_fixture.hpp"
#include "pose_candidates.hpp"
#include "spherical_actuator_calibration/base/error.hpp"
#include "spherical_actuator_calibration/base/noise_source.hpp"
#include "spherical_actuator_calibration/calibration/cycle_problem.hpp"
#include "spherical_actuator_calibration/estimation/linearization.hpp"
#include "spherical_actuator_calibration/planning/pose_planner.hpp"
#include "weighing_design.hpp"

namespace sac {
namespace {

class WeighingPlan : public PlanningFixture {
 protected:
  WeighingPlan() {
    options_.patterns = PlanPatterns::kWeighing;
    options_.candidates = 100;  // for the speed of the tests
  }

  std::vector<PoseCandidate> candidates(std::size_t count, std::uint64_t seed) const {
    PosePlanOptions options = options_;
    options.candidates = count;
    options.seed = seed;
    return drawCandidates(problem_, options, plannedCoordinates(problem_));
  }

  DesignTask task() const {
    const std::vector<Eigen::Index> coordinates = plannedCoordinates(problem_);
    const auto count = static_cast<Eigen::Index>(coordinates.size());
    DesignTask task;
    task.known = 1e3 * Eigen::MatrixXd::Identity(count, count);
    task.reported = reportedDerivative(model_.space(), problem_.state.belief.x, coordinates);
    task.visited.assign(model_.space().coils(), 0);
    return task;
  }
};

/// As many as there are, all of them drawn from a seed.
std::vector<DesignedPose> randomDesign(const std::vector<PoseCandidate>& candidates,
                                       const DesignTask& task,
                                       std::size_t visits,
                                       std::uint64_t seed) {
  NoiseSource noise(seed, RandomPurpose::kPoseCandidates);
  const auto below = [&noise](std::size_t count) {
    return static_cast<std::size_t>(noise.share() * static_cast<double>(count));
  };
  std::vector<DesignedPose> design(visits);
  for (DesignedPose& pose : design) {
    do {
      pose.candidate = below(candidates.size());
    } while (candidates[pose.candidate].terms.size() < task.coils_per_pattern);
    std::vector<std::size_t> terms(candidates[pose.candidate].terms.size());
    std::iota(terms.begin(), terms.end(), 0);
    pose.patterns.resize(task.patterns_per_pose);
    for (TermPattern& pattern : pose.patterns) {
      for (std::size_t n = 0; n < task.coils_per_pattern; ++n) {
        std::swap(terms[n], terms[n + below(terms.size() - n)]);
        pattern.push_back({terms[n], noise.share() < 0.5 ? 1 : -1});
      }
    }
  }
  return design;
}

double worstStddev(const DesignTask& task,
                   const std::vector<PoseCandidate>& candidates,
                   const std::vector<DesignedPose>& design) {
  const Eigen::MatrixXd information = designInformation(task, candidates, design);
  return std::sqrt(reportedVariances(task, covarianceOf(information)).maxCoeff());
}

TEST_F(WeighingPlan, OfTenPosesAndSixtyTorquesBeatsOneCoilAtATimeAndComesNearTheBound) {
  options_.candidates = PosePlanOptions{}.candidates;
  const PosePlan plan = planPoses(problem_, options_);
  ASSERT_TRUE(plan.success) << plan.message;
  EXPECT_LE(plan.poses.size(), 10U);
  EXPECT_LE(plan.torque_samples, 60U);
  EXPECT_LE(plan.worst_stddev, 0.20e-3);
  ASSERT_TRUE(plan.stddev_bound.has_value());
  EXPECT_LE(plan.worst_stddev, 1.05 * *plan.stddev_bound);
  EXPECT_GE(plan.worst_stddev, *plan.stddev_bound);
  EXPECT_NE(plan.message.find("of what any plan of as many poses and torques could reach"),
            std::string::npos)
      << plan.message;
  options_.patterns = PlanPatterns::kSingle;
  EXPECT_LT(plan.worst_stddev, 0.9 * planPoses(problem_, options_).worst_stddev);
}

TEST_F(WeighingPlan, OfFewPosesExcitesCoilsOnceAPatternAndAtTwoPoses) {
  for (const std::size_t poses : {2U, 4U, 8U}) {
    options_.max_poses = poses;
    std::vector<std::size_t> visits(model_.space().coils(), 0);
    for (const PlannedPose& pose : planPoses(problem_, options_).poses) {
      for (const std::size_t coil : pose.coils) {
        ++visits[coil];
      }
      for (const CoilPattern& pattern : pose.patterns) {
        std::set<std::size_t> coils;
        for (const SignedCoil& coil : pattern) {
          EXPECT_TRUE(coils.insert(coil.coil).second) << "coil " << coil.coil << " twice";
        }
      }
    }
    // Fewer poses do not see every coil well at two of them.
    if (poses > 4) {
      EXPECT_GE(*std::min_element(visits.begin(), visits.end()), 2U) << poses << " poses";
    }
  }
}

TEST_F(WeighingPlan, CountsPosesThatAreMeasuredForEachCoil) {
  Sample sample;
  sample.has_torque = true;
  sample.current = Eigen::VectorXd::Zero(3);
  sample.current[0] = -2.0;
  std::vector<Sample> samples(5, sample);
  samples[1].joint_position.x() = 0.05;
  samples[2].joint_position.x() = 0.2;
  samples[2].current[1] = 0.04;
  samples[3].joint_position.x() = 0.4;
  samples[3].current[1] = 2.0;
  samples[4].joint_position.x() = -0.4;
  samples[4].current[2] = 2.0;
  samples[4].validation = true;
  EXPECT_EQ(measuredVisits(samples, 3, 0.05, 0.1), (std::vector<std::size_t>{2, 1, 0}));
}

TEST_F(WeighingPlan, ExpectsTheCramerRaoBoundOfTheSamplesThatItAsksFor) {
  const PosePlan plan = planPoses(problem_, options_);
  EXPECT_NEAR(plan.worst_stddev / boundOf(samplesOf(plan)).maxCoeff(), 1.0, 1e-6);
}

TEST_F(WeighingPlan, KeepsTheLimitsOfCurrents) {
  options_.total_current = 7.0;  // three coils of 2 A
  options_.max_poses = 8;
  const PosePlan plan = planPoses(problem_, options_);
  ASSERT_EQ(plan.poses.size(), 8U);
  bool has_negative = false;
  for (const PlannedPose& pose : plan.poses) {
    EXPECT_LE(pose.patterns.size(), options_.coils_per_pose);
    for (const CoilPattern& pattern : pose.patterns) {
      EXPECT_EQ(pattern.size(), 3U);
      for (const SignedCoil& coil : pattern) {
        EXPECT_TRUE(std::binary_search(pose.coils.begin(), pose.coils.end(), coil.coil));
        has_negative = has_negative || coil.sign == -1;
      }
    }
    for (const Sample& sample :
         visitSamples(problem_, options_, pose.joint_position, pose.excitations())) {
      EXPECT_LE(sample.current.cwiseAbs().maxCoeff(), 2.0);
      EXPECT_LE(sample.current.cwiseAbs().sum(), 7.0);
    }
  }
  EXPECT_TRUE(has_negative);
}

TEST_F(WeighingPlan, GivesTheSamePlanForTheSameSeed) {
  options_.max_poses = 6;
  const PosePlan first = planPoses(problem_, options_);
  const PosePlan again = planPoses(problem_, options_);
  ASSERT_EQ(first.poses.size(), again.poses.size());
  for (std::size_t n = 0; n < first.poses.size(); ++n) {
    EXPECT_EQ(first.poses[n].joint_position, again.poses[n].joint_position);
    EXPECT_EQ(first.poses[n].patterns, again.poses[n].patterns);
  }
  EXPECT_EQ(first.stddev_bound, again.stddev_bound);
}

TEST_F(WeighingPlan, IsThereWhateverTimeIsLeft) {
  const PosePlan whole = planPoses(problem_, options_);
  double last = 1.0;
  for (const int asked : {0, 10, 60}) {
    options_.is_time_up = [left = asked]() mutable { return left-- <= 0; };
    const PosePlan plan = planPoses(problem_, options_);
    EXPECT_TRUE(plan.success) << plan.message;
    EXPECT_EQ(plan.poses.size(), 10U);
    EXPECT_EQ(plan.torque_samples, 60U);
    EXPECT_EQ(plan.stddev_bound.has_value(), asked > 0);
    EXPECT_LE(plan.worst_stddev, (1.0 + 1e-9) * last);
    last = plan.worst_stddev;
  }
  EXPECT_LE(whole.worst_stddev, last);
}

TEST_F(WeighingPlan, StopsAtTheWantedStandardDeviation) {
  options_.max_poses = 20;
  options_.wanted_stddev = 2.5e-4;
  const PosePlan plan = planPoses(problem_, options_);
  EXPECT_TRUE(plan.reached_wanted);
  EXPECT_LE(plan.worst_stddev, 2.5e-4);
  EXPECT_LE(plan.poses.size(), 8U);
  EXPECT_TRUE(plan.stddev_bound.has_value());
}

TEST_F(WeighingPlan, IsForTheJointCycleOnly) {
  problem_.request = {Cycle::kJoint};
  for (const PlannedPose& pose : planPoses(problem_, options_).poses) {
    EXPECT_TRUE(pose.patterns.empty());
  }
}

TEST_F(WeighingPlan, RefusesATotalBelowOneCoil) {
  options_.total_current = 1.9;
  EXPECT_THROW(planPoses(problem_, options_), ConfigError);
}

/// Information of samples of one visit each, with their dense covariance: errors of the readings
/// are common to all samples of a visit.
Eigen::MatrixXd denseInformation(const CalibrationModel& model,
                                 const std::vector<std::vector<Sample>>& visits,
                                 const Eigen::VectorXd& x) {
  Eigen::MatrixXd information = Eigen::MatrixXd::Zero(x.size(), x.size());
  for (const std::vector<Sample>& samples : visits) {
    const EstimationOptions options;
    EstimationProblem problem;
    problem.model = &model;
    problem.samples = &samples;
    problem.observations = selectObservations(model.space(), samples, {Cycle::kRefine}, options);
    problem.prior.x = x;
    problem.prior.covariance = Eigen::MatrixXd::Zero(x.size(), x.size());
    const ObservationEvaluator evaluator(problem, options);
    const auto rows = static_cast<Eigen::Index>(3 * problem.observations.size());
    Eigen::MatrixXd J(rows, x.size());
    Eigen::MatrixXd of_readings(rows, 3);
    Eigen::MatrixXd covariance = Eigen::MatrixXd::Zero(rows, rows);
    LinearizedObservation linear;
    for (Eigen::Index n = 0; n < rows / 3; ++n) {
      evaluator.linearize(static_cast<std::size_t>(n), evaluator.at(x), linear);
      J.middleRows<3>(3 * n) = linear.jacobian;
      of_readings.middleRows<3>(3 * n) =
          linear.d_pose.reading * samples.front().joint_stddev.asDiagonal();
      covariance.diagonal().segment<3>(3 * n).setConstant(
          evaluator.ownVariance(static_cast<std::size_t>(n)));
    }
    covariance += of_readings * of_readings.transpose();
    information += J.transpose() * covariance.llt().solve(J);
  }
  return information;
}

// With an effect that no current turns, and readings of joints that are not exact.
TEST_F(WeighingPlan, CountsWhatAVisitTellsWithTheErrorsOfItsReadings) {
  EffectSelection effects;
  effects["torque_bias"] = true;
  const CalibrationModel with_bias{ParameterSpace(nominal_, effects)};
  problem_.model = &with_bias;
  problem_.state = nominalState(with_bias.space(), {});
  options_.joint_stddev = {3e-4, 5e-4, 1e-3};
  const std::vector<PoseCandidate> chosen = candidates(50, 3);
  const Eigen::Index count = with_bias.space().size();
  DesignTask biased;
  biased.known = 1e3 * Eigen::MatrixXd::Identity(count, count);
  const std::vector<DesignedPose> design = randomDesign(chosen, biased, 12, 1);
  std::vector<std::vector<Sample>> visits;
  for (const DesignedPose& pose : design) {
    const PoseCandidate& at = chosen[pose.candidate];
    std::vector<CoilPattern> patterns;
    for (const TermPattern& terms : pose.patterns) {
      CoilPattern& pattern = patterns.emplace_back();
      for (const SignedTerm& term : terms) {
        pattern.push_back({at.coils[term.term], term.sign});
      }
    }
    visits.push_back(visitSamples(problem_, options_, at.joint_position, patterns));
    for (Sample& sample : visits.back()) {
      predictMeasurements({with_bias, problem_.state.belief.x}, sample);
    }
  }
  const Eigen::MatrixXd theirs =
      biased.known + denseInformation(with_bias, visits, problem_.state.belief.x);
  const Eigen::MatrixXd ours = designInformation(biased, chosen, design);
  EXPECT_LT((ours - theirs).norm(), 1e-9 * theirs.norm());
  // The same with the errors of one pose beside the coordinates.
  const Eigen::MatrixXd expected = covarianceOf(theirs);
  const Eigen::MatrixXd at_pose = covarianceAtPose(biased, chosen, design, 4);
  EXPECT_LT((at_pose.topLeftCorner(count, count) - expected).norm(), 1e-9 * expected.norm());
}

TEST(PatternBound, IsTheLargestOfAllPatterns) {
  NoiseSource noise(4, RandomPurpose::kPoseCandidates);
  for (const Eigen::Index extra : {0, 1}) {
    Eigen::MatrixXd root(3, 6 + extra);
    for (Eigen::Index k = 0; k < root.size(); ++k) {
      root(k % root.rows(), k / root.rows()) = noise.uniform(1.0);
    }
    const Eigen::MatrixXd Q = root.transpose() * root;
    // Each coil of six off, or with either sign: at most three at once.
    double largest = 0.0;
    for (int code = 0; code < 729; ++code) {
      Eigen::VectorXd s = Eigen::VectorXd::Ones(6 + extra);
      int rest = code;
      for (Eigen::Index n = 0; n < 6; ++n, rest /= 3) {
        s[n] = rest % 3 - 1;
      }
      if (s.head(6).cwiseAbs().sum() <= 3.0) {
        largest = std::max(largest, s.dot(Q * s));
      }
    }
    EXPECT_NEAR(largestForm(Q, 6, 3, 0.0).value, largest, 1e-12);
    EXPECT_EQ(largestForm(Q, 6, 3, 2.0 * largest).value, 2.0 * largest);
    // No current between does better.
    for (int n = 0; n < 2000; ++n) {
      Eigen::VectorXd s = Eigen::VectorXd::Ones(6 + extra);
      for (Eigen::Index coil = 0; coil < 6; ++coil) {
        s[coil] = noise.uniform(1.0);
      }
      s.head(6) *= std::min(1.0, 3.0 / s.head(6).cwiseAbs().sum());
      EXPECT_LE(s.dot(Q * s), largest);
    }
  }
}

TEST_F(WeighingPlan, BoundHoldsForOtherDesignsAndOnOtherPoses) {
  const std::vector<PoseCandidate> chosen = candidates(500, 1);
  DesignTask task = this->task();
  WeighingDesign design(task, chosen, {0, 1, 2, 3, 4, 5, 6, 7, 8, 9}, {});
  design.choosePatterns();
  DesignBound bound(task, chosen, 10, designInformation(task, chosen, design.poses()));
  bound.improve({});
  design.exchange();
  EXPECT_GE(design.worstStddev(), bound.stddev());
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    EXPECT_GT(worstStddev(task, chosen, randomDesign(chosen, task, 10, seed)), bound.stddev());
  }
  // Ten times as many poses lower it by little, and never raise it.
  const double dense = bound.stddevOver(candidates(5000, 2));
  EXPECT_LE(dense, bound.stddev());
  EXPECT_GE(dense, 0.97 * bound.stddev());
}

TEST_F(WeighingPlan, BoundHoldsForTheBestOfAllDesigns) {
  // Few enough to try them all: two visits, one torque each, of the one pattern of two coils.
  std::vector<PoseCandidate> chosen = candidates(12, 5);
  DesignTask task = this->task();
  task.patterns_per_pose = 1;
  task.coils_per_pattern = 2;
  task.minimum_spacing = 0.0;
  task.known = designInformation(task, chosen, randomDesign(chosen, task, 60, 1));
  double best = 1.0;
  std::vector<std::vector<DesignedPose>> visits;
  for (std::size_t c = 0; c < chosen.size(); ++c) {
    chosen[c].terms.resize(std::min<std::size_t>(3, chosen[c].terms.size()));
    for (std::size_t a = 0; a < chosen[c].terms.size(); ++a) {
      for (std::size_t b = a + 1; b < chosen[c].terms.size(); ++b) {
        for (const int sign : {1, -1}) {
          visits.push_back({{c, {{{a, 1}, {b, sign}}}}});
        }
      }
    }
  }
  for (const auto& first : visits) {
    for (const auto& second : visits) {
      best = std::min(best, worstStddev(task, chosen, {first.front(), second.front()}));
    }
  }
  DesignBound bound(task, chosen, 2, designInformation(task, chosen, {visits[0][0], visits[9][0]}));
  bound.improve({});
  EXPECT_LE(bound.stddev(), best);
  EXPECT_GE(bound.stddev(), 0.9 * best);
}

}  // namespace
}  // namespace sac
