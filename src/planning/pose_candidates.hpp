#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include <Eigen/Core>

#include "spherical_actuator_calibration/estimation/whitened_observation.hpp"

namespace sac {

struct PlanningProblem;
struct PosePlanOptions;
struct Sample;
struct SignedCoil;

/// Errors of a pose's readings that all of its measurements share, in standard deviations: of the
/// joints' sensors, or without joints of the tracker about x, y and z.
inline constexpr Eigen::Index kPoseErrors = 3;

/// One pose that could be visited, and what could be observed there.
struct PoseCandidate {
  Eigen::Vector3d joint_position = Eigen::Vector3d::Zero();      ///< [rad]
  Eigen::Matrix3d R_stator_rotor = Eigen::Matrix3d::Identity();  ///< at the belief
  std::optional<WhitenedObservation> orientation;                ///< in the coordinates to estimate
  std::vector<std::size_t> coils;            ///< that may be excited here, counted from 0
  std::vector<WhitenedObservation> torques;  ///< along with `coils`, each alone at +current

  /// For patterns only: derivatives by the coordinates to estimate, and by kPoseErrors behind them,
  /// in standard deviations of the tracker and of the torque sensor. Those of `coils` add up, with
  /// the signs of the pattern.
  std::optional<WhitenedObservation> tracked;    ///< the orientation
  std::vector<WhitenedObservation> terms;        ///< along with `coils`
  std::optional<WhitenedObservation> unexcited;  ///< what effects add whatever the currents are
};

/// Whether the orientations of two poses are at least `spacing` [rad] apart.
bool areApart(const PoseCandidate& one, const PoseCandidate& other, double spacing);

/// Coordinates that a plan is to determine: all for kRefine (without poles and coils where there is
/// no torque model), else those of the cycle.
std::vector<Eigen::Index> plannedCoordinates(const PlanningProblem& problem);

/// Information matrix of these coordinates in the samples that are held already, F×F.
Eigen::MatrixXd heldInformation(const PlanningProblem& problem,
                                const std::vector<Eigen::Index>& coordinates);

/// The samples that one visit gives, without values: one with the orientation where that is
/// measured, and one with a torque for each CoilPattern.
std::vector<Sample> visitSamples(const PlanningProblem& problem,
                                 const PosePlanOptions& options,
                                 const Eigen::Vector3d& joint_position,
                                 const std::vector<std::vector<SignedCoil>>& patterns);

/// Whether patterns of several coils are planned: only the joint cycle takes them.
bool plansPatterns(const PlanningProblem& problem, const PosePlanOptions& options);

/// Coils of a pattern: as many as the sum of currents allows, at least one.
std::size_t coilsPerPattern(const PosePlanOptions& options);

/// Draws poses inside the limits at which something useful can be observed. A coil may be excited
/// where a pole lies on the steep part of the curve and none where the curve is uncertain.
std::vector<PoseCandidate> drawCandidates(const PlanningProblem& problem,
                                          const PosePlanOptions& options,
                                          const std::vector<Eigen::Index>& coordinates);

}  // namespace sac
