#pragma once

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include "posterior_fit.hpp"
#include "spherical_actuator_calibration/calibration/calibration_config.hpp"
#include "spherical_actuator_calibration/estimation/parameter_space.hpp"
#include "wiring_case.hpp"

namespace sac {

/// Strengths of the few poles and coils that stand out where all strengths are free: angles that
/// took up a wrong strength hide it from a screen at the nominal description. Nothing where the
/// torques of each pole and coil fit. `base`: the fit of the torques as described.
std::vector<ScreenedCandidate> screenStrengths(const WiringCase& described,
                                               const PosteriorFit& base,
                                               const CalibrationConfig& config);

/// Index and strength of poles or coils, those first that are known best to differ from 1.
/// `effect`: pole_gains or coil_gains, which `fit` has modelled.
std::vector<std::pair<std::size_t, double>> outstandingStrengths(const ParameterSpace& space,
                                                                 const std::string& effect,
                                                                 const Eigen::VectorXd& x,
                                                                 const Eigen::MatrixXd& covariance);

}  // namespace sac
