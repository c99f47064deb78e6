#include <algorithm>
#include <cstdio>
#include <iostream>
#include <iterator>
#include <string>
#include <utility>
#include <vector>

#include "plan_session_options.hpp"
#include "spherical_actuator_calibration/base/error.hpp"
#include "spherical_actuator_calibration/base/numbering.hpp"
#include "spherical_actuator_calibration/base/version.hpp"
#include "spherical_actuator_calibration/calibration/calibration_session.hpp"
#include "spherical_actuator_calibration/calibration/cycle_selection.hpp"
#include "spherical_actuator_calibration/measurement/sample_file.hpp"
#include "spherical_actuator_calibration/planning/pose_planner.hpp"
#include "spherical_actuator_calibration/planning/session_plan_file.hpp"
#include "spherical_actuator_calibration/planning/session_plan_record.hpp"
#include "spherical_actuator_calibration/planning/time_budget.hpp"
#include "spherical_actuator_calibration/ros/recording/recording_reader.hpp"
#include "tool_main.hpp"

namespace sac {
namespace {

/// Samples measured already, of all files.
std::vector<Sample> heldSamples(const PlanSessionOptions& options,
                                const Actuator& actuator,
                                const CalibrationConfig& config) {
  std::vector<Sample> samples;
  if (!options.bags.empty()) {
    RecordingOptions reading;
    reading.ns = options.ns;
    reading.frames = config.frames;
    reading.samples = config.samples;
    samples = readRecordings(options.bags, actuator, reading).samples;
  }
  if (options.samples_path) {
    std::vector<Sample> more =
        loadSamples(*options.samples_path, actuator.coils.size(), actuator.has_joints);
    samples.insert(
        samples.end(), std::make_move_iterator(more.begin()), std::make_move_iterator(more.end()));
    for (std::size_t n = 0; n < samples.size(); ++n) {
      samples[n].id = static_cast<std::uint32_t>(n + 1);
    }
  }
  return samples;
}

/// Parameters that the samples held give, as far as they do.
CalibrationState stateFrom(CalibrationSession& session) {
  for (const CycleRequest& request :
       possibleCycles(session.model(), session.samples(), session.config().estimation)) {
    session.run(withoutExpectedErrors(request));
  }
  return session.state();
}

/// The cycles that come before the planned one will have been run by then; those that were not yet
/// count as exact.
void assumeEarlierCycles(const CalibrationModel& model,
                         const CycleRequest& request,
                         CalibrationState& state) {
  if (request.cycle != Cycle::kPoles && request.cycle != Cycle::kCoil) {
    return;
  }
  const ParameterSpace& space = model.space();
  const Eigen::Index last = request.cycle == Cycle::kPoles ? space.pole(0) : space.coil(0);
  for (Eigen::Index p = 0; p < last; ++p) {
    const auto place = static_cast<std::size_t>(p);
    if (!state.identified[place]) {
      state.identified[place] = true;
      state.belief.covariance.row(p).setZero();
      state.belief.covariance.col(p).setZero();
    }
  }
}

SessionPlanRecord recordOf(const PlanSessionOptions& options,
                           const Actuator& actuator,
                           std::size_t samples_held,
                           PosePlan plan) {
  SessionPlanRecord record;
  record.actuator = actuator.name;
  record.serial = actuator.serial;
  record.software = packageVersion();
  record.cycle = cycleText(options.cycle);
  record.current = options.plan.current;
  record.tracker_on = options.plan.tracker_on;
  record.joint_stddev = options.plan.joint_stddev;
  record.orientation_stddev = options.plan.orientation_stddev;
  record.torque_stddev = options.plan.torque_stddev;
  record.samples_held = samples_held;
  record.plan = std::move(plan);
  return record;
}

void printPlan(const PosePlan& plan, bool has_joints) {
  const char* const angles = has_joints ? "joints" : "turn about x, y, z";
  for (std::size_t n = 0; n < plan.poses.size(); ++n) {
    const PlannedPose& pose = plan.poses[n];
    const Eigen::Vector3d& q = pose.joint_position;
    std::printf("%3zu  %s %7.3f %7.3f %7.3f rad  coils", n + 1, angles, q[0], q[1], q[2]);
    if (pose.patterns.empty()) {
      for (const std::size_t coil : pose.coils) {
        std::printf(" %zu", numberOf(coil));
      }
    }
    for (const CoilPattern& pattern : pose.patterns) {
      std::printf(" (%s)", patternText(pattern).c_str());
    }
    std::printf("%s\n", pose.coils.empty() ? " none" : "");
  }
  const std::ptrdiff_t open = std::count_if(
      plan.expected.begin(), plan.expected.end(), [](const auto& e) { return !e.observable; });
  std::printf("%s\n%zu parameters, of which %td stay open; travel %.1f rad\n",
              plan.message.c_str(),
              plan.expected.size(),
              open,
              plan.travel);
}

/// Options of the plan, with the time budget from now on.
PosePlanOptions planOptions(const PlanSessionOptions& options) {
  PosePlanOptions result = options.plan;
  result.is_time_up = timeIsUpAfter(options.time_budget);
  return result;
}

void writePlan(const PlanSessionOptions& options) {
  requireNewFile(options.output_path, options.overwrite);
  const CalibrationConfig config =
      options.config_path ? loadCalibrationConfig(*options.config_path) : CalibrationConfig{};
  const CalibratedDescription start = loadDescription(options.actuator_path);
  CalibrationSession session(start, heldSamples(options, start.actuator, config), config);

  PlanningProblem problem;
  problem.model = &session.model();
  problem.held = &session.samples();
  problem.request = options.cycle;
  problem.estimation = session.config().estimation;
  problem.state = stateFrom(session);
  assumeEarlierCycles(session.model(), options.cycle, problem.state);
  PosePlan plan = planPoses(problem, planOptions(options));
  if (!plan.success) {
    throw DataError(plan.message);
  }
  printPlan(plan, start.actuator.has_joints);
  const SessionPlanRecord record =
      recordOf(options, start.actuator, session.samples().size(), std::move(plan));
  writeFileAtomically(options.output_path, renderSessionPlan(record), options.overwrite);
  std::printf("Plan: %s\n", options.output_path.c_str());
}

}  // namespace
}  // namespace sac

int main(int argc, char** argv) {
  return sac::runTool("plan_session", [&] {
    const auto options = sac::parsePlanSessionOptions(argc, argv, std::cout);
    if (options) {
      sac::writePlan(*options);
    }
    return sac::kToolSuccess;
  });
}
