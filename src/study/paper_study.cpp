#include "spherical_actuator_calibration/study/paper_study.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "spherical_actuator_calibration/actuator/actuator_design.hpp"
#include "spherical_actuator_calibration/actuator/spherical_joint.hpp"
#include "spherical_actuator_calibration/base/error.hpp"
#include "spherical_actuator_calibration/base/noise_source.hpp"
#include "spherical_actuator_calibration/base/random_purpose.hpp"
#include "spherical_actuator_calibration/base/rotations.hpp"
#include "spherical_actuator_calibration/base/value_range.hpp"
#include "spherical_actuator_calibration/calibration/calibration_cycles.hpp"
#include "spherical_actuator_calibration/emulation/manufacturing_errors.hpp"
#include "spherical_actuator_calibration/measurement/torque_pose_sampler.hpp"
#include "spherical_actuator_calibration/planning/planning_problem.hpp"
#include "spherical_actuator_calibration/planning/pose_planner.hpp"

namespace sac {
namespace {

/// Iterations of the paper's form that are looked at.
constexpr int kPaperIterations = 8;
/// Orientations that judge a calibrated joint.
constexpr std::size_t kJudges = 50;

/// A uniform distribution's standard deviation, which weights and outlier test go by.
double uniformStddev(double half_width) {
  return half_width / std::sqrt(3.0);
}

std::vector<Eigen::Vector3d> randomPoses(std::size_t count, double tilt, std::uint64_t seed) {
  NoiseSource random(seed, RandomPurpose::kStudyOrientations);
  std::vector<Eigen::Vector3d> poses(count);
  std::generate(poses.begin(), poses.end(), [&] { return randomPose(tilt, random); });
  return poses;
}

std::vector<Eigen::Vector3d> largeTorquePoses(const PaperStudyOptions& options,
                                              std::size_t coil,
                                              std::size_t count,
                                              std::uint64_t seed) {
  constexpr std::size_t kChoice = 100;
  const JointGeometry joints = jointGeometry(options.nominal.joints);
  const TorqueGeometry geometry = torqueGeometry(options.nominal);
  const TorqueCurve curve(*options.nominal.torque_curve);
  const auto place = static_cast<Eigen::Index>(coil);
  std::vector<std::pair<double, Eigen::Vector3d>> choice;
  for (const Eigen::Vector3d& q : randomPoses(kChoice * count, options.torque_tilt, seed)) {
    const auto per_ampere = torquePerAmpere(curve, geometry, rotorOrientation(joints, q));
    choice.emplace_back(per_ampere.col(place).norm(), q);
  }
  std::sort(
      choice.begin(), choice.end(), [](const auto& a, const auto& b) { return a.first > b.first; });
  std::vector<Eigen::Vector3d> poses;
  for (std::size_t n = 0; n < count; ++n) {
    poses.push_back(choice[n].second);
  }
  return poses;
}

/// A further sample, at a pose; what was measured there is for the caller to add.
Sample& addSample(std::vector<Sample>& samples, const Eigen::Vector3d& q) {
  Sample& sample = samples.emplace_back();
  sample.id = static_cast<std::uint32_t>(samples.size());
  sample.joint_position = q;
  return sample;
}

std::vector<Sample> orientationSamples(const PaperStudyOptions& options,
                                       const std::vector<Eigen::Vector3d>& poses,
                                       double noise,
                                       std::uint64_t seed) {
  NoiseSource random(seed, RandomPurpose::kStudyNoise);
  const JointGeometry joints = jointGeometry(options.truth.joints);
  std::vector<Sample> samples;
  samples.reserve(poses.size());
  for (const Eigen::Vector3d& q : poses) {
    Sample& sample = addSample(samples, q);
    sample.has_orientation = true;
    const Eigen::Matrix3d turn = rotationExp(random.uniformVector(noise));
    const Eigen::Matrix3d R_stator_rotor = rotorOrientation(joints, q);
    const bool is_left = options.noise_side == PaperStudyOptions::NoiseSide::kStator;
    sample.R_stator_rotor = is_left ? turn * R_stator_rotor : R_stator_rotor * turn;
    sample.orientation_stddev = uniformStddev(options.orientation_noise);
  }
  return samples;
}

std::vector<Sample> torqueSamples(const PaperStudyOptions& options,
                                  const std::vector<Eigen::Vector3d>& poses,
                                  std::size_t coil,
                                  double noise,
                                  std::uint64_t seed) {
  NoiseSource random(seed, RandomPurpose::kStudyNoise);
  const JointGeometry joints = jointGeometry(options.truth.joints);
  const TorqueGeometry geometry = torqueGeometry(options.truth);
  const TorqueCurve curve(*options.truth.torque_curve);
  std::vector<Sample> samples;
  samples.reserve(poses.size());
  for (const Eigen::Vector3d& q : poses) {
    Sample& sample = addSample(samples, q);
    sample.has_torque = true;
    sample.current = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(options.truth.coils.size()));
    sample.current[static_cast<Eigen::Index>(coil)] = options.current;
    sample.torque = rotorTorque(curve, geometry, rotorOrientation(joints, q), sample.current) +
                    random.uniformVector(noise);
    sample.torque_stddev = uniformStddev(options.torque_noise);
  }
  return samples;
}

FreeAxes freeAxes(const Actuator& actuator) {
  const JointGeometry joints = jointGeometry(actuator.joints);
  return {joints.axes, joints.offsets};
}

std::vector<double> axisDeviations(const FreeAxisPath& path, const FreeAxes& truth) {
  std::vector<double> deviations;
  for (const FreeAxes& joints : path.joints) {
    deviations.push_back((joints.axes - truth.axes).cwiseAbs().maxCoeff());
  }
  return deviations;
}

std::vector<double> offsetDeviations(const FreeAxisPath& path, const FreeAxes& truth) {
  std::vector<double> deviations;
  for (const FreeAxes& joints : path.joints) {
    deviations.push_back((joints.offsets - truth.offsets).cwiseAbs().maxCoeff());
  }
  return deviations;
}

double meanError(const JointGeometry& joints,
                 const JointGeometry& truth,
                 const std::vector<Eigen::Vector3d>& poses) {
  double sum = 0.0;
  for (const Eigen::Vector3d& q : poses) {
    sum += rotationLog(rotorOrientation(joints, q) * rotorOrientation(truth, q).transpose()).norm();
  }
  return sum / static_cast<double>(poses.size());
}

/// True and exactly known: the joints, and for situation 2 the poles as well.
CalibrationState startOf(const ParameterSpace& space, const Actuator& truth, Situation situation) {
  CalibrationState state = nominalState(space, ManufacturingTolerance());
  const Eigen::Index known = situation == Situation::kCoil ? space.coil(0) : space.pole(0);
  state.belief.x.head(known) = space.coordinatesOf(truth).head(known);
  state.belief.covariance.topLeftCorner(known, known).setZero();
  for (Eigen::Index k = 0; k < known; ++k) {
    state.identified[static_cast<std::size_t>(k)] = true;
  }
  return state;
}

CycleRequest requestOf(Situation situation) {
  return situation == Situation::kCoil ? CycleRequest{Cycle::kCoil, 1}
                                       : CycleRequest{Cycle::kPoles, 0};
}

std::vector<Eigen::Vector3d> plannedPoses(const PaperStudyOptions& options,
                                          const CalibrationModel& model,
                                          Situation situation,
                                          std::size_t count) {
  const std::vector<Sample> none;
  PlanningProblem problem;
  problem.model = &model;
  problem.held = &none;
  // What the situation takes as known is so for the plan, too, though by its drawing.
  problem.state = startOf(model.space(), options.nominal, situation);
  problem.request = requestOf(situation);
  problem.estimation = options.estimation;
  PosePlanOptions plan_options;
  plan_options.max_poses = count;
  plan_options.current = options.current;
  plan_options.tilt_limit = options.torque_tilt;
  // What the paper asks about is the error of a set as a whole, not of its worst parameter.
  plan_options.criterion = PlanCriterion::kInformation;
  plan_options.torque_stddev = uniformStddev(options.torque_noise);
  const PosePlan plan = planPoses(problem, plan_options);
  std::vector<Eigen::Vector3d> poses;
  for (const PlannedPose& pose : plan.poses) {
    poses.push_back(pose.joint_position);
  }
  return poses;
}

LevelTwoRun judge(const CalibrationModel& model,
                  const PaperStudyOptions& options,
                  const CycleOutcome& outcome) {
  const Eigen::VectorXd truth = model.space().coordinatesOf(options.truth);
  const Eigen::VectorXd nominal = model.space().coordinatesOf(options.nominal);
  LevelTwoRun run;
  run.errors = outcome.report.error_history;
  run.estimates = outcome.report.estimates;
  run.observable = outcome.report.success;
  for (const ParameterEstimate& estimate : outcome.report.estimates) {
    run.observable = run.observable && estimate.observable;
  }
  for (std::size_t p = 0; p < outcome.state.identified.size(); ++p) {
    const auto i = static_cast<Eigen::Index>(p);
    const double assigned = std::abs(truth[i] - nominal[i]);
    if (outcome.state.identified[p] && i >= model.space().pole(0) && assigned > 0.0) {
      const double error = std::abs(outcome.state.belief.x[i] - truth[i]);
      run.largest_error = std::max(run.largest_error, error);
      run.largest_share = std::max(run.largest_share, error / assigned);
    }
  }
  return run;
}

}  // namespace

