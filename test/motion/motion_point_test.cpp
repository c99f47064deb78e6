#include "motion_point.hpp"

#include <cmath>
#include <memory>

#include <gtest/gtest.h>

#include "spherical_actuator_calibration/actuator/orientation_map.hpp"
#include "spherical_actuator_calibration/base/rotations.hpp"
#include "support/numeric_jacobian.hpp"
#include "support/scenarios.hpp"

namespace sac {
namespace {

/// A description that a former calibration has corrected: readings and what the axes leave.
Actuator corrected() {
  Actuator actuator = scenarios::paperNominal();
  actuator.joints[0].correction.linear[1] = 2e-3;
  actuator.joints[2].correction.harmonics[0] = 5e-3;
  actuator.joints[2].correction.harmonics[3] = -3e-3;
  OrientationMapDescription map;
  map.length = {0.3, 0.5, 0.8};
  map.amplitude = {1e-3, 2e-3, 5e-4};
  map.noise = {1e-4, 3e-4, 2e-4};
  for (int n = 0; n < 12; ++n) {
    map.readings.emplace_back(0.1 * std::sin(n), 0.2 * std::cos(2.0 * n), 0.5 * n);
    map.rotations.emplace_back(1e-3 * std::cos(n), 2e-3 * std::sin(3.0 * n), 5e-4 * std::sin(n));
  }
  actuator.orientation_map = std::make_shared<OrientationMap>(map);
  return actuator;
}

Eigen::Vector3d someReading() {
  return {0.1, -0.15, 0.7};
}

TEST(MotionPoint, TurnsTheRotorAsTheDescriptionSays) {
  const Actuator nominal = corrected();
  const CalibrationModel model(ParameterSpace(nominal, withMotionEffects(EffectSelection())));
  const MotionPlaces places(model.space());
  const MotionPoint point(model, places, Eigen::VectorXd::Zero(model.space().size()));
  TurnedRotor turned;
  point.turn(someReading(), turned);
  const Eigen::Matrix3d expected = rotorOrientation(jointGeometry(nominal), someReading());
  EXPECT_LT((turned.R_stator_rotor - expected).norm(), 1e-14);
}

TEST(MotionPoint, TurnsWithItsCoordinates) {
  EffectSelection selection;
  selection["encoder_harmonics"] = true;
  selection["tilt_cross_axis"] = true;
  const CalibrationModel model(ParameterSpace(corrected(), withMotionEffects(selection)));
  const MotionPlaces places(model.space());
  const Eigen::VectorXd x = Eigen::VectorXd::Constant(model.space().size(), 0.01);
  const MotionPoint point(model, places, x);
  TurnedRotor turned;
  point.turn(someReading(), turned);
  const auto turn = [&](const Eigen::VectorXd& at) -> Eigen::VectorXd {
    TurnedRotor moved;
    MotionPoint(model, places, at).turn(someReading(), moved);
    return rotationLog(moved.R_stator_rotor * turned.R_stator_rotor.transpose());
  };
  const Eigen::MatrixXd numeric = numericJacobian(turn, x);
  for (std::size_t t = 0; t < point.turning().size(); ++t) {
    const Eigen::Index p = point.turning()[t];
    EXPECT_LT((turned.d_x.col(static_cast<Eigen::Index>(t)) - numeric.col(p)).norm(), 1e-9)
        << model.space().name(p);
  }
}

}  // namespace
}  // namespace sac
