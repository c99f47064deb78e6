#pragma once

#include <cstdint>
#include <random>
#include <vector>

#include <Eigen/Core>

#include "spherical_actuator_calibration/actuator/actuator.hpp"
#include "spherical_actuator_calibration/actuator/orientation_map.hpp"
#include "spherical_actuator_calibration/estimation/calibration_state.hpp"
#include "spherical_actuator_calibration/measurement/sample.hpp"

/// Actuators, poses and samples with a known truth. Every random number comes from a seeded
/// generator.
namespace sac::scenarios {

using Generator = std::mt19937_64;

/// The paper's actuator as drawn: 8 poles, 24 coils in two layers, its torque curve.
Actuator paperNominal();

/// The paper's actuator as made: joints with the errors of its Table 3 (axes normalised), poles and
/// coil 1 as in Table 5, coil 2 of situation 2; the other coils as drawn.
Actuator paperTruth();

/// A truth with errors uniform within ± the given bounds [rad] on every parameter.
Actuator perturbed(const Actuator& nominal, double joints, double axes, Generator& generator);

/// Joint angles uniform within ±tilt for joints 1 and 2, ±π for joint 3 [rad].
Eigen::Vector3d randomPose(double tilt, Generator& generator);

std::vector<Eigen::Vector3d> randomPoses(std::size_t count, double tilt, Generator& generator);

/// Poses of which each pole is seen by coil `coil` (from 0): within its curve's polynomial range.
std::vector<Eigen::Vector3d> posesThatSeeEveryPole(const Actuator& actuator,
                                                   std::size_t coil,
                                                   std::size_t count,
                                                   double tilt,
                                                   Generator& generator);

/// Poles that lie within the support of the curve of coil `coil` in some pose.
std::vector<bool> polesSeen(const Actuator& actuator,
                            std::size_t coil,
                            const std::vector<Eigen::Vector3d>& poses);

/// Noise uniform within ± `half_width` per component; its standard deviation is half_width/√3.
Eigen::Vector3d uniformNoise(double half_width, Generator& generator);
double uniformStddev(double half_width);

/// Orientation samples of the truth with uniform noise of `noise` [rad]; the stated standard
/// deviation is `stddev` [rad].
std::vector<Sample> orientationSamples(const Actuator& truth,
                                       const std::vector<Eigen::Vector3d>& poses,
                                       double noise,
                                       double stddev,
                                       Generator& generator);

/// Torque samples with only `coil` (from 0) at `current` [A], uniform noise of `noise` [N·m].
std::vector<Sample> torqueSamples(const Actuator& truth,
                                  const std::vector<Eigen::Vector3d>& poses,
                                  std::size_t coil,
                                  double current,
                                  double noise,
                                  double stddev,
                                  Generator& generator);

/// One torque sample with the given currents [A] in as many randomly chosen coils and the noise of
/// the paper's session.
Sample mixedTorqueSample(const Actuator& truth,
                         const Eigen::Vector3d& q,
                         const std::vector<double>& currents,
                         Generator& generator);

/// When the orientation tracker measures during a session.
enum class Tracker { kFirstTenPoses, kEveryPose };

/// The paper's protocol within tilt ±0.3 rad: 10 poses for the joint, 30 with coil 1, 4 with each
/// other coil, at 2 A; orientation noise uniform ±1 mrad, torque noise uniform ±0.5 mN·m per
/// component. Ids count from 1.
std::vector<Sample> paperSession(const Actuator& truth, Tracker tracker, Generator& generator);

/// That session with the tracker at every pose; every tenth sample is held out.
std::vector<Sample> heldOutSession();

/// The same numbers of samples at random poses, whether the coils reach a pole there or not.
std::vector<Sample> randomSession(const Actuator& truth, Generator& generator);

/// The shipped rotor without joints: 8 poles, 20 coils.
Actuator reactionSphere();

/// Torques of so many coils, each alone at 2 A, at poses within ±0.5 rad of tilt. The tracker, with
/// normal noise of `orientation` [rad], measures each pose once: its samples share the orientation.
/// Torques have normal noise of `torque` [N·m]; both are stated. Ids count from 1.
std::vector<Sample> levitatedSession(const Actuator& truth,
                                     std::size_t poses,
                                     std::size_t coils_per_pose,
                                     double orientation,
                                     double torque,
                                     Generator& generator);

/// State of an actuator whose joints are known exactly and the rest is nominal: what the paper
/// assumes before level 2.
CalibrationState exactJoints(const ParameterSpace& space,
                             const Actuator& truth,
                             const ManufacturingTolerance& tolerance);

/// What axes leave of a machine's orientations, as found at twelve poses.
OrientationMapDescription orientationMap();

}  // namespace sac::scenarios