void validate(const PaperStudyOptions& options) {
  validate(options.nominal);
  validate(options.truth);
  requireSameDesign(options.nominal, options.truth);
  if (!options.nominal.hasTorqueModel() || options.nominal.coils.size() < 2) {
    throw ConfigError("The study needs an actuator with poles, a torque curve and two coils.");
  }
  constexpr double kMostSeeds = 1e6;
  requireInRange("seeds", static_cast<double>(options.seeds), ValueRange::closed(1.0, kMostSeeds));
  requireInRange("joint tilt", options.joint_tilt, ValueRange::positive("rad"));
  requireInRange("torque tilt", options.torque_tilt, ValueRange::positive("rad"));
  requireInRange("orientation noise", options.orientation_noise, ValueRange::positive("rad"));
  requireInRange("torque noise", options.torque_noise, ValueRange::positive("N m"));
  requireInRange("current", options.current, ValueRange::positive("A"));
  validate(options.estimation);
}

std::vector<LevelOneRun> studyLevelOne(const PaperStudyOptions& options, std::size_t orientations) {
  const CalibrationModel model{ParameterSpace(options.nominal)};
  const CalibrationState start = nominalState(model.space(), ManufacturingTolerance());
  const FreeAxes nominal = freeAxes(options.nominal);
  const FreeAxes truth = freeAxes(options.truth);
  std::vector<LevelOneRun> runs;
  for (std::uint64_t seed = 1; seed <= options.seeds; ++seed) {
    const std::vector<Sample> samples =
        orientationSamples(options, randomPoses(orientations, options.joint_tilt, seed), 0.0, seed);
    LevelOneRun& run = runs.emplace_back();
    run.errors =
        runCycle(model, samples, start, withoutExpectedErrors({Cycle::kJoint}), options.estimation)
            .report.error_history;
    const FreeAxisPath newton =
        calibrateFreeAxes(samples, nominal, JacobianUse::kEveryIteration, kPaperIterations);
    const FreeAxisPath chord =
        calibrateFreeAxes(samples, nominal, JacobianUse::kOnce, kPaperIterations);
    run.axis_deviation_newton = axisDeviations(newton, truth);
    run.axis_deviation_chord = axisDeviations(chord, truth);
    run.offset_deviation_chord = offsetDeviations(chord, truth);
    run.errors_chord = chord.errors;
    run.chord = chord.joints;
  }
  return runs;
}

