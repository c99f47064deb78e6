#include "weighted_observations.hpp"

#include <algorithm>

#include "spherical_actuator_calibration/base/cholesky.hpp"

namespace sac {

WeightedObservations::WeightedObservations(const EstimationProblem& problem,
                                           const EstimationOptions& options)
    : evaluator_(problem, options),
      shared_(groupByDwell(problem, options)),
      whitening_(problem.observations.size()),
      active_(problem.observations.size(), true) {}

template <typename Prepare>
InformationSum WeightedObservations::pass(const Eigen::VectorXd& x,
                                          Which which,
                                          const Prepare& prepare) const {
  const ModelPoint point = evaluator_.at(x);
  const ChosenCoordinates every = ChosenCoordinates::all(x.size());
  InformationSum sum(x.size());
  LinearizedObservation linear;
  WhitenedObservation whitened;
  last_.at = x;
  last_.sum.reset();
  last_.residuals.resize(whitening_.size());
  /// Returns whether it serves.
  const auto take = [&](std::size_t n) {
    evaluator_.linearize(n, point, linear);
    last_.residuals[n] = linear.residual;
    prepare(n, linear);
    const bool serves = which == Which::kAll || active_[n];
    if (serves) {
      whiten(linear, whitening_[n], every, whitened);
    }
    return serves;
  };
  for (std::size_t n = 0; n < whitening_.size(); ++n) {
    if (!shared_.shares[n] && take(n)) {
      sum.add(whitened);
    }
  }
  DwellSum dwell_sum(x.size());
  for (const std::vector<std::size_t>& dwell : shared_.dwells) {
    dwell_sum.begin();
    for (const std::size_t n : dwell) {
      if (take(n)) {
        dwell_sum.add(whitened, shared_.loading[n]);
      }
    }
    dwell_sum.addTo(sum);
  }
  return sum;
}

/// Returns whether the weight changed noticeably.
bool WeightedObservations::weigh(std::size_t observation,
                                 const LinearizedObservation& linear,
                                 const std::vector<bool>& held) {
  constexpr double kNoticeable = 1e-6;
  const bool shares = shared_.shares[observation];
  const Eigen::Matrix3d noise =
      shares ? evaluator_.ownNoise(observation, linear) : evaluator_.noise(observation, linear);
  const Eigen::Matrix3d before = whitening_[observation];
  const Eigen::Matrix3d W = whiteningOf(noise + evaluator_.heldCovariance(linear, held));
  whitening_[observation] = W;
  bool changed = !W.isApprox(before, kNoticeable);
  if (shares) {
    const SharedLoading loading = W * evaluator_.sharedErrors(observation, linear);
    changed = changed || !loading.isApprox(shared_.loading[observation], kNoticeable);
    shared_.loading[observation] = loading;
  }
  return changed;
}

bool WeightedObservations::updateWeights(const Eigen::VectorXd& x, const std::vector<bool>& held) {
  if (weighed_at_.size() > 0 && weighed_at_ == x && weighed_with_ == held) {
    return false;
  }
  weighed_at_ = x;
  weighed_with_ = held;
  bool changed = false;
  last_.sum = pass(x, Which::kActive, [&](std::size_t n, const LinearizedObservation& linear) {
    changed = weigh(n, linear, held) || changed;
  });
  return changed;
}

const InformationSum& WeightedObservations::sum(const Eigen::VectorXd& x) const {
  if (!last_.sum || last_.at != x) {
    last_.sum = pass(x, Which::kActive, [](std::size_t, const LinearizedObservation&) {});
  }
  return *last_.sum;
}

std::size_t WeightedObservations::activeCount() const {
  return static_cast<std::size_t>(std::count(active_.begin(), active_.end(), true));
}

void WeightedObservations::activateAll() {
  if (activeCount() < active_.size()) {
    last_.sum.reset();
    std::fill(active_.begin(), active_.end(), true);
  }
}

bool WeightedObservations::setActive(std::size_t observation, bool active) {
  const bool changes = active_[observation] != active;
  if (changes) {
    last_.sum.reset();
    active_[observation] = active;
  }
  return changes;
}

WeightedObservations::Residuals::Residuals(const WeightedObservations& observations,
                                           const Eigen::VectorXd& x)
    : observations_(observations) {
  const Eigen::VectorXd& last = observations.last_.at;
  if (last.size() == 0 || last != x) {
    point_.emplace(observations.evaluator_.at(x));
  }
}

Eigen::Vector3d WeightedObservations::Residuals::operator()(std::size_t observation) const {
  const WeightedObservations& all = observations_;
  return all.whitening_[observation] * (point_ ? all.evaluator_.residual(observation, *point_)
                                               : all.last_.residuals[observation]);
}

std::vector<double> WeightedObservations::squares(const Eigen::VectorXd& x, double limit) const {
  const Residuals whitened(*this, x);
  std::vector<double> squares(whitening_.size());
  for (std::size_t n = 0; n < squares.size(); ++n) {
    squares[n] = shared_.shares[n] ? 0.0 : whitened(n).squaredNorm();
  }
  for (const std::vector<std::size_t>& dwell : shared_.dwells) {
    squaresOfDwell(dwell, whitened, limit, squares);
  }
  return squares;
}

void WeightedObservations::squaresOfDwell(const std::vector<std::size_t>& dwell,
                                          const Residuals& whitened,
                                          double limit,
                                          std::vector<double>& squares) const {
  DwellElimination elimination;
  std::vector<Eigen::Vector3d> residuals;
  for (const std::size_t n : dwell) {
    residuals.push_back(whitened(n));
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
      squares[dwell[k]] = rest.dot(Cholesky3(covariance).solve(rest));
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
                                                  const Residuals& whitened) const {
  DwellElimination elimination;
  for (const std::size_t n : dwell) {
    if (active_[n]) {
      elimination.add(shared_.loading[n], whitened(n));
    }
  }
  return elimination;
}

double WeightedObservations::chiSquare(const Eigen::VectorXd& x) const {
  const Residuals whitened(*this, x);
  double sum = 0.0;
  for (std::size_t n = 0; n < whitening_.size(); ++n) {
    sum += active_[n] && !shared_.shares[n] ? whitened(n).squaredNorm() : 0.0;
  }
  for (const std::vector<std::size_t>& dwell : shared_.dwells) {
    sum += eliminated(dwell, whitened).squaredMisfit();
  }
  return sum;
}

std::vector<Eigen::Vector3d> WeightedObservations::residuals(const Eigen::VectorXd& x) const {
  const Residuals whitened(*this, x);
  std::vector<Eigen::Vector3d> residuals(whitening_.size());
  for (std::size_t n = 0; n < residuals.size(); ++n) {
    residuals[n] = whitened(n);
  }
  for (const std::vector<std::size_t>& dwell : shared_.dwells) {
    const SharedErrors errors = eliminated(dwell, whitened).errors();
    for (const std::size_t n : dwell) {
      residuals[n] -= shared_.loading[n] * errors;
    }
  }
  return residuals;
}

Eigen::MatrixXd WeightedObservations::information(const Eigen::VectorXd& x,
                                                  const std::vector<Eigen::Index>& coordinates,
                                                  Which which) const {
  const bool is_active = which == Which::kActive || activeCount() == active_.size();
  const Eigen::MatrixXd all =
      is_active ? sum(x).information()
                : pass(x, which, [](std::size_t, const LinearizedObservation&) {}).information();
  return all(coordinates, coordinates);
}

}  // namespace sac
