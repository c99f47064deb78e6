#pragma once

#include <string>
#include <vector>

#include <Eigen/Core>

#include "spherical_actuator_calibration/calibration/cycle_request.hpp"
#include "spherical_actuator_calibration/estimation/calibration_model.hpp"
#include "spherical_actuator_calibration/estimation/estimation_problem.hpp"

namespace sac {

/// What to measure so that coordinates which a cycle left open become observable, one sentence per
/// joint, pole or coil: "Pole 5 is seen by no sample: excite coil 1 with joint_3 near 2.40 rad."
/// `x` are the coordinates in force; of the options what counts as excited, and as moved.
std::vector<std::string> adviceForUnobservable(const CalibrationModel& model,
                                               const std::vector<Sample>& samples,
                                               const std::vector<Observation>& observations,
                                               const CycleRequest& request,
                                               const Eigen::VectorXd& x,
                                               const EstimationOptions& options,
                                               const std::vector<Eigen::Index>& unobservable);

/// Of an effect that is stated more coarsely than this limit [rad], be it about one axis alone, so
/// that a direction stays open whatever is measured; or empty.
std::string adviceForCoarse(const ParameterSpace& space, double unobservable_stddev);

}  // namespace sac
