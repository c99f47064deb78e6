#include "spherical_actuator_calibration/assessment/sample_influence.hpp"

#include <algorithm>
#include <optional>
#include <vector>

#include "estimated_part.hpp"
#include "spherical_actuator_calibration/base/symmetric_matrix.hpp"
#include "spherical_actuator_calibration/estimation/information_factor.hpp"
#include "spherical_actuator_calibration/estimation/shared_errors.hpp"
#include "spherical_actuator_calibration/estimation/stated_knowledge.hpp"
#include "spherical_actuator_calibration/estimation/whitened_observation.hpp"

namespace sac {
namespace {

/// One observation in units of its noise, given the errors that its dwell shares: with J its
/// Jacobian, G what it feels of these errors u, and u = û + S δ their most likely values at x + δ,
/// it says residual r − G û and Jacobian J − G S. What u may differ by from that adds to its hat.
struct SeenObservation {
  std::size_t observation = 0;
  WhitenedObservation whitened;
  Eigen::Matrix3d hat_of_shared = Eigen::Matrix3d::Zero();
};

/// The observations that were used, at the solution. They are linearised whenever they are asked
/// for: all of them at once would take a kilobyte each.
class UsedObservations {
 public:
  UsedObservations(const EstimationProblem& problem,
                   const CycleReport& report,
                   const ChosenCoordinates& chosen,
                   const EstimationOptions& options)
      : evaluator_(problem, options),
        point_(evaluator_.at(problem.prior.x)),
        chosen_(chosen),
        held_(chosen.others()),
        shared_(groupByDwell(problem, options)),
        used_(keptObservations(problem, report)),
        dwell_(chosen.size()) {}

  std::size_t size() const { return used_.size(); }
  /// Of an observation, among those that were used.
  std::size_t place(std::size_t observation) const {
    return static_cast<std::size_t>(std::lower_bound(used_.begin(), used_.end(), observation) -
                                    used_.begin());
  }

  void addTo(InformationSum& sum) {
    for (const std::size_t n : used_) {
      if (!shared_.shares[n]) {
        sum.add(linearized(n).whitened);
      }
    }
    for (const std::vector<std::size_t>& dwell : shared_.dwells) {
      begin(dwell);
      dwell_.addTo(sum);
    }
  }

  /// visit(SeenObservation) for each of them.
  template <typename Visit>
  void forEach(const Visit& visit) {
    for (const std::size_t n : used_) {
      if (!shared_.shares[n]) {
        visit(SeenObservation{n, linearized(n).whitened});
      }
    }
    for (const std::vector<std::size_t>& dwell : shared_.dwells) {
      begin(dwell);
      for (const Member& member : members_) {
        visit(seen(member));
      }
    }
  }

 private:
  struct Member {
    std::size_t observation = 0;
    WhitenedObservation whitened;
    SharedLoading loading = SharedLoading::Zero();
  };

  Member linearized(std::size_t n) {
    evaluator_.linearize(n, point_, linear_);
    const bool shares = shared_.shares[n];
    const Eigen::Matrix3d noise =
        shares ? evaluator_.ownNoise(n, linear_) : evaluator_.noise(n, linear_);
    const Eigen::Matrix3d W = whiteningOf(noise + evaluator_.heldCovariance(linear_, held_));
    Member member{n, {}, SharedLoading::Zero()};
    whiten(linear_, W, chosen_, member.whitened);
    if (shares) {
      member.loading = W * evaluator_.sharedErrors(n, linear_);
    }
    return member;
  }

  /// Takes up a dwell: those of its observations that were used.
  void begin(const std::vector<std::size_t>& dwell) {
    dwell_.begin();
    members_.clear();
    for (const std::size_t n : dwell) {
      if (std::binary_search(used_.begin(), used_.end(), n)) {
        members_.push_back(linearized(n));
        dwell_.add(members_.back().whitened, members_.back().loading);
      }
    }
    columns_.clear();
    for (const Member& member : members_) {
      columns_.insert(
          columns_.end(), member.whitened.columns.begin(), member.whitened.columns.end());
    }
    std::sort(columns_.begin(), columns_.end());
    columns_.erase(std::unique(columns_.begin(), columns_.end()), columns_.end());
  }

  SeenObservation seen(const Member& member) const {
    const SharedLoading& G = member.loading;
    const auto covariance = dwell_.elimination().covariance();
    SeenObservation seen;
    seen.observation = member.observation;
    seen.hat_of_shared = G * covariance * G.transpose();
    seen.whitened.residual = member.whitened.residual - G * dwell_.elimination().errors();
    seen.whitened.columns = columns_;
    seen.whitened.jacobian =
        -(G * covariance) * Eigen::MatrixXd(dwell_.crossed()(Eigen::all, columns_));
    for (std::size_t k = 0; k < member.whitened.columns.size(); ++k) {
      const auto at =
          std::lower_bound(columns_.begin(), columns_.end(), member.whitened.columns[k]);
      seen.whitened.jacobian.col(at - columns_.begin()) +=
          member.whitened.jacobian.col(static_cast<Eigen::Index>(k));
    }
    return seen;
  }

