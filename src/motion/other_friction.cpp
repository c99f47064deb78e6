#include "other_friction.hpp"

#include <algorithm>
#include <vector>

#include "spherical_actuator_calibration/base/rotations.hpp"
#include "spherical_actuator_calibration/motion/test_functions.hpp"

namespace sac {
Eigen::MatrixXd balanceByFrictions(const MotionWindow& window,
                                   const JointTrack& track,
                                   const MotionPoint& point,
                                   int functions) {
  const std::size_t reach = std::max<std::size_t>(1, track.rateReach());
  const std::size_t first = window.first;
  const std::size_t last = window.last;
  std::vector<Eigen::Matrix3d> turned;
  TurnedRotor rotor;
  for (std::size_t n = first; n <= last; ++n) {
    point.turn(track.reading(n), rotor);
    turned.push_back(rotor.R_stator_rotor);
  }
  const TestFunctions tests(track.time(first), track.time(last), functions);
  TestFunctionValues test;
  Eigen::MatrixXd result = Eigen::MatrixXd::Zero(Eigen::Index{3} * functions, kFrictionLaws);
  for (std::size_t n = first; n < last; ++n) {
    const std::size_t from = std::max(first, n - std::min(n, reach));
    const std::size_t to = std::min(last, n + 1 + reach);
    const double lasting = track.time(to) - track.time(from);
    const Eigen::Vector3d rate =
        rotationLog(turned[to - first] * turned[from - first].transpose()) / lasting;
    const Eigen::Vector3d turn = rate * (track.time(n + 1) - track.time(n));
    const Eigen::Vector3d axis = turned[n - first].col(2);
    tests.evaluate(0.5 * (track.time(n) + track.time(n + 1)), test);
    for (Eigen::Index k = 0; k < functions; ++k) {
      result.block<3, 1>(3 * k, 0) += test.value[k] * rate.norm() * turn;
      result.block<3, 1>(3 * k, 1) += test.value[k] * axis.dot(turn) * axis;
    }
  }
  return result;
}

}  // namespace sac
