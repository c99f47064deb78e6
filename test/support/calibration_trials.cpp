#include "support/calibration_trials.hpp"

#include <cmath>

namespace sac {

void TrialStatistics::add(const ParameterBelief& estimated,
                          const Eigen::VectorXd& truth,
                          const std::vector<Eigen::Index>& free,
                          const Eigen::MatrixXd& bound) {
  constexpr double kTwoSided95 = 1.959964;
  double squares = 0.0;
  for (const Eigen::Index p : free) {
    const double error = estimated.x[p] - truth[p];
    squares += error * error;
    covered_ += std::abs(error) <= kTwoSided95 * std::sqrt(estimated.covariance(p, p)) ? 1 : 0;
    ++parameters_;
  }
  const auto count = static_cast<double>(free.size());
  squared_error_ += squares / count;
  squared_bound_ += bound.trace() / count;
  rms_error_ += std::sqrt(squares / count);
  rms_bound_ += std::sqrt(bound.trace() / count);
}

double TrialStatistics::errorOverBound() const {
  return std::sqrt(squared_error_ / squared_bound_);
}

double TrialStatistics::meanErrorOverBound() const {
  return rms_error_ / rms_bound_;
}

double TrialStatistics::coverage() const {
  return static_cast<double>(covered_) / static_cast<double>(parameters_);
}

}  // namespace sac
