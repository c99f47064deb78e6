#include "spherical_actuator_calibration/planning/pose_planner.hpp"

#include <algorithm>
#include <cmath>
#include <set>
#include <string>
#include <utility>

#include "coil_visits.hpp"
#include "design_bound.hpp"
#include "design_task.hpp"
#include "pose_candidates.hpp"
#include "pose_selection.hpp"
#include "spherical_actuator_calibration/calibration/calibration_cycles.hpp"
#include "spherical_actuator_calibration/estimation/defined_stddev.hpp"
#include "spherical_actuator_calibration/estimation/sample_prediction.hpp"
#include "spherical_actuator_calibration/estimation/stated_knowledge.hpp"
#include "spherical_actuator_calibration/planning/plan_guidance.hpp"
#include "spherical_actuator_calibration/planning/planning_problem.hpp"
#include "travel_order.hpp"
#include "weighing_design.hpp"

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

/// The same for patterns, from single coils to exchanged patterns, and from patterns that are not
/// exchanged yet to such that are.
constexpr double kPatternPromise = 2.5;
constexpr double kPatternExchangePromise = 1.15;
/// The bound is over so many times the candidates that poses are chosen from, where those are few.
constexpr std::size_t kTimesForBound = 5;
constexpr std::size_t kMostForBound = 10'000;

/// A candidate with what is excited there.
struct ChosenPose {
  std::size_t candidate = 0;
  std::vector<CoilPattern> patterns;
};

/// Joint angles of the chosen poses, in their order.
std::vector<Eigen::Vector3d> jointPositions(const std::vector<PoseCandidate>& candidates,
                                            const std::vector<ChosenPose>& poses) {
  std::vector<Eigen::Vector3d> positions;
  positions.reserve(poses.size());
  for (const ChosenPose& pose : poses) {
    positions.push_back(candidates[pose.candidate].joint_position);
  }
  return positions;
}

ChosenPose chosen(const std::vector<PoseCandidate>& candidates, const SelectedPose& pose) {
  std::vector<std::size_t> coils;
  coils.reserve(pose.torques.size());
  for (const std::size_t torque : pose.torques) {
    coils.push_back(candidates[pose.candidate].coils[torque]);
  }
  return {pose.candidate, singly(coils)};
}

ChosenPose chosen(const std::vector<PoseCandidate>& candidates, const DesignedPose& pose) {
  ChosenPose result{pose.candidate, {}};
  for (const TermPattern& terms : pose.patterns) {
    CoilPattern& pattern = result.patterns.emplace_back();
    for (const SignedTerm& term : terms) {
      pattern.push_back({candidates[pose.candidate].coils[term.term], term.sign});
    }
    std::sort(pattern.begin(), pattern.end(), [](const SignedCoil& a, const SignedCoil& b) {
      return a.coil < b.coil;
    });
  }
  return result;
}

PlannedPose planned(const PoseCandidate& candidate, const ChosenPose& pose, bool has_patterns) {
  PlannedPose result;
  result.joint_position = candidate.joint_position;
  std::set<std::size_t> coils;
  for (const CoilPattern& pattern : pose.patterns) {
    for (const SignedCoil& coil : pattern) {
      coils.insert(coil.coil);
    }
  }
  result.coils.assign(coils.begin(), coils.end());
  if (has_patterns) {
    result.patterns = pose.patterns;
  }
  return result;
}

