#include "observed_information.hpp"

#include <optional>
#include <utility>

#include <Eigen/LU>

#include "spherical_actuator_calibration/base/cholesky.hpp"
#include "spherical_actuator_calibration/estimation/whitened_observation.hpp"

namespace sac {
namespace {

/// Sums over observations; those that no uncertain held coordinate acts on weigh as much as their
/// sensors' noise says.
struct Sums {
  Sums(Eigen::Index all, Eigen::Index estimated)
      : by_noise(all),
        by_more(all),
        noise_of_more(estimated),
        noise_of_dwells(Eigen::MatrixXd::Zero(estimated, estimated)) {}

  InformationSum by_noise;
  InformationSum by_more;           ///< the other observations
  InformationSum noise_of_more;     ///< of those outside of dwells
  Eigen::MatrixXd noise_of_dwells;  ///< of those in dwells
  bool has_more = false;
};

class Collector {
 public:
  explicit Collector(const Solution& solution)
      : solution_(solution),
        observations_(*solution.observations),
        point_(observations_.evaluator().at(solution.x())),
        chosen_(solution.x().size(), solution.estimated),
        every_(ChosenCoordinates::all(solution.x().size())),
        held_(chosen_.others()) {}

  ObservedInformation run();

 private:
  void addObservation(std::size_t observation, Sums& sums);
  void addDwell(const std::vector<std::size_t>& dwell, DwellSum& sum, Sums& sums);
  Eigen::MatrixXd weighDwell(const std::vector<std::size_t>& dwell, const DwellSum& sum);

  const Solution& solution_;
  const WeightedObservations& observations_;
  ModelPoint point_;
  ChosenCoordinates chosen_;
  ChosenCoordinates every_;
  std::vector<bool> held_;
  std::map<std::size_t, Eigen::MatrixXd> weighed_;
  LinearizedObservation linear_;  ///< of the observation at hand
  WhitenedObservation whitened_;
};

ObservedInformation Collector::run() {
  const Eigen::Index size = solution_.x().size();
  Sums sums(size, chosen_.size());
  for (std::size_t n = 0; n < observations_.size(); ++n) {
    if (observations_.active()[n] && !observations_.shared().shares[n]) {
      addObservation(n, sums);
    }
  }
  DwellSum of_dwell(size);
  for (const std::vector<std::size_t>& dwell : observations_.shared().dwells) {
    addDwell(dwell, of_dwell, sums);
  }
  const std::vector<Eigen::Index>& estimated = solution_.estimated;
  const Eigen::MatrixXd by_noise = sums.by_noise.information();
  const Eigen::MatrixXd information = by_noise + sums.by_more.information();
  ObservedInformation result;
  result.is_noise_alone = !sums.has_more;
  result.data = information(estimated, estimated);
  if (sums.has_more) {
    result.noise =
        by_noise(estimated, estimated) + sums.noise_of_more.information() + sums.noise_of_dwells;
  }
  result.others = information(estimated, Eigen::all);
  result.others(Eigen::all, estimated).setZero();
  result.weighed = std::move(weighed_);
  return result;
}

void Collector::addObservation(std::size_t observation, Sums& sums) {
  const ObservationEvaluator& evaluator = observations_.evaluator();
  evaluator.linearize(observation, point_, linear_);
  const Eigen::Matrix3d W = observations_.whitening()[observation];
  whiten(linear_, W, every_, whitened_);
  if (evaluator.heldCovariance(linear_, held_).isZero(0.0)) {
    sums.by_noise.add(whitened_);
    return;
  }
  sums.has_more = true;
  sums.by_more.add(whitened_);
  // S⁻¹RS⁻¹ = WᵀLLᵀW with W R Wᵀ = LLᵀ.
  const Eigen::Matrix3d share = W * evaluator.noise(observation, linear_) * W.transpose();
  const Eigen::Matrix3d upper = Cholesky3(share).lower().transpose();
  whiten(linear_, upper * W, chosen_, whitened_);
  sums.noise_of_more.add(whitened_);
}

void Collector::addDwell(const std::vector<std::size_t>& dwell, DwellSum& sum, Sums& sums) {
  sum.begin();
  bool more_than_noise = false;
  for (const std::size_t n : dwell) {
    if (observations_.active()[n]) {
      observations_.evaluator().linearize(n, point_, linear_);
      whiten(linear_, observations_.whitening()[n], every_, whitened_);
      sum.add(whitened_, observations_.shared().loading[n]);
      more_than_noise =
          more_than_noise || !observations_.evaluator().heldCovariance(linear_, held_).isZero(0.0);
    }
  }
  sum.addTo(more_than_noise ? sums.by_more : sums.by_noise);
  if (more_than_noise) {
    sums.has_more = true;
    sums.noise_of_dwells += weighDwell(dwell, sum);
  }
}

/// With V the covariance of the stacked residuals of a dwell, Y = V⁻¹J has the rows Wᵀ(A − G M⁻¹C)
/// for A = W J, M = I + Σ GᵀG and C = Σ GᵀA, and the shared errors weigh in it as M⁻¹C. Keeps what
/// the residuals need of it; F×F: YᵀRY.
Eigen::MatrixXd Collector::weighDwell(const std::vector<std::size_t>& dwell, const DwellSum& sum) {
  const Eigen::MatrixXd all_shares = sum.elimination().covariance() * sum.crossed();
  const Eigen::MatrixXd shares = all_shares(Eigen::all, solution_.estimated);
  Eigen::MatrixXd information = shares.transpose() * shares;
  for (const std::size_t n : dwell) {
    if (!observations_.active()[n]) {
      continue;
    }
    const ObservationEvaluator& evaluator = observations_.evaluator();
    evaluator.linearize(n, point_, linear_);
    const Eigen::Matrix3d W = observations_.whitening()[n];
    const SharedLoading& G = observations_.shared().loading[n];
    const Eigen::Matrix3d own_noise = evaluator.ownNoise(n, linear_);
    Eigen::MatrixXd& weighed = weighed_[n];
    const Eigen::Matrix3Xd jacobian =
        std::as_const(linear_.jacobian)(Eigen::all, solution_.estimated);
    weighed = W.transpose() * (W * jacobian - G * shares);
    information += weighed.transpose() * own_noise * weighed;
    // Σ over the dwell of cov(e_n, e_m) Y_m.
    weighed = (own_noise * weighed + W.inverse() * G * shares).eval();
  }
  return information;
}

/// Where no held coordinate is uncertain, the sum that the estimation knows already; nothing
/// elsewhere.
std::optional<ObservedInformation> byNoiseAlone(const Solution& solution) {
  const Eigen::MatrixXd& prior = solution.problem->prior.covariance;
  const std::vector<bool> held =
      ChosenCoordinates(solution.x().size(), solution.estimated).others();
  for (Eigen::Index p = 0; p < prior.rows(); ++p) {
    if (held[static_cast<std::size_t>(p)] && prior(p, p) > 0.0) {
      return std::nullopt;
    }
  }
  const Eigen::MatrixXd information = solution.observations->sum(solution.x()).information();
  ObservedInformation result;
  result.data = information(solution.estimated, solution.estimated);
  result.others = information(solution.estimated, Eigen::all);
  result.others(Eigen::all, solution.estimated).setZero();
  return result;
}

}  // namespace

ObservedInformation observedInformation(const Solution& solution) {
  if (const std::optional<ObservedInformation> result = byNoiseAlone(solution)) {
    return *result;
  }
  return Collector(solution).run();
}

}  // namespace sac
