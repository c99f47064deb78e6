#include <exception>
#include <memory>
#include <vector>

#include "spherical_actuator_calibration/base/error.hpp"
#include "spherical_actuator_calibration/base/numbering.hpp"
#include "spherical_actuator_calibration/base/printable_text.hpp"
#include "spherical_actuator_calibration/planning/planning_problem.hpp"
#include "spherical_actuator_calibration/planning/pose_planner.hpp"
#include "spherical_actuator_calibration/planning/time_budget.hpp"
#include "spherical_actuator_calibration/ros/calibration_node/calibration_node.hpp"
#include "spherical_actuator_calibration/ros/conversion/plan_conversion.hpp"

namespace sac {
namespace {

/// The cycle that a plan is asked for; the refinement where none is named.
CycleRequest plannedCycle(const msg::PlanPoses::Request& request) {
  for (const Cycle cycle : {Cycle::kJoint, Cycle::kPoles, Cycle::kCoil, Cycle::kRefine}) {
    const bool needs_coil = cycle == Cycle::kPoles || cycle == Cycle::kCoil;
    if (request.cycle == cycleName(cycle) || (request.cycle.empty() && cycle == Cycle::kRefine)) {
      return {cycle, needs_coil ? indexOf(request.coil) : std::nullopt};
    }
  }
  throw ConfigError("cycle: " + request.cycle + " is none; joint, poles, coil and refine are.");
}

}  // namespace

// Planning takes seconds: it works on a copy, so that nothing waits for it.
bool CalibrationNode::planPoses(msg::PlanPoses::Request& request,
                                msg::PlanPoses::Response& response) {
  try {
    PosePlanOptions plan_options = planOptionsFromRos(request);
    plan_options.is_time_up = timeIsUpAfter(request.time_budget);
    PlanningProblem problem;
    problem.request = plannedCycle(request);
    std::vector<Sample> held;
    {
      const std::lock_guard<std::mutex> lock(session_mutex_);
      const CalibrationSession& calibration = session_.calibration();
      // The model never changes while the node runs.
      problem.model = &calibration.model();
      problem.state = calibration.state();
      problem.estimation = calibration.config().estimation;
      held = calibration.samples();
      plan_options.start =
          held.empty() ? Eigen::Vector3d(Eigen::Vector3d::Zero()) : held.back().joint_position;
    }
    problem.held = &held;
    const PosePlan plan = sac::planPoses(problem, plan_options);
    response = planToRos(plan, plan_options.current, problem.model->space().coils());
    const std::lock_guard<std::mutex> lock(session_mutex_);
    plan_ = std::make_shared<const std::vector<PlannedPose>>(plan.poses);
    publishStatus();
  } catch (const std::exception& error) {
    response.success = 0;
    response.message = printable(error.what());
  }
  return true;
}

}  // namespace sac
