#include "weighted_observations.hpp"

#include <algorithm>

#include "spherical_actuator_calibration/estimation/whitened_observation.hpp"

namespace sac {

WeightedObservations::WeightedObservations(const EstimationProblem& problem,
                                           const EstimationOptions& options)
    : evaluator_(problem, options),
      whitening_(problem.observations.size(), Eigen::Matrix3d::Zero()),
      active_(problem.observations.size(), true) {}

bool WeightedObservations::updateWeights(const Eigen::VectorXd& x, const std::vector<bool>& held) {
  constexpr double kNoticeable = 1e-6;
  bool changed = false;
  LinearizedObservation linear;
  for (std::size_t n = 0; n < whitening_.size(); ++n) {
    evaluator_.linearize(n, x, linear);
    const Eigen::Matrix3d whitening = whiteningOf(evaluator_.covariance(n, linear, held));
    changed = changed || !whitening.isApprox(whitening_[n], kNoticeable);
    whitening_[n] = whitening;
  }
  return changed;
}

std::size_t WeightedObservations::activeCount() const {
  return static_cast<std::size_t>(std::count(active_.begin(), active_.end(), true));
}

void WeightedObservations::activateAll() {
  std::fill(active_.begin(), active_.end(), true);
}

bool WeightedObservations::setActive(std::size_t observation, bool active) {
  const bool changes = active_[observation] != active;
  active_[observation] = active;
  return changes;
}

std::vector<double> WeightedObservations::squares(const Eigen::VectorXd& x) const {
  std::vector<double> squares(whitening_.size());
  for (std::size_t n = 0; n < squares.size(); ++n) {
    squares[n] = (whitening_[n] * evaluator_.residual(n, x)).squaredNorm();
  }
  return squares;
}

Eigen::MatrixXd WeightedObservations::information(
    const Eigen::VectorXd& x, const std::vector<Eigen::Index>& coordinates) const {
  const ChosenCoordinates chosen(x.size(), coordinates);
  InformationSum sum(chosen.size());
  LinearizedObservation linear;
  WhitenedObservation whitened;
  for (std::size_t n = 0; n < whitening_.size(); ++n) {
    if (active_[n]) {
      evaluator_.linearize(n, x, linear);
      whiten(linear, whitening_[n], chosen, whitened);
      sum.add(whitened);
    }
  }
  return sum.information();
}

}  // namespace sac
