#include "uncertainty_budget.hpp"

#include <algorithm>
#include <cstddef>
#include <iterator>
#include <map>

#include "estimated_part.hpp"
#include "spherical_actuator_calibration/assessment/reported_covariance.hpp"
#include "spherical_actuator_calibration/base/cholesky.hpp"
#include "spherical_actuator_calibration/estimation/information_factor.hpp"
#include "spherical_actuator_calibration/estimation/linearization.hpp"
#include "spherical_actuator_calibration/estimation/shared_errors.hpp"
#include "spherical_actuator_calibration/estimation/stated_knowledge.hpp"
#include "spherical_actuator_calibration/estimation/whitened_observation.hpp"

namespace sac {
namespace {

/// With V the covariance of the residuals of a dwell, δx = −N⁻¹ (Σ JᵀV⁻¹ e + what is known
/// beforehand): every source of e, and of that, adds a covariance of its own.
class Budget {
 public:
  Budget(const CalibrationSession& session, const CycleReport& report)
      : report_(report),
        options_(session.config().estimation),
        selection_(session.config().effects),
        space_(session.model().space()),
        belief_(session.state().belief),
        chosen_(estimatedCoordinates(space_, report)),
        coordinates_(space_.size(), chosen_),
        observed_(static_cast<Eigen::Index>(chosen_.size())) {
    problem_.model = &session.model();
    problem_.samples = &session.samples();
    problem_.observations = selectObservations(
        session.model().space(), session.samples(), {report.cycle, report.coil}, options_);
    problem_.prior = belief_;
    held_.assign(static_cast<std::size_t>(space_.size()), true);
    for (const Eigen::Index p : chosen_) {
      held_[static_cast<std::size_t>(p)] = false;
    }
    const auto size = static_cast<Eigen::Index>(chosen_.size());
    known_ = Eigen::MatrixXd::Zero(size, size);
    others_ = Eigen::MatrixXd::Zero(size, space_.size());
  }

  std::vector<BudgetEntry> entries() {
    if (chosen_.empty()) {
      return {};
    }
    sumObservations();
    sumKnowledge();
    return propagated();
  }

 private:
  struct Dwell {
    std::vector<Eigen::Index> columns;  ///< coordinates that an observation depends on, ascending
    Eigen::MatrixXd jacobian;           ///< rows of all observations, in these
    Eigen::MatrixXd loading;            ///< of joint readings and the torque without current
    Eigen::VectorXd variance;           ///< noise of each row's own
    Eigen::MatrixXd readings;  ///< of errors of readings that an observation has for itself
    Eigen::MatrixXd held;      ///< covariance that held coordinates add, block by block
    std::vector<bool> is_orientation;
  };

  /// What the reading of a sample is: of a rotor without joints the tracker's orientation.
  const char* reading() const { return space_.joints() > 0 ? "joint_reading" : "orientation"; }

  Eigen::MatrixXd& of(const std::string& source) {
    const auto size = static_cast<Eigen::Index>(chosen_.size());
    const auto found = std::find(sources_.begin(), sources_.end(), source);
    if (found == sources_.end()) {
      sources_.push_back(source);
      meat_[source] = Eigen::MatrixXd::Zero(size, size);
    }
    return meat_[source];
  }

  void sumObservations();
  Dwell dwellOf(const std::vector<std::size_t>& observations,
                const ObservationEvaluator& evaluator,
                const ModelPoint& point) const;
  void add(const Dwell& dwell);
  void sumKnowledge();
  std::vector<BudgetEntry> propagated();

