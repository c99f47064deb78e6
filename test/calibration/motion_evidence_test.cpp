#include "spherical_actuator_calibration/calibration/motion_evidence.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <numeric>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include <Eigen/Cholesky>

#include <gtest/gtest.h>

#include "spherical_actuator_calibration/calibration/calibration_session.hpp"
#include "support/moving_rotor.hpp"
#include "support/scenarios.hpp"

namespace sac {
namespace {

constexpr double kStated = 1e-3;  // [rad] of the tracker's registration

/// Two linear measurements of all parameters of a joint with a tracker whose registration is
/// stated.
class TwoMeasurements {
 public:
  explicit TwoMeasurements(unsigned seed) : random_(seed), space_(bare(), selection()) {
    truth_ = 0.01 * normal(space_.size());
    for (Eigen::Index p = space_.effect(); p < space_.size(); ++p) {
      const double sigma = std::sqrt(space_.effects().statedVariance(p - space_.effect()));
      truth_[p] *= 100.0 * sigma;
      stated_.push_back({p, sigma});
    }
    for (Part& part : parts_) {
      part.jacobian = Eigen::MatrixXd(40, space_.size());
      for (Eigen::Index k = 0; k < part.jacobian.cols(); ++k) {
        part.jacobian.col(k) = 1e4 * normal(40);
      }
      part.value = part.jacobian * truth_ + normal(40);
    }
  }

  const ParameterSpace& space() const { return space_; }
  void shiftSecond(double shift) { parts_[1].value += parts_[1].jacobian.col(0) * shift; }

  /// What some parts tell together with what is stated.
  ParameterBelief belief(bool first, bool second) const {
    const Eigen::Index size = space_.size();
    Eigen::MatrixXd information = Eigen::MatrixXd::Zero(size, size);
    Eigen::VectorXd vector = Eigen::VectorXd::Zero(size);
    for (std::size_t n = 0; n < 2; ++n) {
      if (n == 0 ? first : second) {
        information += parts_[n].jacobian.transpose() * parts_[n].jacobian;
        vector += parts_[n].jacobian.transpose() * parts_[n].value;
      }
    }
    for (const auto& [p, sigma] : stated_) {
      information(p, p) += 1.0 / (sigma * sigma);
    }
    ParameterBelief result;
    result.covariance = information.llt().solve(Eigen::MatrixXd::Identity(size, size));
    result.x = result.covariance * vector;
    return result;
  }

  MotionEvidence second() const {
    MotionEvidence evidence;
    evidence.belief = belief(false, true);
    evidence.told.resize(static_cast<std::size_t>(space_.size()));
    std::iota(evidence.told.begin(), evidence.told.end(), 0);
    return evidence;
  }

 private:
  struct Part {
    Eigen::MatrixXd jacobian;
    Eigen::VectorXd value;
  };

  static Actuator bare() {
    Actuator actuator = scenarios::paperNominal();
    actuator.poles.clear();
    actuator.coils.clear();
    actuator.torque_curve.reset();
    return actuator;
  }

  static EffectSelection selection() {
    CalibrationConfig config;
    RegistrationUncertainty registration;
    registration.stator_tracker = kStated;
    stateRegistration(config, registration);
    return config.effects;
  }

  Eigen::VectorXd normal(Eigen::Index size) {
    std::normal_distribution<double> distribution;
    return Eigen::VectorXd::NullaryExpr(size, [&](Eigen::Index) { return distribution(random_); });
  }

