#include "robust_mean.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "spherical_actuator_calibration/base/median.hpp"

namespace sac {
namespace {

/// Makes the median absolute deviation of a normal distribution its standard deviation.
constexpr double kMadToStddev = 1.4826;
/// The same for the mean absolute deviation: √(π/2).
constexpr double kMeanDeviationToStddev = 1.2533;

double meanOf(const double* begin, const double* end) {
  return std::accumulate(begin, end, 0.0) / static_cast<double>(end - begin);
}

double squaredDeviations(const double* begin, const double* end, double mean) {
  double sum = 0.0;
  for (const double* value = begin; value != end; ++value) {
    sum += (*value - mean) * (*value - mean);
  }
  return sum;
}

/// Lag-1 autocorrelation, zero where it is not significant.
double neighbourCorrelation(const std::vector<double>& series, double mean, double squares) {
  double products = 0.0;
  for (std::size_t i = 1; i < series.size(); ++i) {
    products += (series[i - 1] - mean) * (series[i] - mean);
  }
  const double rho = squares > 0.0 ? products / squares : 0.0;
  return rho > 2.0 / std::sqrt(static_cast<double>(series.size())) ? rho : 0.0;
}

void estimateDrift(const std::vector<double>& series,
                   Eigen::Index component,
                   MeanEstimate& result) {
  const std::size_t count = series.size();
  if (count < 6) {
    return;
  }
  std::array<double, 3> means{};
  double squares = 0.0;
  for (std::size_t third = 0; third < means.size(); ++third) {
    const double* begin = series.data() + third * count / 3;
    const double* end = series.data() + (third + 1) * count / 3;
    means[third] = meanOf(begin, end);
    squares += squaredDeviations(begin, end, means[third]);
  }
  const auto [smallest, largest] = std::minmax_element(means.begin(), means.end());
  result.drift[component] = *largest - *smallest;
  const auto n = static_cast<double>(count);
  result.drift_stddev[component] = std::sqrt(squares / (n - 3.0) * 6.0 / n);
}

void estimateComponent(const std::vector<double>& series,
                       Eigen::Index component,
                       MeanEstimate& result) {
  const auto count = static_cast<double>(series.size());
  const double mean = meanOf(series.data(), series.data() + series.size());
  const double squares = squaredDeviations(series.data(), series.data() + series.size(), mean);
  result.mean[component] = mean;
  result.single_variance[component] = squares / std::max(count - 1.0, 1.0);
  const double rho = neighbourCorrelation(series, mean, squares);
  result.slow_variance[component] = result.single_variance[component] * rho;
  // Correlation raises the variance of the mean, but never beyond that of a single measurement.
  result.variance[component] =
      result.single_variance[component] / count * std::min((1.0 + rho) / (1.0 - rho), count);
  estimateDrift(series, component, result);
}

}  // namespace

void RobustMean::reserve(std::size_t count) {
  for (std::vector<double>& series : series_) {
    series.reserve(count);
  }
}

void RobustMean::add(const Eigen::Vector3d& value) {
  for (std::size_t k = 0; k < series_.size(); ++k) {
    series_[k].push_back(value[static_cast<Eigen::Index>(k)]);
  }
}

MeanEstimate RobustMean::estimate() {
  is_glitch_.assign(count(), 0);
  for (const std::vector<double>& series : series_) {
    markGlitches(series);
  }
  MeanEstimate result;
  result.glitches = removeGlitches();
  result.count = count();
  for (std::size_t k = 0; k < series_.size(); ++k) {
    estimateComponent(series_[k], static_cast<Eigen::Index>(k), result);
  }
  return result;
}

void RobustMean::markGlitches(const std::vector<double>& series) {
  scratch_ = series;
  const double median = medianOf(scratch_);
  for (double& value : scratch_) {
    value = std::abs(value - median);
  }
  double scale = kMadToStddev * medianOf(scratch_);
  if (scale == 0.0) {
    // More than half of the measurements are equal: a quantised sensor. The mean deviation keeps
    // the next quantum from looking like a glitch.
    scale = kMeanDeviationToStddev * meanOf(scratch_.data(), scratch_.data() + scratch_.size());
  }
  const double limit = options_.outlier_factor * std::max(scale, options_.smallest_scale);
  for (std::size_t i = 0; i < series.size(); ++i) {
    if (std::abs(series[i] - median) > limit) {
      is_glitch_[i] = 1;
    }
  }
}

std::size_t RobustMean::removeGlitches() {
  const auto glitches =
      static_cast<std::size_t>(std::count(is_glitch_.begin(), is_glitch_.end(), char{1}));
  if (glitches == 0) {
    return 0;
  }
  for (std::vector<double>& series : series_) {
    std::size_t kept = 0;
    for (std::size_t i = 0; i < series.size(); ++i) {
      if (is_glitch_[i] == 0) {
        series[kept++] = series[i];
      }
    }
    series.resize(kept);
  }
  return glitches;
}

}  // namespace sac
