#include "identified_stddevs.hpp"

#include <cmath>
#include <limits>
#include <random>
#include <string>
#include <vector>

#include <Eigen/Cholesky>

#include <gtest/gtest.h>

#include "spherical_actuator_calibration/actuator/torque_curve.hpp"
#include "spherical_actuator_calibration/base/pi.hpp"
#include "support/scenarios.hpp"

namespace sac {
namespace {

ParameterSpace spaceWith(const std::vector<std::string>& effects) {
  EffectSelection selection;
  for (const std::string& effect : effects) {
    selection[effect] = true;
  }
  return ParameterSpace(scenarios::paperNominal(), selection);
}

void identify(CalibrationState& state, Eigen::Index p, double stddev) {
  state.identified[static_cast<std::size_t>(p)] = true;
  state.belief.covariance(p, p) = stddev * stddev;
}

TEST(IdentifiedStddevs, OfWhatIsNotIdentifiedThereIsNone) {
  const ParameterSpace space = spaceWith({});
  const ParameterStddevs stddevs = identifiedStddevs(space, nominalState(space, {}));
  ASSERT_EQ(stddevs.poles.size(), 8U);
  ASSERT_EQ(stddevs.coils.size(), 24U);
  EXPECT_FALSE(stddevs.joints[0].offset);
  EXPECT_FALSE(stddevs.poles[3].polar);
  EXPECT_FALSE(stddevs.coils[23].azimuth);
  EXPECT_FALSE(stddevs.coils[23].gain);
}

TEST(IdentifiedStddevs, StandAtTheirValues) {
  const ParameterSpace space = spaceWith({});
  CalibrationState state = nominalState(space, {});
  identify(state, space.joint(1) + 2, 1e-4);
  identify(state, space.pole(2), 2e-4);
  identify(state, space.coil(5) + 1, 3e-4);
  const ParameterStddevs stddevs = identifiedStddevs(space, state);
  EXPECT_NEAR(stddevs.joints[1].axis_v.value_or(0.0), 1e-4, 1e-12);
  EXPECT_FALSE(stddevs.joints[1].axis_u);
  EXPECT_NEAR(stddevs.poles[2].polar.value_or(0.0), 2e-4, 1e-9);
  EXPECT_FALSE(stddevs.poles[2].azimuth);
  // The second coordinate of an axis is cos(polar) times its azimuth.
  EXPECT_NEAR(stddevs.coils[5].azimuth.value_or(0.0),
              3e-4 / std::cos(space.nominal().coils[5].polar),
              1e-9);
}

TEST(IdentifiedStddevs, TheWorstIsOfTheGeometryAndDefined) {
  const ParameterSpace space = spaceWith({"torque_bias"});
  CalibrationState state = nominalState(space, {});
  for (Eigen::Index p = 0; p < space.effect(); ++p) {
    EXPECT_EQ(worstStddev(space, state), std::numeric_limits<double>::infinity());
    identify(state, p, 1e-4);
  }
  identify(state, space.joint(2), 3e-4);
  EXPECT_NEAR(worstStddev(space, state), 3e-4, 1e-9);
  // On the polar axis an azimuth is anything.
  identify(state, space.coil(3), 2e-4);
  state.belief.x[space.coil(3)] = std::acos(0.0) - space.nominal().coils[3].polar;
  EXPECT_NEAR(worstStddev(space, state), 3e-4, 1e-9);
}

TEST(IdentifiedStddevs, TellOfTheUnbalance) {
  const ParameterSpace space = spaceWith({"rotor_unbalance"});
  CalibrationState state = nominalState(space, {});
  EXPECT_FALSE(identifiedStddevs(space, state).unbalance);
  const Eigen::Index first = space.effect() + space.effects().first("rotor_unbalance");
  for (Eigen::Index k = 0; k < 3; ++k) {
    EXPECT_FALSE(identifiedStddevs(space, state).unbalance) << "not all of it";
    identify(state, first + k, 1e-3 * static_cast<double>(k + 1));
  }
  const Eigen::VectorXd stddevs = space.reportedStddevs(state.belief.x, state.belief.covariance);
  const auto unbalance = identifiedStddevs(space, state).unbalance;
  ASSERT_TRUE(unbalance);
  EXPECT_TRUE(unbalance->isApprox(stddevs.segment<3>(first), 1e-9));
}

TEST(IdentifiedStddevs, TellOfTheTorqueCurveAtAnyAngle) {
  const ParameterSpace space = spaceWith({"torque_curve"});
  CalibrationState state = nominalState(space, {});
  const Eigen::Index first = space.effect() + space.effects().first("torque_curve");
  const Eigen::Index shapes = space.size() - first;
  for (Eigen::Index n = 0; n < shapes; ++n) {
    EXPECT_FALSE(identifiedStddevs(space, state).torque_curve) << "not all of it";
    identify(state, first + n, 1e-3 * static_cast<double>(n + 1));
  }
  state.belief.covariance(first, first + 2) = state.belief.covariance(first + 2, first) = 1e-6;
  const auto stddev = identifiedStddevs(space, state).torque_curve;
  ASSERT_TRUE(stddev);
  // By many curves drawn from the belief; angles in degrees, as the curve has them.
  const Eigen::MatrixXd L =
      state.belief.covariance.bottomRightCorner(shapes, shapes).llt().matrixL();
  const TorqueCurve mean(*space.nominal().torque_curve);
  std::vector<double> squares(stddev->angles.size(), 0.0);
  scenarios::Generator generator(7);
  std::normal_distribution<double> normal;
  constexpr int kDraws = 4000;
  for (int draw = 0; draw < kDraws; ++draw) {
    Eigen::VectorXd x = state.belief.x;
    x.tail(shapes) += L * Eigen::VectorXd::NullaryExpr(shapes, [&] { return normal(generator); });
    const TorqueCurve curve(*space.actuatorAt(x).torque_curve);
    for (std::size_t n = 0; n < squares.size(); ++n) {
      const double angle = stddev->angles[n] * kOneDegree;
      squares[n] += std::pow(curve.value(angle) - mean.value(angle), 2) / kDraws;
    }
  }
  EXPECT_NEAR(stddev->angles.back() * kOneDegree, mean.supportEnd(), 1e-12);
  for (std::size_t n = 0; n < squares.size(); ++n) {
    EXPECT_NEAR(std::sqrt(squares[n]), stddev->torques[n], 0.05 * stddev->torques[n] + 1e-12) << n;
  }
}

TEST(IdentifiedStddevs, AGainNeedsAllThatItIsMadeOf) {
  const ParameterSpace space = spaceWith({"strength_scale", "pole_gains", "coil_gains"});
  const EffectLayout& effects = space.effects();
  const Eigen::Index common = space.effect() + effects.first("strength_scale");
  const Eigen::Index pole = space.effect() + effects.first("pole_gains") + 3;
  const Eigen::Index coil = space.effect() + effects.first("coil_gains");
  CalibrationState state = nominalState(space, {});
  identify(state, pole, 3e-3);
  EXPECT_FALSE(identifiedStddevs(space, state).poles[4].gain);
  identify(state, common, 4e-3);
  identify(state, coil, 1e-3);
  state.belief.x[common] = 0.1;
  const ParameterStddevs stddevs = identifiedStddevs(space, state);
  EXPECT_NEAR(stddevs.poles[4].gain.value_or(0.0), std::hypot(1.1 * 3e-3, 4e-3), 1e-12);
  EXPECT_FALSE(stddevs.poles[3].gain);
  // Beside the scale pole 1 and coil 1 are the references of strength. Of pole 1 the scale is told.
  EXPECT_NEAR(stddevs.poles[0].gain.value_or(0.0), 4e-3, 1e-12);
  EXPECT_FALSE(stddevs.coils[0].gain);
  EXPECT_NEAR(stddevs.coils[1].gain.value_or(0.0), 1e-3, 1e-12);
}

}  // namespace
}  // namespace sac
