#pragma once

#include <vector>

#include <Eigen/Core>

#include "spherical_actuator_calibration/calibration/calibration_report.hpp"
#include "spherical_actuator_calibration/estimation/calibration_state.hpp"
#include "spherical_actuator_calibration/estimation/estimation_problem.hpp"
#include "spherical_actuator_calibration/estimation/parameter_space.hpp"

namespace sac {

/// What a cycle `motion` told, for refinements after it: no sample had a part in it.
struct MotionEvidence {
  ParameterBelief belief;          ///< after the motion
  std::vector<Eigen::Index> told;  ///< coordinates that it identified, ascending
  Eigen::MatrixXd covariance;      ///< of all coordinates before any cycle, in their units
};

/// The evidence of a successful cycle `motion`: its report and the state after it. `start`: the
/// state before any cycle.
MotionEvidence motionEvidence(const ParameterSpace& space,
                              const CycleReport& report,
                              const CalibrationState& state,
                              const CalibrationState& start);

/// A belief that has forgotten what the motion told: where a refinement starts, so that nothing
/// counts twice. The values stay.
ParameterBelief withoutMotion(ParameterBelief belief, const MotionEvidence& motion);

/// What a motion told by itself, in all coordinates: Λ, and Λx of the values that it told.
struct MotionInformation {
  Eigen::MatrixXd information;
  Eigen::VectorXd vector;
};
MotionInformation ownInformation(const ParameterSpace& space, const MotionEvidence& motion);

/// Two independent beliefs in one.
struct CombinedBelief {
  ParameterBelief belief;
  /// With which values at least so far apart come by chance: chi-square of their difference.
  double probability = 1.0;
};

/// A belief that samples made, and that of a motion, as the one problem of both would have it to
/// first order (doc/method.md, Motion and samples). What is stated of an effect beforehand counts
/// once.
CombinedBelief combined(const ParameterSpace& space,
                        const ParameterBelief& by_samples,
                        const MotionEvidence& motion);

}  // namespace sac
