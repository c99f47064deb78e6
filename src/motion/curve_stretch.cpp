#include "curve_stretch.hpp"

#include <cmath>

#include "current_readings.hpp"
#include "spherical_actuator_calibration/motion/test_functions.hpp"

namespace sac {
namespace {

/// ∂τ/∂s of all pairs that are near, stator frame [N·m]: −ψ f'(ψ) in place of f(ψ), with f = h sin
/// ψ and so f' = h cos ψ − sin²ψ dh/dκ.
Eigen::Vector3d torqueByStretch(const MotionPoint& point,
                                const StatorTorque& torque,
                                const Eigen::VectorXd& current) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (std::size_t n = 0; n < torque.near; ++n) {
    const NearPair& pair = torque.pairs[n];
    const double sine = pair.cross.norm();
    const double cosine = torque.cosines(pair.coil, pair.pole);
    const double slope = pair.curve.h * cosine - sine * sine * pair.curve.dh;
    const double angle_over_sine = sine > 1e-9 ? std::atan2(sine, cosine) / sine : 1.0;
    sum -= (current[pair.coil] * point.strength(pair) * angle_over_sine * slope) * pair.cross;
  }
  return sum;
}

}  // namespace

Eigen::VectorXd balanceByStretch(const MotionSpan& span,
                                 const MotionWindow& window,
                                 const MotionPoint& point,
                                 int functions,
                                 std::size_t stride) {
  const TestFunctions tests(span.track.time(window.first), span.track.time(window.last), functions);
  Eigen::VectorXd result = Eigen::VectorXd::Zero(Eigen::Index{3} * functions);
  TestFunctionValues test;
  TurnedRotor turned;
  StatorTorque torque;
  visitCurrents(span, window, point.currentDelay(), stride, {}, [&](const CurrentReading& now) {
    const Eigen::VectorXd current =
        span.streams->currents.row(static_cast<Eigen::Index>(now.row)).transpose().cast<double>();
    point.turn(now.track.position, turned);
    point.torque(turned.R_stator_rotor, current, torque);
    tests.evaluate(now.time, test);
    const Eigen::Vector3d impulse = now.step() * torqueByStretch(point, torque, current);
    for (Eigen::Index k = 0; k < functions; ++k) {
      result.segment<3>(3 * k) -= test.value[k] * impulse;
    }
  });
  return result;
}

}  // namespace sac
