#pragma once

#include <numeric>
#include <vector>

#include <Eigen/Core>

#include <gtest/gtest.h>

#include "pose_candidates.hpp"
#include "spherical_actuator_calibration/estimation/sample_prediction.hpp"
#include "spherical_actuator_calibration/planning/planning_problem.hpp"
#include "spherical_actuator_calibration/planning/pose_planner.hpp"
#include "spherical_actuator_calibration/study/cramer_rao_bound.hpp"
#include "support/scenarios.hpp"

namespace sac {

inline constexpr double kTilt = 0.3;  // [rad]

/// The paper's actuator, not calibrated, and no samples: the least that a plan can start from.
class PlanningFixture : public ::testing::Test {
 protected:
  PlanningFixture() {
    problem_.model = &model_;
    problem_.held = &held_;
    problem_.state = nominalState(model_.space(), {});
    options_.tilt_limit = kTilt;
  }

  std::vector<Eigen::Index> allCoordinates() const {
    std::vector<Eigen::Index> all(static_cast<std::size_t>(model_.space().size()));
    std::iota(all.begin(), all.end(), 0);
    return all;
  }

  /// Bound of the standard deviations of all parameters [rad].
  Eigen::VectorXd boundOf(const std::vector<Sample>& samples) const {
    const Eigen::VectorXd& x = problem_.state.belief.x;
    return model_.space().reportedStddevs(
        x, cramerRaoBound(model_, samples, {Cycle::kRefine}, allCoordinates(), x));
  }

  /// The samples that a plan asks for.
  std::vector<Sample> samplesOf(const PosePlan& plan) const {
    std::vector<Sample> samples;
    for (const PlannedPose& pose : plan.poses) {
      for (const Sample& sample :
           visitSamples(problem_, options_, pose.joint_position, pose.excitations())) {
        samples.push_back(sample);
        predictMeasurements({model_, problem_.state.belief.x}, samples.back());
      }
    }
    return samples;
  }

  Actuator nominal_ = scenarios::paperNominal();
  CalibrationModel model_{ParameterSpace(nominal_)};
  std::vector<Sample> held_;
  PlanningProblem problem_;
  PosePlanOptions options_;
};

}  // namespace sac
