#include <algorithm>
#include <cmath>
#include <string>

#include <gtest/gtest.h>

#include "calibration/sensor_noise.hpp"
#include "spherical_actuator_calibration/actuator/spherical_joint.hpp"
#include "spherical_actuator_calibration/actuator/torque_model.hpp"
#include "spherical_actuator_calibration/base/pi.hpp"
#include "spherical_actuator_calibration/calibration/calibration_cycles.hpp"
#include "support/calibration_trials.hpp"
#include "support/scenarios.hpp"

namespace sac {
namespace {

constexpr CycleRequest kPolesCycle{Cycle::kPoles, 0};

class PoleCalibration : public testing::Test {
 protected:
  std::vector<Sample> samples(const std::vector<Eigen::Vector3d>& poses,
                              double noise,
                              std::uint64_t seed) const {
    scenarios::Generator generator(seed);
    return scenarios::torqueSamples(
        truth_, poses, 0, 2.0, noise, scenarios::uniformStddev(kTorqueNoise), generator);
  }

  CycleOutcome run(const std::vector<Sample>& samples) const {
    return runCycle(model_, samples, joints_known_, kPolesCycle, options_);
  }

  /// Smallest distance of any pole–coil angle from the ends of the curve's support [rad].
  double distanceFromSupportEnd(const Eigen::Vector3d& q) const {
    const TorqueGeometry geometry = torqueGeometry(truth_);
    const Eigen::Vector3d coil_rotor =
        rotorOrientation(jointGeometry(truth_.joints), q).transpose() *
        geometry.coils_stator.col(0);
    double smallest = kPi;
    for (Eigen::Index i = 0; i < 8; ++i) {
      const double psi = std::acos(coil_rotor.dot(geometry.poles_rotor.col(i)));
      smallest = std::min(smallest, std::abs(psi - 32.0 * kOneDegree));
    }
    return smallest;
  }

  static bool tells(const CycleOutcome& outcome, const std::string& words) {
    return outcome.report.message.find(words) != std::string::npos;
  }

