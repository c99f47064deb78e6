#include "weighted_observations.hpp"

#include <algorithm>

#include "spherical_actuator_calibration/estimation/whitened_observation.hpp"

namespace sac {

WeightedObservations::WeightedObservations(const EstimationProblem& problem,
                                           const EstimationOptions& options)
    : evaluator_(problem, options),
      shared_(groupByDwell(problem, options)),
      whitening_(problem.observations.size(), Eigen::Matrix3d::Zero()),
      active_(problem.observations.size(), true) {}

bool WeightedObservations::updateWeights(const Eigen::VectorXd& x, const std::vector<bool>& held) {
  constexpr double kNoticeable = 1e-6;
  if (weighed_at_.size() > 0 && weighed_at_ == x && weighed_with_ == held) {
    return false;
  }
  const ModelPoint point = evaluator_.at(x);
  weighed_at_ = x;
  weighed_with_ = held;
  bool changed = false;
  LinearizedObservation linear;
  for (std::size_t n = 0; n < whitening_.size(); ++n) {
    evaluator_.linearize(n, point, linear);
    const Eigen::Matrix3d noise =
        shared_.shares[n] ? evaluator_.ownNoise(n, linear) : evaluator_.noise(n, linear);
    const Eigen::Matrix3d whitening = whiteningOf(noise + evaluator_.heldCovariance(linear, held));
    if (shared_.shares[n]) {
      const SharedLoading loading = whitening * evaluator_.sharedErrors(n, linear);
      changed = changed || !loading.isApprox(shared_.loading[n], kNoticeable);
      shared_.loading[n] = loading;
    }
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

std::vector<double> WeightedObservations::squares(const Eigen::VectorXd& x, double limit) const {
  const ModelPoint point = evaluator_.at(x);
  std::vector<double> squares(whitening_.size());
  for (std::size_t n = 0; n < squares.size(); ++n) {
    squares[n] = shared_.shares[n] ? 0.0 : whitenedResidual(n, point).squaredNorm();
  }
  for (const std::vector<std::size_t>& dwell : shared_.dwells) {
    squaresOfDwell(dwell, point, limit, squares);
  }
  return squares;
}

void WeightedObservations::squaresOfDwell(const std::vector<std::size_t>& dwell,
                                          const ModelPoint& point,
                                          double limit,
                                          std::vector<double>& squares) const {
  DwellElimination elimination;
  std::vector<Eigen::Vector3d> residuals;
  for (const std::size_t n : dwell) {
    residuals.push_back(whitenedResidual(n, point));
    elimination.add(shared_.loading[n], residuals.back());
  }
  std::vector<bool> kept(dwell.size(), true);
  while (true) {
    std::size_t worst = dwell.size();
    for (std::size_t k = 0; k < dwell.size(); ++k) {
      const SharedLoading& G = shared_.loading[dwell[k]];
      DwellElimination others = elimination;
      if (kept[k]) {
        others.remove(G, residuals[k]);
      }
      const Eigen::Vector3d rest = residuals[k] - G * others.errors();
      const Eigen::Matrix3d covariance =
          Eigen::Matrix3d::Identity() + G * others.covariance() * G.transpose();
      squares[dwell[k]] = rest.dot(covariance.llt().solve(rest));
      if (kept[k] && (worst == dwell.size() || squares[dwell[k]] > squares[dwell[worst]])) {
        worst = k;
      }
    }
    if (worst == dwell.size() || squares[dwell[worst]] <= limit) {
      return;
    }
    kept[worst] = false;
    elimination.remove(shared_.loading[dwell[worst]], residuals[worst]);
  }
}

DwellElimination WeightedObservations::eliminated(const std::vector<std::size_t>& dwell,
                                                  const ModelPoint& point) const {
  DwellElimination elimination;
  for (const std::size_t n : dwell) {
    if (active_[n]) {
      elimination.add(shared_.loading[n], whitenedResidual(n, point));
    }
  }
  return elimination;
}

double WeightedObservations::chiSquare(const Eigen::VectorXd& x) const {
  const ModelPoint point = evaluator_.at(x);
  double sum = 0.0;
  for (std::size_t n = 0; n < whitening_.size(); ++n) {
    sum += active_[n] && !shared_.shares[n] ? whitenedResidual(n, point).squaredNorm() : 0.0;
  }
  for (const std::vector<std::size_t>& dwell : shared_.dwells) {
    sum += eliminated(dwell, point).squaredMisfit();
  }
  return sum;
}

std::vector<Eigen::Vector3d> WeightedObservations::residuals(const Eigen::VectorXd& x) const {
  const ModelPoint point = evaluator_.at(x);
  std::vector<Eigen::Vector3d> residuals(whitening_.size());
  for (std::size_t n = 0; n < residuals.size(); ++n) {
    residuals[n] = whitenedResidual(n, point);
  }
  for (const std::vector<std::size_t>& dwell : shared_.dwells) {
    const SharedErrors errors = eliminated(dwell, point).errors();
    for (const std::size_t n : dwell) {
      residuals[n] -= shared_.loading[n] * errors;
    }
  }
  return residuals;
}

Eigen::MatrixXd WeightedObservations::information(const Eigen::VectorXd& x,
                                                  const std::vector<Eigen::Index>& coordinates,
                                                  Which which) const {
  const ModelPoint point = evaluator_.at(x);
  const ChosenCoordinates chosen(x.size(), coordinates);
  InformationSum sum(chosen.size());
  LinearizedObservation linear;
  WhitenedObservation whitened;
  const auto serves = [&](std::size_t n) { return which == Which::kAll || active_[n]; };
  for (std::size_t n = 0; n < whitening_.size(); ++n) {
    if (serves(n) && !shared_.shares[n]) {
      evaluator_.linearize(n, point, linear);
      whiten(linear, whitening_[n], chosen, whitened);
      sum.add(whitened);
    }
  }
  DwellSum dwell_sum(chosen.size());
  for (const std::vector<std::size_t>& dwell : shared_.dwells) {
    dwell_sum.begin();
    for (const std::size_t n : dwell) {
      if (serves(n)) {
        evaluator_.linearize(n, point, linear);
        whiten(linear, whitening_[n], chosen, whitened);
        dwell_sum.add(whitened, shared_.loading[n]);
      }
    }
    dwell_sum.addTo(sum);
  }
  return sum.information();
}

}  // namespace sac
