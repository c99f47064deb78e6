#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include <Eigen/Core>

namespace spherical_actuator_calibration {

/// Mean of a vector quantity with three components, and how well it is known.
struct MeanEstimate {
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  Eigen::Vector3d variance = Eigen::Vector3d::Zero();         ///< of the mean, without any floor
  Eigen::Vector3d single_variance = Eigen::Vector3d::Zero();  ///< of one measurement
  /// Largest difference between the means of the three thirds of the series, per component.
  Eigen::Vector3d drift = Eigen::Vector3d::Zero();
  /// Standard error of such a difference if the series were stationary.
  Eigen::Vector3d drift_stddev = Eigen::Vector3d::Zero();
  std::size_t count = 0;     ///< measurements used
  std::size_t glitches = 0;  ///< measurements left out
};

/// Averages series of three components. Keeps its scratch memory between calls.
class RobustMean {
 public:
  struct Options {
    double outlier_factor = 6.0;  ///< × the robust standard deviation, from the median
    double smallest_scale = 0.0;  ///< the robust standard deviation is taken as at least this
  };

  explicit RobustMean(const Options& options) : options_(options) {}

  /// Starts a new series.
  void clear();
  void add(const Eigen::Vector3d& value);

  /// Mean of the series. A measurement with any component further from its median than
  /// `outlier_factor` times 1.4826 × the median absolute deviation is a glitch and left out. The
  /// variance is s²/n, corrected by (1 + ρ)/(1 − ρ) where the lag-1 autocorrelation ρ is
  /// significant (ρ > 2/√n). At least one measurement is needed.
  MeanEstimate estimate();

 private:
  std::size_t markGlitches();
  void markGlitches(const std::vector<double>& series);
  MeanEstimate average();

  Options options_;
  std::array<std::vector<double>, 3> series_;
  std::vector<double> scratch_;
  std::vector<bool> glitch_;
};

}  // namespace spherical_actuator_calibration