  const Actuator truth_ = scenarios::paperTruth();
  const CalibrationModel model_{ParameterSpace(scenarios::paperNominal())};
  const ParameterSpace& space_ = model_.space();
  const Eigen::VectorXd x_true_ = space_.coordinatesOf(truth_);
  const CalibrationState joints_known_ =
      scenarios::exactJoints(space_, truth_, ManufacturingTolerance());
  const EstimationOptions options_{};
};

TEST_F(PoleCalibration, RecoversTable5ExactlyFromThirtyOrientations) {
  for (std::uint64_t seed = 0; seed < 50; ++seed) {
    scenarios::Generator generator(seed);
    const auto poses = scenarios::posesThatSeeEveryPole(truth_, 0, 30, 0.3, generator);
    const CycleOutcome outcome = run(samples(poses, 0.0, seed));
    ASSERT_TRUE(outcome.report.success) << outcome.report.message;
    EXPECT_LE(outcome.report.iterations, 8u) << "seed " << seed;
    EXPECT_LT((outcome.state.belief.x - x_true_).segment(9, 18).cwiseAbs().maxCoeff(), 1e-10);
    EXPECT_EQ(outcome.state.belief.x.tail(46), nominalState(space_, {}).belief.x.tail(46));
  }
}

TEST_F(PoleCalibration, ReachesTheBoundAndItsIntervalsAreTrue) {
  TrialStatistics statistics;
  std::vector<Eigen::Index> free;
  for (Eigen::Index p = space_.pole(0); p < space_.coil(1); ++p) {
    free.push_back(p);
  }
  for (std::uint64_t seed = 0; seed < 300; ++seed) {
    scenarios::Generator generator(seed);
    const auto poses = scenarios::posesThatSeeEveryPole(truth_, 0, 30, 0.3, generator);
    const std::vector<Sample> data = samples(poses, kTorqueNoise, 3000 + seed);
    const CycleOutcome outcome = run(data);
    ASSERT_TRUE(outcome.report.success) << outcome.report.message;
    statistics.add(outcome.state.belief,
                   x_true_,
                   free,
                   cramerRaoBound(model_, data, kPolesCycle, free, x_true_));
  }
  RecordProperty("error_over_bound", std::to_string(statistics.errorOverBound()));
  RecordProperty("coverage", std::to_string(statistics.coverage()));
  EXPECT_LE(statistics.meanErrorOverBound(), 1.05);
  EXPECT_LE(statistics.errorOverBound(), 1.05);
  EXPECT_GE(statistics.coverage(), 0.94);
  EXPECT_LE(statistics.coverage(), 0.96);
}

TEST_F(PoleCalibration, NamesThePolesThatNoSampleSees) {
  int degenerate = 0;
  for (std::uint64_t seed = 0; degenerate < 100; ++seed) {
    scenarios::Generator generator(4000 + seed);
    std::vector<Eigen::Vector3d> poses;
    while (poses.size() < 30) {
      // Spin within a window, so that some poles never come near the coil. A pole that just grazes
      // the support is neither seen nor missed: such poses are left out.
      Eigen::Vector3d q = scenarios::randomPose(0.3, generator);
      q[2] = q[2] / 2.0 + static_cast<double>(seed);
      if (distanceFromSupportEnd(q) > 2.0 * kOneDegree) {
        poses.push_back(q);
      }
    }
    const std::vector<bool> seen = scenarios::polesSeen(truth_, 0, poses);
    if (std::find(seen.begin(), seen.end(), false) == seen.end()) {
      continue;
    }
    ++degenerate;
    const CycleOutcome outcome = run(samples(poses, kTorqueNoise, seed));
    ASSERT_TRUE(outcome.report.success) << outcome.report.message;
    for (std::size_t i = 0; i < seen.size(); ++i) {
      const std::string pole = "Pole " + std::to_string(i + 1);
      const bool named = tells(outcome, pole + " is seen by no sample");
      EXPECT_EQ(named, !seen[i]) << "seed " << seed << " " << pole << ": "
                                 << outcome.report.message;
      // A pole may also be seen just once, at the peak of the curve, which tells too little.
      const bool observable = seen[i] && !tells(outcome, pole + " is seen too weakly");
      EXPECT_EQ(outcome.state.identified[static_cast<std::size_t>(space_.pole(i))], observable);
      EXPECT_EQ(outcome.report.estimates[2 * i].observable, observable) << "seed " << seed << pole;
      EXPECT_EQ(outcome.report.estimates[2 * i + 1].observable, observable);
      if (!observable) {
        EXPECT_EQ(outcome.state.belief.x.segment<2>(space_.pole(i)), Eigen::Vector2d::Zero());
      }
    }
  }
}

TEST_F(PoleCalibration, ItsAdviceMakesTheMissedPoleObservable) {
  scenarios::Generator generator(17);
  std::vector<Eigen::Vector3d> poses;
  for (const Eigen::Vector3d& q : scenarios::posesThatSeeEveryPole(truth_, 0, 60, 0.1, generator)) {
    const double spin_of_pole_5 = std::remainder(q[2] - kPi, 2.0 * kPi);
    if (std::abs(spin_of_pole_5) > 0.75) {
      poses.push_back(q);
    }
  }
  const CycleOutcome outcome = run(samples(poses, kTorqueNoise, 1));
  const std::string advice = "Pole 5 is seen by no sample: excite coil 1 with joint_3 near ";
  const std::size_t at = outcome.report.message.find(advice);
  ASSERT_NE(at, std::string::npos) << outcome.report.message;
  const double spin = std::stod(outcome.report.message.substr(at + advice.size()));
  // As an operator would: around the advised spin.
  for (const double step : {-0.1, 0.0, 0.1}) {
    poses.emplace_back(0.0, step, spin + step);
  }
  const CycleOutcome better = run(samples(poses, kTorqueNoise, 2));
  ASSERT_TRUE(better.report.success) << better.report.message;
  EXPECT_EQ(better.report.message.find("Pole 5"), std::string::npos) << better.report.message;
  EXPECT_TRUE(better.state.identified[static_cast<std::size_t>(space_.pole(4))]);
}

TEST_F(PoleCalibration, CurrentsBelowTheThresholdShowNoPole) {
  scenarios::Generator generator(17);
  std::vector<Eigen::Vector3d> poses;
  for (const Eigen::Vector3d& q : scenarios::posesThatSeeEveryPole(truth_, 0, 60, 0.1, generator)) {
    if (std::abs(std::remainder(q[2] - kPi, 2.0 * kPi)) > 0.75) {
      poses.push_back(q);
    }
  }
  std::vector<Sample> data = samples(poses, kTorqueNoise, 1);
  int sign = 1;
  for (Sample& sample : data) {
    for (Eigen::Index j = 1; j < sample.current.size(); ++j) {
      sample.current[j] = 1e-3 * sign;  // what an amplifier measures of a coil that is off
      sign = -sign;
    }
  }
  const CycleOutcome outcome = run(data);
  EXPECT_TRUE(tells(outcome, "Pole 5 is seen by no sample")) << outcome.report.message;
  EXPECT_FALSE(tells(outcome, "Pole 5 is seen too weakly")) << outcome.report.message;
}

TEST_F(PoleCalibration, UsesOnlySamplesWithItsCoilAlone) {
  scenarios::Generator generator(18);
  const auto poses = scenarios::posesThatSeeEveryPole(truth_, 0, 30, 0.3, generator);
  std::vector<Sample> data = samples(poses, kTorqueNoise, 3);
  const CycleOutcome expected = run(data);
  std::vector<Sample> other =
      scenarios::torqueSamples(truth_, poses, 4, 2.0, kTorqueNoise, 1e-3, generator);
  data.insert(data.end(), other.begin(), other.end());
  for (Sample& sample : other) {
    sample.current[0] = 1.0;  // two coils at once
  }
  data.insert(data.end(), other.begin(), other.end());
  EXPECT_EQ(run(data).state.belief.x, expected.state.belief.x);
}

TEST_F(PoleCalibration, RefusesWhatItCannotDo) {
  EXPECT_NE(run({}).report.message.find("No sample has a torque with only coil 1"),
            std::string::npos);
  const CycleOutcome no_coil = runCycle(model_, {}, joints_known_, {Cycle::kPoles, 24}, options_);
  EXPECT_NE(no_coil.report.message.find("Coil 25 does not exist"), std::string::npos);

  Actuator joints_only = scenarios::paperNominal();
  joints_only.poles.clear();
  joints_only.coils.clear();
  joints_only.torque_curve.reset();
  const CalibrationModel joint_model{ParameterSpace(joints_only)};
  const CycleOutcome outcome =
      runCycle(joint_model, {}, nominalState(joint_model.space(), {}), kPolesCycle, options_);
  EXPECT_FALSE(outcome.report.success);
  EXPECT_NE(outcome.report.message.find("only the joint can be calibrated"), std::string::npos);
}

TEST_F(PoleCalibration, RefusesTorquesOfTheWrongSign) {
  scenarios::Generator generator(19);
  const auto poses = scenarios::posesThatSeeEveryPole(truth_, 0, 30, 0.3, generator);
  std::vector<Sample> data = samples(poses, kTorqueNoise, 4);
  for (Sample& sample : data) {
    sample.torque = -sample.torque;
  }
  const CycleOutcome outcome = run(data);
  EXPECT_FALSE(outcome.report.success);
  EXPECT_FALSE(outcome.report.message.empty());
  EXPECT_EQ(outcome.state.belief.x, joints_known_.belief.x);
}

}  // namespace
}  // namespace sac
