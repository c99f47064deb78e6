#include "motion_terms.hpp"

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
  for (const OrientationTerm& term : terms.orientations()) {
    if (tracker.evaluate(terms.spans()[term.span], term.index)) {
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

}  // namespace
}  // namespace sac