/// Chooses poses and finds out what the cycle will make of them.
class Planner {
 public:
  Planner(const PlanningProblem& problem, const PosePlanOptions& options)
      : problem_(problem),
        options_(options),
        point_(*problem.model, problem.state.belief.x),
        coordinates_(plannedCoordinates(problem)),
        known_(knownInformation()),
        candidates_(drawCandidates(problem, options, coordinates_)),
        selection_(candidates_, known_, selectionOptions()),
        held_(*problem.held) {
    if (plansPatterns(problem, options)) {
      task_ = designTask();
    }
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
      if (is_last || isPromising()) {
        choose(is_last);
        expect(plan);
      }
    }
    // Candidates may have run out before the last pose was reached.
    if (!plan.reached_wanted && selection_.poses().size() < options_.max_poses) {
      choose(true);
      expect(plan);
    }
    lay(plan);
    conclude(plan);
    return plan;
  }

 private:
  /// What is known before the first pose, with the weak prior.
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

  DesignTask designTask() const {
    const ParameterSpace& space = problem_.model->space();
    DesignTask task;
    task.known = known_ + statedInformation(space, coordinates_);
    task.reported = reportedDerivative(space, problem_.state.belief.x, coordinates_);
    task.visited = measuredVisits(*problem_.held,
                                  space.coils(),
                                  problem_.estimation.current_threshold,
                                  options_.minimum_spacing);
    task.patterns_per_pose = options_.coils_per_pose;
    task.coils_per_pattern = coilsPerPattern(options_);
    task.minimum_spacing = options_.minimum_spacing;
    return task;
  }

  /// Whether the poses selected so far may reach what is wanted.
  bool isPromising() const {
    const double promise = task_ ? kPatternPromise : kExchangePromise;
    return selection_.worstStddev() < promise * options_.wanted_stddev;
  }

  /// Chooses what the poses selected so far become by exchanges.
  void choose(bool is_last) {
    chosen_.clear();
    if (task_) {
      chooseByPatterns(is_last);
      return;
    }
    const int most_passes = is_last ? kMostPasses : kPassesWhileGrowing;
    for (int pass = 0; pass < most_passes && exchanges_ < kMostExchanges && !isTimeUp(); ++pass) {
      exchanges_ += selection_.poses().size();
      if (!selection_.exchange()) {
        break;
      }
    }
    for (const SelectedPose& pose : selection_.poses()) {
      chosen_.push_back(chosen(candidates_, pose));
    }
  }

  void chooseByPatterns(bool is_last) {
    std::vector<std::size_t> poses;
    for (const SelectedPose& pose : selection_.poses()) {
      poses.push_back(pose.candidate);
    }
    WeighingDesign design(*task_, candidates_, poses, options_.is_time_up);
    design.choosePatterns();
    if (is_last || design.worstStddev() < kPatternExchangePromise * options_.wanted_stddev) {
      findBound(design);
      design.exchange();
    }
    for (const DesignedPose& pose : design.poses()) {
      chosen_.push_back(chosen(candidates_, pose));
    }
  }

  void findBound(const WeighingDesign& design) {
    bound_.reset();
    if (design.poses().empty() || isTimeUp()) {
      return;
    }
    if (candidates_of_bound_.empty()) {
      PosePlanOptions wide = options_;
      wide.candidates = std::max(options_.candidates,
                                 std::min(kTimesForBound * options_.candidates, kMostForBound));
      candidates_of_bound_ = drawCandidates(problem_, wide, coordinates_);
    }
    DesignBound bound(*task_,
                      candidates_of_bound_,
                      design.poses().size(),
                      designInformation(*task_, candidates_, design.poses()));
    bound.improve(options_.is_time_up);
    if (bound.stddev() > 0.0) {
      bound_ = bound.stddev();
    }
  }

  bool hasJoints() const { return problem_.model->space().joints() > 0; }
  bool isTimeUp() const { return options_.is_time_up && options_.is_time_up(); }

  /// Runs the cycle on noise-free samples of what is held and what is selected.
  void expect(PosePlan& plan) {
    std::vector<Sample> samples = held_;
    for (const ChosenPose& pose : chosen_) {
      for (Sample& sample : visitSamples(
               problem_, options_, candidates_[pose.candidate].joint_position, pose.patterns)) {
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
          return definedStddev(a.stddev) < definedStddev(b.stddev);
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

  /// Lays the chosen poses out for a short way.
  void lay(PosePlan& plan) const {
    const std::vector<Eigen::Vector3d> positions = jointPositions(candidates_, chosen_);
    const std::vector<std::size_t> order = travelOrder(options_.start, positions);
    plan.travel = travelLength(options_.start, positions, order);
    for (const std::size_t n : order) {
      const PoseCandidate& candidate = candidates_[chosen_[n].candidate];
      plan.torque_samples += chosen_[n].patterns.size();
      plan.orientation_samples += candidate.orientation || !hasJoints() ? 1 : 0;
      plan.poses.push_back(planned(candidate, chosen_[n], task_.has_value()));
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
      plan.message = openSentence(plan);
      return;
    }
    if (plan.reached_wanted) {
      plan.poses_needed = poses;
    } else if (options_.wanted_stddev > 0.0) {
      const double ratio = plan.worst_stddev / options_.wanted_stddev;
      plan.poses_needed =
          static_cast<std::size_t>(std::ceil(static_cast<double>(poses) * ratio * ratio));
    }
    plan.stddev_bound = bound_;
    plan.message = planSentence(plan, options_.wanted_stddev);
  }

  const PlanningProblem& problem_;
  const PosePlanOptions& options_;
  ModelPoint point_;  ///< of what is believed
  std::vector<Eigen::Index> coordinates_;
  Eigen::MatrixXd known_;
  std::vector<PoseCandidate> candidates_;
  PoseSelection selection_;
  std::optional<DesignTask> task_;  ///< where patterns of several coils are planned
  std::vector<PoseCandidate> candidates_of_bound_;
  std::optional<double> bound_;  ///< of the largest standard deviation [rad]
  std::vector<ChosenPose> chosen_;
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
