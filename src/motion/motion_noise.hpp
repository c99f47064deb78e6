#pragma once

#include <cstddef>
#include <vector>

#include <Eigen/Core>

#include "motion_span.hpp"
#include "noise_factors.hpp"
#include "spherical_actuator_calibration/estimation/calibration_model.hpp"

namespace sac {

/// Noise of the streams by differences of neighbours, robust against steps and outliers. What moves
/// faster than the streams see counts as noise: these are upper bounds.
struct MotionNoise {
  Eigen::Vector3d joint = Eigen::Vector3d::Zero();  ///< standard deviation [rad]
  double current = 0.0;                             ///< [A]
  double orientation = 0.0;                         ///< per component [rad]
  /// Standard deviations of the variances of readings and currents, over their value, by chance.
  NoiseFactors chance;
};

/// `x`: coordinates near enough that the tracker's misfit changes slowly.
MotionNoise noiseOf(const std::vector<MotionSpan>& spans,
                    const CalibrationModel& model,
                    const Eigen::VectorXd& x);

/// By how much the noise of readings may enlarge the variance of means of orientations over that of
/// their differences, at the most.
double meansOverDifferences(const MotionNoise& noise, const std::vector<MotionSpan>& spans);

/// That of the tracker alone, by so many orientations of each span [rad].
double trackerNoise(const std::vector<MotionSpan>& spans,
                    const CalibrationModel& model,
                    const Eigen::VectorXd& x,
                    std::size_t most);

}  // namespace sac
