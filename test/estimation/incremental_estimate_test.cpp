#include "spherical_actuator_calibration/estimation/incremental_estimate.hpp"

#include <random>

#include <Eigen/Cholesky>

#include <gtest/gtest.h>

#include "spherical_actuator_calibration/base/error.hpp"
#include "spherical_actuator_calibration/estimation/calibration_state.hpp"
#include "spherical_actuator_calibration/estimation/least_squares.hpp"
#include "support/scenarios.hpp"

namespace sac {
namespace {

constexpr double kExact = 1e-9;  // relative

/// Samples of random poses with orientation and torques of several coils, noisy; the readings of
/// each dwell of four share errors.
std::vector<Sample> randomSamples(std::size_t count, std::uint64_t seed, bool with_dwells) {
  scenarios::Generator generator(seed);
  std::normal_distribution<double> normal;
  std::vector<Sample> samples;
  for (std::size_t n = 0; n < count; ++n) {
    const bool is_same = with_dwells && n % 4 != 0;
    const Eigen::Vector3d pose =
        is_same ? samples.back().joint_position : scenarios::randomPose(0.6, generator);
    Sample sample = scenarios::torqueSamples(
        scenarios::paperTruth(), {pose}, (7 * n) % 24, 2.0, 5e-4, 3e-4, generator)[0];
    const Sample seen =
        scenarios::orientationSamples(scenarios::paperTruth(), {pose}, 1e-3, 6e-4, generator)[0];
    sample.has_orientation = n % 3 != 1;
    sample.has_torque = n % 5 != 2;
    sample.R_stator_rotor = seen.R_stator_rotor;
    sample.orientation_stddev = seen.orientation_stddev;
    sample.joint_stddev.setConstant(2e-4);
    sample.dwell = with_dwells ? static_cast<Stamp>(1 + n / 4) : static_cast<Stamp>(1 + n);
    if (with_dwells) {
      sample.joint_shared_stddev.setConstant(1.5e-4);
      sample.torque_shared_stddev = 2e-4;
    }
    samples.push_back(sample);
  }
  return samples;
}

EstimationProblem problemOf(const CalibrationModel& model,
                            const std::vector<Sample>& samples,
                            const ParameterBelief& prior) {
  EstimationProblem problem{&model, &samples, {}, {}, prior};
  for (std::size_t n = 0; n < samples.size(); ++n) {
    if (samples[n].has_orientation) {
      problem.observations.push_back({n, Quantity::kOrientation});
    }
    if (samples[n].has_torque) {
      problem.observations.push_back({n, Quantity::kTorque});
    }
  }
  return problem;
}

/// One Gauss–Newton step over all samples and the prior, from a point: the normal equations of the
/// batch, solved as a whole.
ParameterBelief batch(const CalibrationModel& model,
                      const std::vector<Sample>& samples,
                      const ParameterBelief& prior,
                      const Eigen::VectorXd& at) {
  const EstimationOptions options;
  const EstimationProblem problem = problemOf(model, samples, prior);
  const ObservationEvaluator evaluator(problem, options);
  const SharedErrorModel shared = groupByDwell(problem, options);
  const ModelPoint point = evaluator.at(at);
  const ChosenCoordinates every = ChosenCoordinates::all(at.size());
  InformationSum sum(at.size());
  LinearizedObservation linear;
  WhitenedObservation whitened;
  DwellSum dwell_sum(at.size());
  for (std::size_t n = 0; n < problem.observations.size(); ++n) {
    if (!shared.shares[n]) {
      evaluator.linearize(n, point, linear);
      whiten(linear, whiteningOf(evaluator.noise(n, linear)), every, whitened);
      sum.add(whitened);
    }
  }
  for (const std::vector<std::size_t>& dwell : shared.dwells) {
    dwell_sum.begin();
    for (const std::size_t n : dwell) {
      evaluator.linearize(n, point, linear);
      const Eigen::Matrix3d W = whiteningOf(evaluator.ownNoise(n, linear));
      whiten(linear, W, every, whitened);
      dwell_sum.add(whitened, W * evaluator.sharedErrors(n, linear));
    }
    dwell_sum.addTo(sum);
  }
  const Eigen::MatrixXd before =
      prior.covariance.llt().solve(Eigen::MatrixXd::Identity(at.size(), at.size()));
  const Eigen::LLT<Eigen::MatrixXd> factor(sum.information() + before);
  return {at - factor.solve(sum.gradient() + before * (at - prior.x)),
          factor.solve(Eigen::MatrixXd::Identity(at.size(), at.size()))};
}

void expectEqual(const ParameterBelief& one, const ParameterBelief& other) {
  EXPECT_LT((one.x - other.x).norm(), kExact * other.x.norm());
  const Eigen::VectorXd stddevs = other.covariance.diagonal().cwiseSqrt();
  const Eigen::MatrixXd apart =
      (one.covariance - other.covariance).cwiseQuotient(stddevs * stddevs.transpose());
  EXPECT_LT(apart.cwiseAbs().maxCoeff(), kExact);
}

struct Unit {
  CalibrationModel model{ParameterSpace(scenarios::paperNominal())};
  ParameterBelief prior = nominalState(model.space(), {}).belief;
};

class IncrementalSession : public testing::TestWithParam<bool> {};

TEST_P(IncrementalSession, EqualsTheBatchAfterEverySample) {
  const Unit unit;
  for (const std::uint64_t seed : {1U, 2U, 3U}) {
    const std::vector<Sample> samples = randomSamples(120, seed, GetParam());
    IncrementalEstimate estimate(unit.model, unit.prior, {});
    for (std::size_t n = 0; n < samples.size(); ++n) {
      estimate.add(samples[n]);
      if (n < 9 || n % 20 == 19) {
        const std::vector<Sample> so_far(samples.begin(),
                                         samples.begin() + static_cast<std::ptrdiff_t>(n) + 1);
        expectEqual(estimate.belief(), batch(unit.model, so_far, unit.prior, unit.prior.x));
      }
    }
  }
}

INSTANTIATE_TEST_SUITE_P(WithAndWithoutDwells, IncrementalSession, testing::Bool());

TEST(IncrementalEstimate, RelinearizedItIsTheSolutionOfTheBatch) {
  const Unit unit;
  const std::vector<Sample> samples = randomSamples(120, 4, true);
  IncrementalEstimate estimate(unit.model, unit.prior, {});
  for (const Sample& sample : samples) {
    estimate.add(sample);
  }
  EXPECT_TRUE(estimate.hasMovedFar());
  Eigen::VectorXd at;
  int rounds = 0;
  while (estimate.hasMovedFar()) {
    ASSERT_LT(++rounds, 10);
    at = estimate.belief().x;
    estimate.relinearize(samples);
  }
  expectEqual(estimate.belief(), batch(unit.model, samples, unit.prior, at));
}

TEST(IncrementalEstimate, SamplesHeldOutTellNothing) {
  const Unit unit;
  Sample sample = randomSamples(1, 5, false)[0];
  sample.validation = true;
  IncrementalEstimate estimate(unit.model, unit.prior, {});
  estimate.add(sample);
  EXPECT_EQ(estimate.belief().covariance, unit.prior.covariance);
}

TEST(IncrementalEstimate, WhatDoesNotFitTheModelIsRefused) {
  const Unit unit;
  IncrementalEstimate estimate(unit.model, unit.prior, {});
  Sample sample = randomSamples(1, 6, false)[0];
  sample.current.conservativeResize(3);
  EXPECT_THROW(estimate.add(sample), DataError);
  EXPECT_THROW(IncrementalEstimate(unit.model, {Eigen::VectorXd::Zero(3), {}}, {}), DataError);
}

}  // namespace
}  // namespace sac
