#include "spherical_actuator_calibration/planning/pose_planner.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "pose_candidates.hpp"
#include "pose_selection.hpp"
#include "spherical_actuator_calibration/base/text_format.hpp"
#include "spherical_actuator_calibration/calibration/calibration_cycles.hpp"
#include "spherical_actuator_calibration/estimation/sample_prediction.hpp"
#include "travel_order.hpp"

namespace sac {
namespace {

/// Standard deviation of what nothing tells [rad]: about a manufacturing tolerance. It only ranks
/// the first poses, which cannot determine everything; the result does not contain it.
constexpr double kWeakPrior = 0.03;

/// Exchanges pay until the plan settles. Passes over a plan that is to grow need not settle, and a
/// large plan gains little by them: together they try this many exchanges, some seconds' work.
constexpr int kMostPasses = 8;
constexpr int kPassesWhileGrowing = 2;
constexpr std::size_t kMostExchanges = 300;
/// An exchange lowers the largest standard deviation by less than this factor.
constexpr double kExchangePromise = 1.6;

/// Joint angles of the chosen poses, in the order of the selection.
std::vector<Eigen::Vector3d> jointPositions(const std::vector<PoseCandidate>& candidates,
                                            const std::vector<SelectedPose>& poses) {
  std::vector<Eigen::Vector3d> positions;
  positions.reserve(poses.size());
  for (const SelectedPose& pose : poses) {
    positions.push_back(candidates[pose.candidate].joint_position);
  }
  return positions;
}

std::vector<std::size_t> coilsOf(const std::vector<PoseCandidate>& candidates,
                                 const SelectedPose& pose) {
  std::vector<std::size_t> coils;
  coils.reserve(pose.torques.size());
  for (const std::size_t torque : pose.torques) {
    coils.push_back(candidates[pose.candidate].coils[torque]);
  }
  return coils;
}

/// Chooses poses and finds out what the cycle will make of them.
class Planner {
 public:
  Planner(const PlanningProblem& problem, const PosePlanOptions& options)
      : problem_(problem),
        options_(options),
        point_(*problem.model, problem.state.belief.x),
        coordinates_(plannedCoordinates(problem)),
        candidates_(drawCandidates(problem, options, coordinates_)),
        selection_(candidates_, knownInformation(), selectionOptions()),
        held_(*problem.held) {
    for (Sample& sample : held_) {
      predictMeasurements(point_, sample);
    }
  }

  PosePlan run() {
    PosePlan plan;
    expect(plan);
    while (!plan.reached_wanted && selection_.poses().size() < options_.max_poses &&
           selection_.add()) {
      const bool is_last = selection_.poses().size() == options_.max_poses;
      if (is_last || selection_.worstStddev() < kExchangePromise * options_.wanted_stddev) {
        improve(is_last ? kMostPasses : kPassesWhileGrowing);
        expect(plan);
      }
    }
    // Candidates may have run out before the last pose was reached.
    if (!plan.reached_wanted && selection_.poses().size() < options_.max_poses) {
      improve(kMostPasses);
      expect(plan);
    }
    lay(plan);
    conclude(plan);
    return plan;
  }

 private:
  Eigen::MatrixXd knownInformation() const {
    const auto count = static_cast<Eigen::Index>(coordinates_.size());
    return heldInformation(problem_, coordinates_) +
           Eigen::MatrixXd::Identity(count, count) / (kWeakPrior * kWeakPrior);
  }

  PoseSelection::Options selectionOptions() const {
    PoseSelection::Options result;
    result.torques_per_pose =
        problem_.request.cycle == Cycle::kRefine ? options_.coils_per_pose : 1;
    result.minimum_spacing = options_.minimum_spacing;
    result.criterion = options_.criterion;
    return result;
  }

  void improve(int most_passes) {
    for (int pass = 0; pass < most_passes && exchanges_ < kMostExchanges; ++pass) {
      exchanges_ += selection_.poses().size();
      if (!selection_.exchange()) {
        return;
      }
    }
  }

  /// Runs the cycle on noise-free samples of what is held and what is selected.
  void expect(PosePlan& plan) {
    std::vector<Sample> samples = held_;
    for (const SelectedPose& pose : selection_.poses()) {
      for (Sample& sample : visitSamples(problem_,
                                         options_,
                                         candidates_[pose.candidate].joint_position,
                                         coilsOf(candidates_, pose))) {
        predictMeasurements(point_, sample);
        samples.push_back(std::move(sample));
      }
    }
    outcome_ =
        runCycle(*problem_.model, samples, problem_.state, problem_.request, problem_.estimation);
    plan.orientation_uncertainty = outcome_.report.orientation_uncertainty;
    plan.torque_uncertainty = outcome_.report.torque_uncertainty;
    expectParameters(plan);
  }

