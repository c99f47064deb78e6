#include "motion_terms.hpp"

#include <algorithm>
#include <memory>
#include <numeric>

#include <gtest/gtest.h>

#include "spherical_actuator_calibration/estimation/calibration_state.hpp"
#include "support/moving_rotor.hpp"

namespace sac {
namespace {

/// All that can be modelled where there is a tracker.
EffectSelection manyEffects() {
  EffectSelection selection;
  for (const char* const name : {"encoder_harmonics",
                                 "tilt_cross_axis",
                                 "tracker_registration",
                                 "marker_registration",
                                 "pole_gains",
                                 "coil_gains",
                                 "torque_curve"}) {
    selection[name] = true;
  }
  return withMotionEffects(selection);
}

TEST(MotionTerms, OrientationsTellOfEveryCoordinateThatMovesThem) {
  constexpr double kNoScale = 1e12;
  const CalibrationModel model(ParameterSpace(scenarios::paperNominal(), manyEffects()));
  MovingRotor moving;
  moving.duration = 1.5;
  const MotionRecording recording = moving.record();
  MotionProblem problem;
  problem.model = &model;
  problem.recording = &recording;
  problem.prior = nominalState(model.space(), {}).belief;
  problem.free.resize(static_cast<std::size_t>(model.space().size()));
  std::iota(problem.free.begin(), problem.free.end(), 0);
  const Eigen::VectorXd x = Eigen::VectorXd::Constant(model.space().size(), 2e-3);
  const MotionOptions options;
  MotionTerms terms(problem, options);
  terms.setScales(kNoScale, kNoScale);
  terms.linearize(x, {});

  InformationSum expected(x.size());
  TrackerTerm tracker(model, terms.places(), x);
  const double whitening = 1.0 / terms.noise().orientation;
  const MotionSpan& span = terms.spans().front();
  for (std::size_t n = 0; n < span.orientation_times.size(); ++n) {
    if (tracker.evaluate(span, n)) {
      const Eigen::MatrixXd jacobian = whitening * tracker.jacobian();
      expected.addDense(jacobian, whitening * tracker.residual());
    }
  }
  const Eigen::MatrixXd all = expected.information();
  const InformationSum told = terms.orientation(x);
  EXPECT_GT(all.norm(), 0.0);
  EXPECT_LT((told.information() - all).norm(), 1e-12 * all.norm());
  EXPECT_LT((told.gradient() - expected.gradient()).norm(), 1e-12 * expected.gradient().norm());
}

/// Terms of a recording with more windows than those of which derivatives are kept, and with all of
/// them kept.
class ManyWindows : public ::testing::Test {
 protected:
  ManyWindows()
      : model_(ParameterSpace(scenarios::paperNominal(), withMotionEffects({}))),
        recording_(noisy(recorded())) {
    options_.window = 0.05;
    problem_.model = &model_;
    problem_.recording = &recording_;
    problem_.prior = nominalState(model_.space(), {}).belief;
    // Currents of MovingRotor act half a millisecond later than they say.
    const MotionPlaces places(model_.space());
    problem_.prior.x[places.current_delay] =
        -5e-4 / model_.space().effects().scale(places.current_delay - model_.space().effect());
    few_ = options_;
    few_.most_kept_windows = 100;
    near_ = problem_.prior.x + Eigen::VectorXd::Constant(problem_.prior.x.size(), 1e-6);
    TermOrder order;
    order.balance.covariance = true;
    for (MotionTerms* terms : {&allTerms(), &fewTerms()}) {
      terms->setScales(1.0, 1.0);
      terms->linearize(problem_.prior.x, order);
      terms->balance(problem_.prior.x);
    }
  }

  static MotionRecording recorded() {
    MovingRotor moving;
    moving.duration = 10.0;
    return moving.record();
  }

  MotionTerms& allTerms() {
    if (!all_) {
      all_ = std::make_unique<MotionTerms>(problem_, options_);
    }
    return *all_;
  }
  MotionTerms& fewTerms() {
    if (!few_kept_) {
      few_kept_ = std::make_unique<MotionTerms>(problem_, few_);
    }
    return *few_kept_;
  }