  ObservationEvaluator evaluator_;
  ModelPoint point_;
  const ChosenCoordinates& chosen_;
  std::vector<bool> held_;
  SharedErrorModel shared_;
  std::vector<std::size_t> used_;  ///< ascending
  // Of the dwell at hand.
  DwellSum dwell_;
  std::vector<Member> members_;
  std::vector<Eigen::Index> columns_;  ///< that are not zero for all of them
  LinearizedObservation linear_;
};

/// An observation as the fit without it sees it.
struct LeftOut {
  double leverage = 0.0;
  Eigen::Vector3d predicted_residual;  ///< (I − H)⁻¹ r, where other observations predict it
  std::optional<Eigen::Vector3d> sole_direction;  ///< that no other observation predicts
};

LeftOut leaveOut(const Eigen::Matrix3d& hat, const Eigen::Vector3d& residual) {
  // A standard deviation that would grow a thousandfold is no prediction.
  constexpr double kSmallestCheck = 1e-6;
  const SymmetricEigen eigen = symmetricEigen(0.5 * (hat + hat.transpose()));
  LeftOut result;
  result.leverage = hat.trace() / 3.0;
  result.predicted_residual.setZero();
  for (int k = 0; k < 3; ++k) {
    const Eigen::Vector3d direction = eigen.vectors.col(k);
    const double check = 1.0 - eigen.values[k];
    if (check < kSmallestCheck) {
      result.sole_direction = direction;
    } else {
      result.predicted_residual += direction * (direction.dot(residual) / check);
    }
  }
  return result;
}

}  // namespace

std::vector<SampleInfluence> sampleInfluences(const CalibrationSession& session) {
  if (session.reports().empty()) {
    return {};
  }
  const CalibrationModel& model = session.model();
  const std::vector<Sample>& samples = session.samples();
  const CycleReport& report = session.reports().back();
  const CalibrationState& after = session.state();
  const EstimationOptions& options = session.config().estimation;
  const std::vector<Eigen::Index> coordinates = estimatedCoordinates(model.space(), report);
  if (!report.success || coordinates.empty()) {
    return {};
  }
  EstimationProblem problem;
  problem.model = &model;
  problem.samples = &samples;
  problem.observations =
      selectObservations(model.space(), samples, {report.cycle, report.coil}, options);
  problem.prior = after.belief;
  const ChosenCoordinates chosen(model.space().size(), coordinates);
  UsedObservations used(problem, report, chosen, options);

  InformationSum sum(priorInformation(report.open_directions, after.belief, coordinates) +
                     statedInformation(model.space(), coordinates));
  used.addTo(sum);
  Eigen::MatrixXd information = sum.information();
  if (const MotionEvidence* motion = session.joinedMotion()) {
    const MotionInformation own = ownInformation(model.space(), *motion);
    information += own.information(coordinates, coordinates);
  }
  const Eigen::MatrixXd covariance = InformationFactor(information).inverse();
  const Eigen::VectorXd stddevs = covariance.diagonal().cwiseMax(0.0).cwiseSqrt();

  std::vector<SampleInfluence> influences(used.size());
  used.forEach([&](const SeenObservation& seen) {
    const WhitenedObservation& whitened = seen.whitened;
    const Eigen::Matrix<double, Eigen::Dynamic, 3> gain = whitened.timesTransposed(covariance);
    const LeftOut left_out = leaveOut(whitened.times(gain) + seen.hat_of_shared, whitened.residual);
    const auto largest = [&stddevs](const Eigen::VectorXd& change, Eigen::Index& place) {
      return change.cwiseAbs().cwiseQuotient(stddevs).maxCoeff(&place);
    };
    SampleInfluence& influence = influences[used.place(seen.observation)];
    influence.id = samples[problem.observations[seen.observation].sample].id;
    influence.quantity = problem.observations[seen.observation].quantity;
    influence.leverage = left_out.leverage;
    Eigen::Index worst = 0;
    influence.largest_shift = largest(gain * left_out.predicted_residual, worst);
    influence.irreplaceable = left_out.sole_direction.has_value();
    if (left_out.sole_direction) {
      largest(gain * *left_out.sole_direction, worst);
    }
    influence.parameter = model.space().name(coordinates[static_cast<std::size_t>(worst)]);
  });
  return influences;
}

}  // namespace sac
