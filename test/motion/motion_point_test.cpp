#include "motion_point.hpp"

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
  actuator.orientation_map = std::make_shared<OrientationMap>(scenarios::orientationMap());
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