  void expectParameters(PosePlan& plan) const {
    const ParameterSpace& space = problem_.model->space();
    const ParameterBelief& belief = outcome_.state.belief;
    const Eigen::VectorXd nominal = space.reportedValues(Eigen::VectorXd::Zero(space.size()));
    const Eigen::VectorXd values = space.reportedValues(problem_.state.belief.x);
    const Eigen::VectorXd stddevs = space.reportedStddevs(belief.x, belief.covariance);
    plan.expected.clear();
    for (const Eigen::Index p : coordinates_) {
      plan.expected.push_back(
          {space.name(p), nominal[p], values[p], values[p], stddevs[p], isObservable(p)});
    }
    const auto worst = std::max_element(
        plan.expected.begin(), plan.expected.end(), [](const auto& a, const auto& b) {
          return a.stddev < b.stddev;
        });
    plan.worst_parameter = worst->name;
    plan.worst_stddev = worst->stddev;
    plan.reached_wanted = isAllObservable(plan) && plan.worst_stddev <= options_.wanted_stddev;
  }

  bool isObservable(Eigen::Index coordinate) const {
    const std::string name = problem_.model->space().name(coordinate);
    const std::vector<ParameterEstimate>& estimates = outcome_.report.estimates;
    return std::any_of(estimates.begin(), estimates.end(), [&](const ParameterEstimate& estimate) {
      return estimate.name == name && estimate.observable;
    });
  }

  static bool isAllObservable(const PosePlan& plan) {
    return std::all_of(plan.expected.begin(),
                       plan.expected.end(),
                       [](const ParameterEstimate& estimate) { return estimate.observable; });
  }

  /// Lays the selected poses out for a short way.
  void lay(PosePlan& plan) const {
    const std::vector<Eigen::Vector3d> positions = jointPositions(candidates_, selection_.poses());
    const std::vector<std::size_t> order = travelOrder(options_.start, positions);
    plan.travel = travelLength(options_.start, positions, order);
    for (const std::size_t n : order) {
      const SelectedPose& pose = selection_.poses()[n];
      PlannedPose planned{positions[n], coilsOf(candidates_, pose)};
      plan.torque_samples += planned.coils.size();
      plan.orientation_samples += candidates_[pose.candidate].orientation ? 1 : 0;
      plan.poses.push_back(std::move(planned));
    }
  }

  void conclude(PosePlan& plan) const {
    const std::size_t poses = plan.poses.size();
    plan.success = poses > 0 || plan.reached_wanted;
    if (!plan.success) {
      plan.message = "No pose inside the limits tells anything new: widen tilt and spin limits.";
      return;
    }
    if (!outcome_.report.success || !isAllObservable(plan)) {
      plan.message = "The planned samples do not determine everything. " + outcome_.report.message;
      return;
    }
    if (plan.reached_wanted) {
      plan.poses_needed = poses;
    } else if (options_.wanted_stddev > 0.0) {
      const double ratio = plan.worst_stddev / options_.wanted_stddev;
      plan.poses_needed =
          static_cast<std::size_t>(std::ceil(static_cast<double>(poses) * ratio * ratio));
    }
    plan.message = sentence(plan, poses);
  }

  std::string sentence(const PosePlan& plan, std::size_t poses) const {
    if (poses == 0) {
      return format("No pose is needed: the samples held give a standard deviation of %.3g mrad.",
                    1e3 * plan.worst_stddev);
    }
    std::string text = format(
        "%zu poses, %zu orientations and %zu torques: the worst parameter, %s, is expected "
        "at a standard deviation of %.3g mrad.",
        poses,
        plan.orientation_samples,
        plan.torque_samples,
        plan.worst_parameter.c_str(),
        1e3 * plan.worst_stddev);
    if (options_.wanted_stddev > 0.0 && !plan.reached_wanted) {
      text += format(" About %zu poses are needed for %.3g mrad.",
                     *plan.poses_needed,
                     1e3 * options_.wanted_stddev);
    }
    return text;
  }

  const PlanningProblem& problem_;
  const PosePlanOptions& options_;
  ModelPoint point_;  ///< of what is believed
  std::vector<Eigen::Index> coordinates_;
  std::vector<PoseCandidate> candidates_;
  PoseSelection selection_;
  std::vector<Sample> held_;   ///< with the values that fit the parameters in force
  std::size_t exchanges_ = 0;  ///< tried
  CycleOutcome outcome_;       ///< of the last expect()
};

}  // namespace

PosePlan planPoses(const PlanningProblem& problem, const PosePlanOptions& options) {
  validate(options, problem);
  return Planner(problem, options).run();
}

}  // namespace sac
