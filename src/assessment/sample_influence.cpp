#include "spherical_actuator_calibration/assessment/sample_influence.hpp"

#include <optional>

#include <Eigen/Eigenvalues>

#include "estimated_part.hpp"
#include "spherical_actuator_calibration/estimation/information_factor.hpp"
#include "spherical_actuator_calibration/estimation/whitened_observation.hpp"

namespace sac {
namespace {

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
        used_(keptObservations(problem, report)) {}

  std::size_t size() const { return used_.size(); }

  /// visit(observation, whitened) for each of them.
  template <typename Visit>
  void forEach(const Visit& visit) const {
    LinearizedObservation linear;
    WhitenedObservation whitened;
    for (const std::size_t n : used_) {
      evaluator_.linearize(n, point_, linear);
      whiten(linear, whiteningOf(evaluator_.covariance(n, linear, held_)), chosen_, whitened);
      visit(n, whitened);
    }
  }

 private:
  ObservationEvaluator evaluator_;
  ModelPoint point_;
  const ChosenCoordinates& chosen_;
  std::vector<bool> held_;
  std::vector<std::size_t> used_;
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
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen(0.5 * (hat + hat.transpose()));
  LeftOut result;
  result.leverage = hat.trace() / 3.0;
  result.predicted_residual.setZero();
  for (int k = 0; k < 3; ++k) {
    const Eigen::Vector3d direction = eigen.eigenvectors().col(k);
    const double check = 1.0 - eigen.eigenvalues()[k];
    if (check < kSmallestCheck) {
      result.sole_direction = direction;
    } else {
      result.predicted_residual += direction * (direction.dot(residual) / check);
    }
  }
  return result;
}

}  // namespace

std::vector<SampleInfluence> sampleInfluences(const CalibrationModel& model,
                                              const std::vector<Sample>& samples,
                                              const CycleReport& report,
                                              const CalibrationState& after,
                                              const EstimationOptions& options) {
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
  const UsedObservations used(problem, report, chosen, options);

  InformationSum sum(priorInformation(report.open_directions, after.belief, coordinates));
  used.forEach([&](std::size_t /*n*/, const WhitenedObservation& whitened) { sum.add(whitened); });
  const Eigen::MatrixXd covariance = InformationFactor(sum.information()).inverse();
  const Eigen::VectorXd stddevs = covariance.diagonal().cwiseMax(0.0).cwiseSqrt();

  std::vector<SampleInfluence> influences;
  influences.reserve(used.size());
  used.forEach([&](std::size_t observation, const WhitenedObservation& whitened) {
    const Eigen::Matrix<double, Eigen::Dynamic, 3> gain = whitened.timesTransposed(covariance);
    const LeftOut left_out = leaveOut(whitened.times(gain), whitened.residual);
    const auto largest = [&stddevs](const Eigen::VectorXd& change, Eigen::Index& place) {
      return change.cwiseAbs().cwiseQuotient(stddevs).maxCoeff(&place);
    };
    SampleInfluence influence;
    influence.id = samples[problem.observations[observation].sample].id;
    influence.quantity = problem.observations[observation].quantity;
    influence.leverage = left_out.leverage;
    Eigen::Index worst = 0;
    influence.largest_shift = largest(gain * left_out.predicted_residual, worst);
    influence.irreplaceable = left_out.sole_direction.has_value();
    if (left_out.sole_direction) {
      largest(gain * *left_out.sole_direction, worst);
    }
    influence.parameter = model.space().name(coordinates[static_cast<std::size_t>(worst)]);
    influences.push_back(influence);
  });
  return influences;
}

}  // namespace sac
