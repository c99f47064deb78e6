#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "spherical_actuator_calibration/actuator/description_file.hpp"
#include "spherical_actuator_calibration/calibration/calibration_config.hpp"
#include "spherical_actuator_calibration/measurement/sample.hpp"

namespace sac {

/// How well one choice of laboratory effects explains the samples.
struct ModelFit {
  std::string effects;     ///< for people: "none", "all", "without torque_bias"
  bool converged = false;  ///< the refinement found a solution; else what follows is of the last
                           ///< point that it reached
  /// Effects of which the samples leave something open: that stays at zero, and its error is in the
  /// misfit, where the report of a refinement counts it as uncertainty.
  std::vector<std::string> not_told;
  std::size_t parameters = 0;  ///< estimated
  std::size_t values = 0;      ///< measured, three per observation
  double chi_square = 0.0;     ///< of all observations, outliers included
  double reduced_chi_square = 0.0;
  /// Bayesian information criterion χ² + k ln n, the smaller the better: a difference of ten is
  /// decisive.
  double bic = 0.0;
  /// Rotation error of orientations, root mean square, each region of the workspace (regionsOf())
  /// predicted from the samples of all others [rad]; nothing where no effect acts on orientations
  /// or there are few.
  std::optional<double> held_out;
};

/// Refines with none of the effects that the configuration models, with all, and with each one left
/// out. Empty when none is modelled. Throws as CalibrationSession.
std::vector<ModelFit> compareEffects(const CalibratedDescription& start,
                                     const std::vector<Sample>& samples,
                                     const CalibrationConfig& config);

/// The best fit of those that converged: by the regions that it predicts, or by the criterion where
/// not all have predicted some.
const ModelFit& bestOf(const std::vector<ModelFit>& fits);

/// One line per fit for people, the best one marked.
std::vector<std::string> describe(const std::vector<ModelFit>& fits);

}  // namespace sac