  const CycleReport& report_;
  const EstimationOptions& options_;
  const EffectSelection& selection_;
  const ParameterSpace& space_;
  const ParameterBelief& belief_;
  std::vector<Eigen::Index> chosen_;
  ChosenCoordinates coordinates_;  ///< the same
  EstimationProblem problem_;
  std::vector<bool> held_;
  InformationSum observed_;
  Eigen::MatrixXd known_;   ///< information beside the observations
  Eigen::MatrixXd others_;  ///< Σ JᵀV⁻¹J_held
  std::vector<std::string> sources_;
  std::map<std::string, Eigen::MatrixXd> meat_;  ///< covariance of N δx by each source
};

void Budget::sumObservations() {
  const ObservationEvaluator evaluator(problem_, options_);
  const ModelPoint point = evaluator.at(belief_.x);
  const std::vector<std::size_t> kept = keptObservations(problem_, report_);
  const SharedErrorModel shared = groupByDwell(problem_, options_);
  const auto is_kept = [&](std::size_t n) {
    return std::binary_search(kept.begin(), kept.end(), n);
  };
  for (const std::size_t n : kept) {
    if (!shared.shares[n]) {
      add(dwellOf({n}, evaluator, point));
    }
  }
  for (const std::vector<std::size_t>& dwell : shared.dwells) {
    std::vector<std::size_t> serving;
    std::copy_if(dwell.begin(), dwell.end(), std::back_inserter(serving), is_kept);
    if (!serving.empty()) {
      add(dwellOf(serving, evaluator, point));
    }
  }
}

Budget::Dwell Budget::dwellOf(const std::vector<std::size_t>& observations,
                              const ObservationEvaluator& evaluator,
                              const ModelPoint& point) const {
  const auto rows = 3 * static_cast<Eigen::Index>(observations.size());
  Dwell dwell;
  dwell.loading.resize(rows, kSharedErrors);
  dwell.variance.resize(rows);
  dwell.readings.resize(rows, 3);
  dwell.held = Eigen::MatrixXd::Zero(rows, rows);
  std::vector<LinearizedObservation> linears(observations.size());
  for (std::size_t k = 0; k < observations.size(); ++k) {
    evaluator.linearize(observations[k], point, linears[k]);
    const std::vector<Eigen::Index>& own = linears[k].columns;
    dwell.columns.insert(dwell.columns.end(), own.begin(), own.end());
  }
  std::sort(dwell.columns.begin(), dwell.columns.end());
  dwell.columns.erase(std::unique(dwell.columns.begin(), dwell.columns.end()), dwell.columns.end());
  dwell.jacobian.resize(rows, static_cast<Eigen::Index>(dwell.columns.size()));
  for (std::size_t k = 0; k < observations.size(); ++k) {
    const std::size_t n = observations[k];
    const Eigen::Index row = 3 * static_cast<Eigen::Index>(k);
    const LinearizedObservation& linear = linears[k];
    dwell.jacobian.middleRows<3>(row) = linear.jacobian(Eigen::all, dwell.columns);
    dwell.loading.middleRows<3>(row) = evaluator.sharedErrors(n, linear);
    dwell.variance.segment<3>(row).setConstant(evaluator.ownVariance(n));
    dwell.readings.middleRows<3>(row) = evaluator.ownReadingErrors(n, linear);
    dwell.held.block<3, 3>(row, row) = evaluator.heldCovariance(linear, held_);
    dwell.is_orientation.push_back(problem_.observations[n].quantity == Quantity::kOrientation);
  }
  return dwell;
}

void Budget::add(const Dwell& dwell) {
  Eigen::MatrixXd covariance = dwell.held + dwell.loading * dwell.loading.transpose();
  covariance.diagonal() += dwell.variance;
  for (Eigen::Index row = 0; row < dwell.readings.rows(); row += 3) {
    const Eigen::Matrix3d own = dwell.readings.middleRows<3>(row);
    covariance.block<3, 3>(row, row) += own * own.transpose();
  }
  std::vector<Eigen::Index> own;     // among the columns of the dwell
  std::vector<Eigen::Index> places;  // of the same among the chosen coordinates
  for (std::size_t k = 0; k < dwell.columns.size(); ++k) {
    const Eigen::Index place = coordinates_.place(dwell.columns[k]);
    if (place >= 0) {
      own.push_back(static_cast<Eigen::Index>(k));
      places.push_back(place);
    }
  }
  const Eigen::MatrixXd J = dwell.jacobian(Eigen::all, own);
  const Cholesky factor(covariance);
  const Eigen::MatrixXd whitened = factor.half(J);
  InformationSum observed(J.cols());
  observed.addDense(whitened, Eigen::VectorXd::Zero(whitened.rows()));
  observed_.addAt(places, observed);
  const Eigen::MatrixXd weighed = factor.solve(J);  // V⁻¹J
  others_(places, dwell.columns) += weighed.transpose() * dwell.jacobian;
  const auto add_to = [&](const std::string& source, const Eigen::MatrixXd& rows) {
    of(source)(places, places) += rows.transpose() * rows;
  };
  for (std::size_t k = 0; k < dwell.is_orientation.size(); ++k) {
    const Eigen::Index row = 3 * static_cast<Eigen::Index>(k);
    add_to(dwell.is_orientation[k] ? "orientation" : "torque",
           dwell.variance.segment<3>(row).cwiseSqrt().asDiagonal() * weighed.middleRows<3>(row));
    add_to(reading(), dwell.readings.middleRows<3>(row).transpose() * weighed.middleRows<3>(row));
  }
  const Eigen::MatrixXd shares = dwell.loading.transpose() * weighed;
  add_to(reading(), shares.topRows<3>());
  add_to("torque_without_current", shares.bottomRows<3>());
}

/// What was stated of effects, what held open directions, and what held coordinates were known by.
void Budget::sumKnowledge() {
  const Eigen::MatrixXd stated = statedInformation(space_, chosen_);
  known_ += stated;
  for (Eigen::Index k = 0; k < stated.rows(); ++k) {
    const Eigen::Index effect = chosen_[static_cast<std::size_t>(k)] - space_.effect();
    if (stated(k, k) > 0.0) {
      // Coordinates of other statements are zero in this row.
      of(selection_.statementOf(space_.effects().at(effect).name)).row(k) += stated.row(k);
    }
  }
  const Eigen::MatrixXd open = priorInformation(report_.open_directions, belief_, chosen_);
  known_ += open;
  Eigen::MatrixXd covariance = belief_.covariance;
  for (const Eigen::Index p : chosen_) {
    covariance.row(p).setZero();
    covariance.col(p).setZero();
  }
  of("earlier_knowledge") += open + others_ * covariance * others_.transpose();
}

std::vector<BudgetEntry> Budget::propagated() {
  const Eigen::MatrixXd information = observed_.information() + known_;
  const Eigen::MatrixXd all = reportedJacobian(space_, belief_.x);
  const Eigen::MatrixXd chosen = all(Eigen::all, chosen_);
  const Eigen::MatrixXd reported = chosen * InformationFactor(information).inverse();
  std::vector<BudgetEntry> entries;
  for (const std::string& source : sources_) {
    // None is below zero but for rounding.
    const Eigen::VectorXd variance =
        (reported * meat_[source]).cwiseProduct(reported).rowwise().sum().cwiseMax(0.0);
    if (variance.maxCoeff() > 0.0) {
      entries.push_back({source, variance});
    }
  }
  return entries;
}

}  // namespace

std::vector<BudgetEntry> uncertaintyBudget(const CalibrationSession& session) {
  if (session.reports().empty() || !session.reports().back().success) {
    return {};
  }
  return Budget(session, session.reports().back()).entries();
}

Eigen::MatrixXd budgetShares(const std::vector<BudgetEntry>& budget) {
  Eigen::MatrixXd shares;
  for (const BudgetEntry& entry : budget) {
    shares.conservativeResize(entry.variance.size(), shares.cols() + 1);
    shares.rightCols<1>() = entry.variance;
  }
  for (Eigen::Index p = 0; p < shares.rows(); ++p) {
    const double sum = shares.row(p).sum();
    shares.row(p) *= sum > 0.0 ? 1.0 / sum : 0.0;
  }
  return shares;
}

}  // namespace sac
