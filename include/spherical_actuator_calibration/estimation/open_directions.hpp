#pragma once

#include <string>
#include <vector>

#include <Eigen/Core>

#include "spherical_actuator_calibration/estimation/estimation_problem.hpp"
#include "spherical_actuator_calibration/estimation/parameter_space.hpp"

namespace sac {

/// A direction across many coordinates that the data of a cycle left open: it stays at the prior.
struct OpenDirection {
  std::string name;           ///< in words: "a common rotation of joints and coils about stator x"
  double stddev = 0.0;        ///< of the component along it, from the prior [rad]
  Eigen::VectorXd direction;  ///< P, unit norm
};

/// P×3: change of the coordinates at x, to first order, when the stator with its joint axes and
/// coils is turned by 1 rad about its x, y and z axis. No torque in the rotor frame changes then;
/// an orientation does (doc/method.md, Gauge). The joint's product of exponentials takes the
/// rotation up in axes and offsets, so that R(q) becomes e^{ξ̂} R(q) at every q.
Eigen::MatrixXd statorRotations(const ParameterSpace& space, const Eigen::VectorXd& x);

/// Names an orthonormal basis (P×d) of open directions: as rotations of the stator where it is made
/// of those, else by the coordinates that they move most. `belief` is that after the cycle.
std::vector<OpenDirection> nameOpenDirections(const ParameterSpace& space,
                                              const Eigen::MatrixXd& basis,
                                              const ParameterBelief& belief);

}  // namespace sac
