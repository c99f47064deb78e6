#include "pose_candidates.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numeric>
#include <utility>

#include "spherical_actuator_calibration/actuator/spherical_joint.hpp"
#include "spherical_actuator_calibration/base/noise_source.hpp"
#include "spherical_actuator_calibration/base/random_purpose.hpp"
#include "spherical_actuator_calibration/calibration/cycle_problem.hpp"
#include "spherical_actuator_calibration/estimation/linearization.hpp"
#include "spherical_actuator_calibration/estimation/sample_prediction.hpp"
#include "spherical_actuator_calibration/measurement/coil_pattern.hpp"
#include "spherical_actuator_calibration/measurement/torque_pose_sampler.hpp"
#include "spherical_actuator_calibration/planning/planning_problem.hpp"

namespace sac {
namespace {

/// Poses drawn for each candidate wanted, before the search for useful ones ends.
constexpr std::size_t kMostDraws = 30;

/// Observations of samples in the coordinates to estimate. What is not estimated adds the
/// uncertainty of the state to an observation's noise, as in the cycle.
class Linearizer {
 public:
  Linearizer(const PlanningProblem& problem,
             const std::vector<Sample>& samples,
             const std::vector<Eigen::Index>& coordinates)
      : samples_(samples),
        chosen_(problem.model->space().size(), coordinates),
        held_(chosen_.others()),
        estimation_(estimationProblem(problem, samples)),
        evaluator_(estimation_, problem.estimation),
        point_(evaluator_.at(estimation_.prior.x)) {}

  const std::vector<Observation>& observations() const { return estimation_.observations; }

  WhitenedObservation linearize(std::size_t observation) {
    last_ = observation;
    evaluator_.linearize(observation, point_, linear_);
    const Eigen::Matrix3d whitening =
        whiteningOf(evaluator_.covariance(observation, linear_, held_));
    return inUnits(whitening);
  }

  /// The observation linearised last, in units of `stddev` whatever else its noise holds, with the
  /// errors of its readings (kPoseErrors) behind the coordinates.
  WhitenedObservation inUnitsOf(double stddev) const {
    WhitenedObservation result = inUnits(Eigen::Matrix3d::Identity() / stddev);
    const Sample& sample = samples_[observations()[last_].sample];
    const Eigen::Matrix3d of_readings =
        linear_.d_pose.reading * sample.joint_stddev.asDiagonal() / stddev;
    if (of_readings.isZero(0.0)) {
      return result;
    }
    const auto count = static_cast<Eigen::Index>(result.columns.size());
    result.jacobian.conservativeResize(3, count + kPoseErrors);
    result.jacobian.rightCols<kPoseErrors>() = of_readings;
    for (Eigen::Index k = 0; k < kPoseErrors; ++k) {
      result.columns.push_back(chosen_.size() + k);
    }
    return result;
  }

 private:
  WhitenedObservation inUnits(const Eigen::Matrix3d& whitening) const {
    WhitenedObservation result;
    whiten(linear_, whitening, chosen_, result);
    return result;
  }

  static EstimationProblem estimationProblem(const PlanningProblem& problem,
                                             const std::vector<Sample>& samples) {
    EstimationProblem result;
    result.model = problem.model;
    result.samples = &samples;
    result.observations =
        selectObservations(problem.model->space(), samples, problem.request, problem.estimation);
    result.prior = problem.state.belief;
    return result;
  }