  void expectTheSame() {
    std::size_t values = 0;
    std::size_t few_values = 0;
    const InformationSum all_held = allTerms().heldOut(near_, values);
    const InformationSum few_held = fewTerms().heldOut(near_, few_values);
    EXPECT_EQ(values, few_values);
    expectNear(all_held, few_held);
    expectNear(allTerms().balance(near_), fewTerms().balance(near_));
    expectTheSameNoise();
  }

  /// Where they are linearised: what is not kept tells of it there alone.
  void expectTheSameNoise() {
    allTerms().balance(problem_.prior.x);
    fewTerms().balance(problem_.prior.x);
    const std::vector<NoiseEvidence> all = allTerms().noiseEvidence();
    const std::vector<NoiseEvidence> few = fewTerms().noiseEvidence();
    ASSERT_EQ(all.size(), few.size());
    const NoiseFactors chance{0.02, 0.01};
    const NoiseFactors of_all = likelyFactors(all, chance, 1.0);
    const NoiseFactors of_few = likelyFactors(few, chance, 1.0);
    EXPECT_NEAR(of_few.joints, of_all.joints, 1e-9);
    EXPECT_NEAR(of_few.currents, of_all.currents, 1e-9);
  }

  static void expectNear(const InformationSum& expected, const InformationSum& found) {
    const Eigen::MatrixXd information = expected.information();
    EXPECT_LE((found.information() - information).norm(), 1e-9 * information.norm());
    EXPECT_LE((found.gradient() - expected.gradient()).norm(), 1e-7 * expected.gradient().norm());
    EXPECT_NEAR(found.squaredMisfit(), expected.squaredMisfit(), 1e-7 * expected.squaredMisfit());
  }

  CalibrationModel model_;
  MotionRecording recording_;
  MotionOptions options_;
  MotionOptions few_;
  MotionProblem problem_;
  Eigen::VectorXd near_;
  std::unique_ptr<MotionTerms> all_;
  std::unique_ptr<MotionTerms> few_kept_;
};

TEST_F(ManyWindows, KeepDerivativesOfAFew) {
  const auto kept = [](const MotionTerms& terms) {
    return std::count_if(terms.windows().begin(), terms.windows().end(), [](const WindowTerm& one) {
      return one.balance.jacobian.size() > 0;
    });
  };
  ASSERT_GT(allTerms().windowCount(), 180U);
  EXPECT_EQ(kept(allTerms()), static_cast<std::ptrdiff_t>(allTerms().windowCount()));
  EXPECT_LE(kept(fewTerms()), 80);
  expectTheSame();
}

TEST_F(ManyWindows, TellTheSameWithOtherNoise) {
  for (MotionTerms* terms : {&allTerms(), &fewTerms()}) {
    terms->setNoiseFactors(0.5, 0.3);
  }
  expectTheSame();
}

TEST_F(ManyWindows, TellTheSameWithoutThoseThatAreRejected) {
  for (const bool is_active : {false, true}) {
    for (MotionTerms* terms : {&allTerms(), &fewTerms()}) {
      for (const std::size_t n : {6U, 7U, 15U, 21U, 31U, 44U}) {
        terms->windows()[n].active = is_active;
      }
    }
    expectTheSame();
  }
}

TEST_F(ManyWindows, TellTheSameWithWhatWasHeldOut) {
  for (MotionTerms* terms : {&allTerms(), &fewTerms()}) {
    terms->admitHeldOut();
  }
  expectTheSame();
}

// A weight that is not one is of a window that is kept, also where the scale has become smaller.
TEST_F(ManyWindows, TellTheSameByAnotherScale) {
  for (MotionTerms* terms : {&allTerms(), &fewTerms()}) {
    terms->setScales(0.3, 1.0);
  }
  expectTheSame();
}

TEST_F(ManyWindows, OrientationsThatAreRejectedServeNoMore) {
  MotionTerms& terms = allTerms();
  const InformationSum before = terms.orientation(near_);
  OrientationTerm& rejected = terms.orientations().terms()[700];
  ASSERT_TRUE(rejected.is_known);
  rejected.active = false;
  const InformationSum without = terms.orientation(near_);
  EXPECT_GT((before.information() - without.information()).norm(), 0.0);
  rejected.active = true;
  expectNear(before, terms.orientation(near_));
  // What is beyond the scale counts less.
  terms.setScales(1.0, 1e-3);
  EXPECT_LT(terms.orientation(near_).information(0, 0), 0.5 * before.information(0, 0));
}

}  // namespace
}  // namespace sac
