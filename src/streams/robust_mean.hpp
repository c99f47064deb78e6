#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include <Eigen/Core>

namespace sac {

/// Mean of a quantity with three components, and how well it is known.
struct MeanEstimate {
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  Eigen::Vector3d variance = Eigen::Vector3d::Zero();         ///< of the mean, without any floor
  Eigen::Vector3d single_variance = Eigen::Vector3d::Zero();  ///< of one measurement
  /// Part of it that neighbours in the series share: the lag-1 autocovariance, where significant.
  Eigen::Vector3d slow_variance = Eigen::Vector3d::Zero();
  /// Largest difference between the means of the thirds of the series, per component.
  Eigen::Vector3d drift = Eigen::Vector3d::Zero();
  /// Standard deviation of such a difference if only white noise made it.
  Eigen::Vector3d drift_stddev = Eigen::Vector3d::Zero();
  std::size_t count = 0;     ///< measurements used
  std::size_t glitches = 0;  ///< measurements left out
};

/// Averages one series of measurements with three components, in whatever unit they have.
class RobustMean {
 public:
  struct Options {
    double outlier_factor = 6.0;  ///< × the robust standard deviation, from the median
    double smallest_scale = 0.0;  ///< the robust standard deviation is taken as at least this
  };

  explicit RobustMean(const Options& options) : options_(options) {}

  void reserve(std::size_t count);
  void add(const Eigen::Vector3d& value);
  std::size_t count() const { return series_[0].size(); }

  /// Mean of the series, of which at least one measurement must be there. A measurement with any
  /// component further from its median than `outlier_factor` times 1.4826 × the median absolute
  /// deviation is a glitch: it is taken out of the series. The variance of the mean is s²/n, times
  /// (1 + ρ)/(1 − ρ) where the lag-1 autocorrelation ρ is significant (ρ > 2/√n).
  MeanEstimate estimate();

 private:
  void markGlitches(const std::vector<double>& series);
  std::size_t removeGlitches();

  Options options_;
  std::array<std::vector<double>, 3> series_;
  std::vector<double> scratch_;
  std::vector<char> is_glitch_;
};

}  // namespace sac