  const std::vector<Sample>& samples_;
  ChosenCoordinates chosen_;
  std::vector<bool> held_;  ///< per coordinate: not estimated
  EstimationProblem estimation_;
  ObservationEvaluator evaluator_;
  ModelPoint point_;
  LinearizedObservation linear_;
  std::size_t last_ = 0;  ///< observation of linear_
};

/// Coils that may serve the cycle at all.
std::vector<std::size_t> usableCoils(const PlanningProblem& problem) {
  if (problem.request.cycle == Cycle::kJoint || !problem.model->hasTorqueModel()) {
    return {};
  }
  if (problem.request.cycle != Cycle::kRefine) {
    return {problem.request.coil.value()};
  }
  std::vector<std::size_t> coils(problem.model->space().coils());
  std::iota(coils.begin(), coils.end(), 0);
  return coils;
}

bool measuresOrientation(const PlanningProblem& problem, const PosePlanOptions& options) {
  return problem.request.cycle == Cycle::kJoint ||
         (problem.model->space().joints() > 0 && problem.request.cycle == Cycle::kRefine &&
          options.tracker_on);
}

/// Poses with the coils that may be excited there, not linearised yet.
std::vector<PoseCandidate> drawPoses(const PlanningProblem& problem,
                                     const PosePlanOptions& options) {
  const Actuator actuator = problem.model->space().actuatorAt(problem.state.belief.x);
  const double tilt = options.tilt_limit.value_or(actuator.workspace.tilt_limit);
  const JointGeometry joints = jointGeometry(actuator);
  const std::vector<std::size_t> coils = usableCoils(problem);
  std::optional<TorquePoseSampler> sampler;
  if (!coils.empty()) {
    sampler.emplace(actuator, tilt);
  }
  NoiseSource noise(options.seed, RandomPurpose::kPoseCandidates);
  std::vector<PoseCandidate> candidates;
  for (std::size_t n = 0;
       n < kMostDraws * options.candidates && candidates.size() < options.candidates;
       ++n) {
    PoseCandidate candidate;
    candidate.joint_position[0] = noise.uniform(tilt);
    candidate.joint_position[1] = noise.uniform(tilt);
    candidate.joint_position[2] =
        options.spin_minimum + noise.share() * (options.spin_maximum - options.spin_minimum);
    for (const std::size_t coil : coils) {
      if (sampler->grade(candidate.joint_position, coil, std::nullopt) == PoseGrade::kClear) {
        candidate.coils.push_back(coil);
      }
    }
    if (!candidate.coils.empty() || measuresOrientation(problem, options)) {
      candidate.R_stator_rotor = rotorOrientation(joints, candidate.joint_position);
      candidates.push_back(candidate);
    }
  }
  return candidates;
}

/// (a ± b)/2 of two derivatives.
WhitenedObservation halfSum(const WhitenedObservation& a,
                            const WhitenedObservation& b,
                            double sign) {
  WhitenedObservation result;
  std::set_union(a.columns.begin(),
                 a.columns.end(),
                 b.columns.begin(),
                 b.columns.end(),
                 std::back_inserter(result.columns));
  result.jacobian.setZero(3, static_cast<Eigen::Index>(result.columns.size()));
  const auto add = [&result](const WhitenedObservation& term, double factor) {
    for (std::size_t k = 0; k < term.columns.size(); ++k) {
      const auto place =
          std::lower_bound(result.columns.begin(), result.columns.end(), term.columns[k]) -
          result.columns.begin();
      result.jacobian.col(place) += factor * term.jacobian.col(static_cast<Eigen::Index>(k));
    }
  };
  add(a, 0.5);
  add(b, 0.5 * sign);
  return result;
}

/// Splits the terms of the candidates into what turns its sign with the current, and what does not.
void takeOutUnexcited(const PlanningProblem& problem,
                      const PosePlanOptions& options,
                      const std::vector<Eigen::Index>& coordinates,
                      std::vector<PoseCandidate>& candidates) {
  PosePlanOptions opposite = options;
  opposite.tracker_on = false;
  const ModelPoint point(*problem.model, problem.state.belief.x);
  std::vector<Sample> samples;
  for (const PoseCandidate& candidate : candidates) {
    for (const std::size_t coil : candidate.coils) {
      samples.push_back(
          visitSamples(problem, opposite, candidate.joint_position, {{{coil, -1}}}).front());
      predictMeasurements(point, samples.back());
    }
  }
  Linearizer linearizer(problem, samples, coordinates);
  std::size_t next = 0;
  for (PoseCandidate& candidate : candidates) {
    for (WhitenedObservation& term : candidate.terms) {
      linearizer.linearize(next++);
      const WhitenedObservation negative = linearizer.inUnitsOf(options.torque_stddev);
      candidate.unexcited = halfSum(term, negative, 1.0);
      term = halfSum(term, negative, -1.0);
    }
  }
}

}  // namespace

std::vector<Eigen::Index> plannedCoordinates(const PlanningProblem& problem) {
  const ParameterSpace& space = problem.model->space();
  if (problem.request.cycle != Cycle::kRefine) {
    return selectCoordinates(space, {}, problem.request, problem.estimation);
  }
  std::vector<Eigen::Index> coordinates(static_cast<std::size_t>(space.size()));
  std::iota(coordinates.begin(), coordinates.end(), 0);
  if (!problem.model->hasTorqueModel()) {
    // Poles and coils without a curve cannot be told by anything.
    coordinates.erase(coordinates.begin() + space.pole(0), coordinates.begin() + space.effect());
  }
  return coordinates;
}

Eigen::MatrixXd heldInformation(const PlanningProblem& problem,
                                const std::vector<Eigen::Index>& coordinates) {
  InformationSum sum(static_cast<Eigen::Index>(coordinates.size()));
  Linearizer linearizer(problem, *problem.held, coordinates);
  for (std::size_t n = 0; n < linearizer.observations().size(); ++n) {
    sum.add(linearizer.linearize(n));
  }
  return sum.information();
}

std::vector<Sample> visitSamples(const PlanningProblem& problem,
                                 const PosePlanOptions& options,
                                 const Eigen::Vector3d& joint_position,
                                 const std::vector<CoilPattern>& patterns) {
  Sample sample;
  sample.joint_position = joint_position;
  sample.joint_stddev = options.joint_stddev;
  sample.orientation_stddev = options.orientation_stddev;
  if (problem.model->space().joints() == 0) {
    sample.has_orientation = true;
    sample.R_stator_rotor = rotorOrientation(jointGeometry(freeRotorJoints()), joint_position);
    sample.joint_stddev.setConstant(options.orientation_stddev);
  }
  sample.torque_stddev = options.torque_stddev;
  const auto all_coils = static_cast<Eigen::Index>(problem.model->space().coils());
  sample.current = Eigen::VectorXd::Zero(all_coils);
  std::vector<Sample> samples;
  if (measuresOrientation(problem, options)) {
    samples.push_back(sample);
    samples.back().has_orientation = true;
  }
  sample.has_torque = true;
  for (const CoilPattern& pattern : patterns) {
    sample.current.setZero();
    for (const SignedCoil& signed_coil : pattern) {
      sample.current[static_cast<Eigen::Index>(signed_coil.coil)] =
          signed_coil.sign * options.current;
    }
    samples.push_back(sample);
  }
  return samples;
}

bool plansPatterns(const PlanningProblem& problem, const PosePlanOptions& options) {
  return options.patterns == PlanPatterns::kWeighing && problem.request.cycle == Cycle::kRefine &&
         problem.model->hasTorqueModel();
}

std::size_t coilsPerPattern(const PosePlanOptions& options) {
  // A limit that is a multiple of the current, but for rounding, allows all of it.
  constexpr double kRounding = 1e-9;
  const double coils = options.total_current / options.current * (1.0 + kRounding);
  return std::max<std::size_t>(1, static_cast<std::size_t>(coils));
}

std::vector<PoseCandidate> drawCandidates(const PlanningProblem& problem,
                                          const PosePlanOptions& options,
                                          const std::vector<Eigen::Index>& coordinates) {
  std::vector<PoseCandidate> candidates = drawPoses(problem, options);
  const bool plans_patterns = plansPatterns(problem, options);
  std::vector<Sample> samples;
  std::vector<std::size_t> candidate_of_sample;
  const ModelPoint point(*problem.model, problem.state.belief.x);
  for (std::size_t c = 0; c < candidates.size(); ++c) {
    for (Sample& sample : visitSamples(
             problem, options, candidates[c].joint_position, singly(candidates[c].coils))) {
      predictMeasurements(point, sample);
      samples.push_back(std::move(sample));
      candidate_of_sample.push_back(c);
    }
  }
  Linearizer linearizer(problem, samples, coordinates);
  for (std::size_t n = 0; n < linearizer.observations().size(); ++n) {
    const Observation& observation = linearizer.observations()[n];
    PoseCandidate& candidate = candidates[candidate_of_sample[observation.sample]];
    if (observation.quantity == Quantity::kOrientation) {
      candidate.orientation = linearizer.linearize(n);
      if (plans_patterns) {
        candidate.tracked = linearizer.inUnitsOf(options.orientation_stddev);
      }
      continue;
    }
    candidate.torques.push_back(linearizer.linearize(n));
    if (plans_patterns) {
      candidate.terms.push_back(linearizer.inUnitsOf(options.torque_stddev));
    }
  }
  if (plans_patterns && problem.model->space().effects().size() > 0) {
    takeOutUnexcited(problem, options, coordinates, candidates);
  }
  return candidates;
}

bool areApart(const PoseCandidate& one, const PoseCandidate& other, double spacing) {
  // The trace of R_otherᵀ R is 1 + 2 cos of the angle between them.
  const double trace = other.R_stator_rotor.cwiseProduct(one.R_stator_rotor).sum();
  return 0.5 * (trace - 1.0) <= std::cos(spacing);
}

}  // namespace sac
