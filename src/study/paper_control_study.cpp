#include "spherical_actuator_calibration/study/paper_control_study.hpp"

#include <algorithm>
#include <cmath>

#include "spherical_actuator_calibration/base/error.hpp"
#include "spherical_actuator_calibration/base/noise_source.hpp"
#include "spherical_actuator_calibration/base/pi.hpp"
#include "spherical_actuator_calibration/base/random_purpose.hpp"
#include "spherical_actuator_calibration/base/rotations.hpp"
#include "spherical_actuator_calibration/calibration/calibration_session.hpp"
#include "spherical_actuator_calibration/calibration/cycle_selection.hpp"
#include "spherical_actuator_calibration/emulation/sample_simulation.hpp"
#include "spherical_actuator_calibration/measurement/session_plan.hpp"
#include "spherical_actuator_calibration/measurement/torque_pose_sampler.hpp"

namespace sac {
namespace {

constexpr double kSpeed = kPi / 48.0;  // [rad/s]

/// Parameters after each stage of a session.
struct Calibrated {
  Actuator sequential;
  Actuator refined;
};

Calibrated calibrated(const PaperStudyOptions& options, std::uint64_t seed) {
  SessionPlanOptions plan;
  plan.validation_poses = 0;
  plan.current = options.current;
  plan.torque_tilt_share = options.torque_tilt / options.nominal.workspace.tilt_limit;
  plan.joint_tilt_share = plan.torque_tilt_share;
  SampleNoise noise;
  noise.orientation = options.orientation_noise / std::sqrt(3.0);
  noise.torque = options.torque_noise / std::sqrt(3.0);
  const std::vector<Sample> samples = simulateSamples(options.truth,
                                                      planSession(options.nominal, plan, seed),
                                                      TrackerUse::kPosesWithoutCurrent,
                                                      noise,
                                                      seed);
  CalibrationConfig config;
  config.estimation = options.estimation;
  CalibrationSession session({options.nominal}, samples, config);
  const auto run = [&](const CycleRequest& request) {
    const CycleReport report = session.run(withoutExpectedErrors(request));
    if (!report.success) {
      throw DataError("A session of the study failed: " + report.message);
    }
  };
  const CalibrationModel& model = session.model();
  for (const CycleRequest& request : possibleCycles(model, samples, options.estimation)) {
    if (request.cycle != Cycle::kRefine) {
      run(request);
    }
  }
  Calibrated result;
  result.sequential = model.space().actuatorAt(session.state().belief.x);
  run({Cycle::kRefine});
  result.refined = model.space().actuatorAt(session.state().belief.x);
  return result;
}

}  // namespace

DesiredMotion paperTrajectory(double time) {
  DesiredMotion desired;
  desired.R_stator_rotor = rotationExp({kSpeed * time, 0.0, 0.0});
  desired.angular_velocity = Eigen::Vector3d(kSpeed, 0.0, 0.0);
  return desired;
}

Actuator levelOneActuator(const Actuator& nominal, const Actuator& truth) {
  Actuator actuator = nominal;
  actuator.joints = truth.joints;
  return actuator;
}

std::vector<ControlRun> studyControl(const PaperStudyOptions& options,
                                     const Eigen::Vector3d& load) {
  validate(options);
  const std::pair<const char*, Actuator> models[] = {
      {"nominal", options.nominal},
      {"level_1", levelOneActuator(options.nominal, options.truth)},
      {"both_levels", options.truth}};
  std::vector<ControlRun> runs;
  for (const bool loaded : {false, true}) {
    for (const auto& [name, model] : models) {
      ClosedLoopOptions loop;
      loop.truth = options.truth;
      loop.model = model;
      loop.rotor.unbalance = loaded ? load : Eigen::Vector3d(Eigen::Vector3d::Zero());
      runs.push_back({name, loaded, simulateClosedLoop(loop, paperTrajectory)});
    }
  }
  return runs;
}

std::vector<TorqueErrorRun> studyTorqueErrors(const PaperStudyOptions& options,
                                              std::uint64_t sessions,
                                              std::size_t poses,
                                              double tilt) {
  validate(options);
  NoiseSource random(1, RandomPurpose::kStudyOrientations);
  std::vector<Eigen::Vector3d> places(poses);
  std::generate(places.begin(), places.end(), [&] { return randomPose(tilt, random); });
  const auto errors_of = [&](const Actuator& model) {
    return torqueMatrixErrors(options.truth, model, places);
  };
  std::vector<TorqueErrorRun> runs = {
      {"nominal", errors_of(options.nominal)},
      {"level_1", errors_of(levelOneActuator(options.nominal, options.truth))},
      {"sequential", {}},
      {"refined", {}}};
  const auto append = [](std::vector<TorqueMatrixError>& to,
                         const std::vector<TorqueMatrixError>& more) {
    to.insert(to.end(), more.begin(), more.end());
  };
  for (std::uint64_t seed = 1; seed <= sessions; ++seed) {
    const Calibrated parameters = calibrated(options, seed);
    append(runs[2].poses, errors_of(parameters.sequential));
    append(runs[3].poses, errors_of(parameters.refined));
  }
  return runs;
}

}  // namespace sac