  std::mt19937 random_;
  ParameterSpace space_;
  Eigen::VectorXd truth_;
  std::vector<std::pair<Eigen::Index, double>> stated_;
  std::array<Part, 2> parts_;
};

TEST(CombinedBelief, IsThatOfOneProblemWithBoth) {
  const TwoMeasurements two(1);
  ASSERT_GT(two.space().size(), two.space().effect());
  const CombinedBelief found = combined(two.space(), two.belief(true, false), two.second());
  const ParameterBelief expected = two.belief(true, true);
  const Eigen::VectorXd stddevs = expected.covariance.diagonal().cwiseSqrt();
  EXPECT_LT((found.belief.x - expected.x).cwiseQuotient(stddevs).cwiseAbs().maxCoeff(), 1e-6);
  const Eigen::MatrixXd apart = found.belief.covariance - expected.covariance;
  EXPECT_LT(apart.cwiseQuotient(stddevs * stddevs.transpose()).cwiseAbs().maxCoeff(), 1e-6);
}

TEST(CombinedBelief, DiffersByChanceAsOftenAsItSays) {
  int rare = 0;
  for (unsigned seed = 1; seed <= 400; ++seed) {
    const TwoMeasurements two(seed);
    const double probability =
        combined(two.space(), two.belief(true, false), two.second()).probability;
    rare += probability < 0.1 ? 1 : 0;
  }
  EXPECT_NEAR(rare, 40, 20);
}

TEST(CombinedBelief, TellsThatOneOfBothIsWrong) {
  TwoMeasurements two(1);
  two.shiftSecond(1e-3);
  EXPECT_LT(combined(two.space(), two.belief(true, false), two.second()).probability, 1e-6);
}

class MotionThenSamples : public ::testing::Test {
 protected:
  MotionThenSamples() {
    scenarios::Generator generator(3);
    moving_.truth = scenarios::perturbed(scenarios::paperNominal(), 0.02, 0.02, generator);
    samples_ = scenarios::paperSession(moving_.truth, scenarios::Tracker::kEveryPose, generator);
  }

  CalibrationSession session(std::vector<Sample> samples) const {
    CalibrationSession session({scenarios::paperNominal()}, std::move(samples), {});
    session.setMotion(std::make_shared<const MotionRecording>(moving_.record()));
    return session;
  }

  static double worst(const CalibrationSession& session) {
    return std::sqrt(session.state().belief.covariance.diagonal().maxCoeff());
  }