std::vector<LevelOneNoiseRun> studyLevelOneNoise(const PaperStudyOptions& options,
                                                 std::size_t orientations) {
  const CalibrationModel model{ParameterSpace(options.nominal)};
  const CalibrationState start = nominalState(model.space(), ManufacturingTolerance());
  const JointGeometry truth = jointGeometry(options.truth.joints);
  constexpr std::uint64_t kJudgeSeed = 0;
  const std::vector<Eigen::Vector3d> judges = randomPoses(kJudges, options.joint_tilt, kJudgeSeed);
  std::vector<LevelOneNoiseRun> runs;
  for (std::uint64_t seed = 1; seed <= options.seeds; ++seed) {
    const std::vector<Eigen::Vector3d> poses = randomPoses(orientations, options.joint_tilt, seed);
    const std::vector<Sample> samples =
        orientationSamples(options, poses, options.orientation_noise, seed);
    LevelOneNoiseRun& run = runs.emplace_back();
    for (const Sample& sample : samples) {
      run.added_noise += rotationLog(sample.R_stator_rotor *
                                     rotorOrientation(truth, sample.joint_position).transpose())
                             .norm() /
                         static_cast<double>(orientations);
    }
    run.paper_error =
        calibrateFreeAxes(
            samples, freeAxes(options.nominal), JacobianUse::kEveryIteration, kPaperIterations)
            .errors.back();
    const CycleOutcome outcome =
        runCycle(model, samples, start, withoutExpectedErrors({Cycle::kJoint}), options.estimation);
    const bool is_done = outcome.report.success && !outcome.report.error_history.empty();
    run.error =
        is_done ? outcome.report.error_history.back() : std::numeric_limits<double>::infinity();
    run.true_error = meanError(
        jointGeometry(model.space().actuatorAt(outcome.state.belief.x).joints), truth, judges);
  }
  return runs;
}

std::vector<LevelTwoRun> studyLevelTwo(const PaperStudyOptions& options,
                                       Situation situation,
                                       Orientations orientations,
                                       std::size_t measurements,
                                       bool noise) {
  const CalibrationModel model{ParameterSpace(options.nominal)};
  const CalibrationState start = startOf(model.space(), options.truth, situation);
  const CycleRequest request = withoutExpectedErrors(requestOf(situation));
  std::vector<Eigen::Vector3d> poses;
  if (orientations == Orientations::kPlanned) {
    poses = plannedPoses(options, model, situation, measurements);
  }
  std::vector<LevelTwoRun> runs;
  for (std::uint64_t seed = 1; seed <= options.seeds; ++seed) {
    if (orientations == Orientations::kRandom) {
      poses = randomPoses(measurements, options.torque_tilt, seed);
    } else if (orientations == Orientations::kLargeTorque) {
      poses = largeTorquePoses(options, request.coil.value(), measurements, seed);
    }
    const std::vector<Sample> samples = torqueSamples(
        options, poses, request.coil.value(), noise ? options.torque_noise : 0.0, seed);
    runs.push_back(
        judge(model, options, runCycle(model, samples, start, request, options.estimation)));
  }
  return runs;
}

}  // namespace sac