  MovingRotor moving_;
  std::vector<Sample> samples_;
};

TEST_F(MotionThenSamples, AreCalibratedTogether) {
  CalibrationSession alone = session(samples_);
  ASSERT_TRUE(alone.run({Cycle::kRefine}).success);
  CalibrationSession both = session(samples_);
  ASSERT_TRUE(both.run({Cycle::kMotion}).success);
  const double by_motion = worst(both);
  const CycleReport report = both.run({Cycle::kRefine});
  ASSERT_TRUE(report.success) << report.message;
  EXPECT_NE(report.message.find("both agree"), std::string::npos) << report.message;
  EXPECT_LT(worst(both), std::min(by_motion, worst(alone)));
  const Eigen::VectorXd apart =
      both.state().belief.x - both.model().space().coordinatesOf(moving_.truth);
  EXPECT_LT(apart.cwiseAbs().maxCoeff(), 1e-4);
  // Nothing counts twice.
  const Eigen::MatrixXd covariance = both.state().belief.covariance;
  ASSERT_TRUE(both.run({Cycle::kRefine}).success);
  EXPECT_LT((both.state().belief.covariance - covariance).norm(), 1e-3 * covariance.norm());
}

// Windows that were held out judge a refinement after the motion, too: nothing else does here.
TEST_F(MotionThenSamples, AreJudgedByTheWindowsHeldOut) {
  moving_.duration = 10.6;
  CalibrationSession both = session(samples_);
  ASSERT_TRUE(both.run({Cycle::kMotion}).success);
  const std::optional<HeldOutValidation> of_motion = both.validation();
  ASSERT_TRUE(of_motion && of_motion->hasVerdict());
  EXPECT_TRUE(of_motion->is_of_windows);
  EXPECT_NE(verdict(*of_motion).find(" held-out windows:"), std::string::npos);
  ASSERT_TRUE(both.run({Cycle::kRefine}).success);
  const std::optional<HeldOutValidation> of_both = both.validation();
  ASSERT_TRUE(of_both && of_both->hasVerdict());
  EXPECT_EQ(of_both->samples, of_motion->samples);
  EXPECT_EQ(of_both->probability, of_motion->probability);
}

TEST_F(MotionThenSamples, AreJudgedByTheWorseOfWindowsAndSamples) {
  moving_.duration = 10.6;
  for (std::size_t n = 0; n < samples_.size(); n += 10) {
    samples_[n].validation = true;
    samples_[n].torque += Eigen::Vector3d(0.0, 0.0, 0.05);
  }
  CalibrationSession both = session(samples_);
  ASSERT_TRUE(both.run({Cycle::kMotion}).success);
  const std::optional<HeldOutValidation> of_motion = both.validation();
  ASSERT_TRUE(both.run({Cycle::kRefine}).success);
  const std::optional<HeldOutValidation> of_both = both.validation();
  ASSERT_TRUE(of_motion && of_both);
  EXPECT_LT(of_both->probability, 1e-6);
  EXPECT_LT(of_both->probability, of_motion->probability);
  EXPECT_FALSE(of_both->is_of_windows);
}

// Orientations alone: the poles stay those of the motion.
TEST_F(MotionThenSamples, KeepsWhatSamplesDoNotTell) {
  for (Sample& sample : samples_) {
    sample.has_torque = false;
  }
  CalibrationSession both = session(samples_);
  ASSERT_TRUE(both.run({Cycle::kMotion}).success);
  const CalibrationState moved = both.state();
  ASSERT_TRUE(both.run({Cycle::kRefine}).success);
  const ParameterSpace& space = both.model().space();
  EXPECT_EQ(both.state().identified, moved.identified);
  for (Eigen::Index p = 0; p < space.size(); ++p) {
    EXPECT_LE(both.state().belief.covariance(p, p), 1.001 * moved.belief.covariance(p, p))
        << space.name(p);
  }
}

// One torque of a coil has several places of it, and the motion knows which.
TEST_F(MotionThenSamples, LeaveNothingAmbiguousThatTheMotionTold) {
  scenarios::Generator generator(4);
  moving_.truth = scenarios::paperTruth();
  samples_ = scenarios::paperSession(moving_.truth, scenarios::Tracker::kFirstTenPoses, generator);
  for (const Eigen::Index coil : {5, 22}) {
    const auto excites = [coil](const Sample& sample) {
      return sample.has_torque && std::abs(sample.current[coil]) > 1.0;
    };
    const auto first = std::find_if(samples_.begin(), samples_.end(), excites);
    ASSERT_NE(first, samples_.end());
    samples_.erase(std::remove_if(first + 1, samples_.end(), excites), samples_.end());
  }
  CalibrationSession alone = session(samples_);
  const CycleReport of_samples = alone.run({Cycle::kRefine});
  ASSERT_NE(of_samples.message.find("Ambiguous"), std::string::npos) << of_samples.message;
  CalibrationSession both = session(samples_);
  ASSERT_TRUE(both.run({Cycle::kMotion}).success);
  const CycleReport report = both.run({Cycle::kRefine});
  ASSERT_TRUE(report.success) << report.message;
  EXPECT_EQ(report.message.find("Ambiguous"), std::string::npos) << report.message;
}

// Samples that an estimate gets lost with, here for want of iterations, take nothing from a motion
// that they agree with.
TEST_F(MotionThenSamples, ThatTellTooLittleAreJudgedByTheMotion) {
  CalibrationSession both = session(samples_);
  ASSERT_TRUE(both.run({Cycle::kMotion}).success);
  const auto refined = [&](const std::vector<Sample>& samples) {
    EstimationOptions hasty;
    hasty.max_iterations = 1;
    return runCycle(both.model(),
                    samples,
                    both.state(),
                    {Cycle::kRefine},
                    hasty,
                    &*both.motionEvidence())
        .report;
  };
  const CycleReport agreeing = refined(samples_);
  EXPECT_FALSE(agreeing.success);
  EXPECT_FALSE(agreeing.contradicted) << agreeing.message;
  EXPECT_NE(agreeing.message.find("agree with it"), std::string::npos) << agreeing.message;
  for (Sample& sample : samples_) {
    sample.torque *= 1.05;
  }
  const CycleReport other = refined(samples_);
  EXPECT_TRUE(other.contradicted);
  EXPECT_NE(other.message.find("contradict it"), std::string::npos) << other.message;
}

TEST_F(MotionThenSamples, ThatContradictEachOtherAreRefused) {
  moving_.truth = scenarios::paperNominal();  // a motion of another unit
  CalibrationSession both = session(samples_);
  ASSERT_TRUE(both.run({Cycle::kMotion}).success);
  const CalibrationState moved = both.state();
  const CycleReport report = both.run({Cycle::kRefine});
  EXPECT_FALSE(report.success);
  EXPECT_TRUE(report.contradicted);
  EXPECT_NE(report.message.find("contradict the motion"), std::string::npos) << report.message;
  EXPECT_EQ(both.state().belief.x, moved.belief.x);
  EXPECT_EQ(both.state().belief.covariance, moved.belief.covariance);
}

}  // namespace
}  // namespace sac
