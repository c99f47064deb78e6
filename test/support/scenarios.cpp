#include "support/scenarios.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "spherical_actuator_calibration/actuator/description_file.hpp"
#include "spherical_actuator_calibration/actuator/spherical_joint.hpp"
#include "spherical_actuator_calibration/actuator/torque_model.hpp"
#include "spherical_actuator_calibration/base/pi.hpp"
#include "spherical_actuator_calibration/base/rotations.hpp"
#include "support/source_dir.hpp"

namespace sac::scenarios {
namespace {

constexpr double kLayerElevation = 0.2618;
constexpr double kOrientationNoise = 1e-3;  // uniform, per component [rad]
constexpr double kTorqueNoise = 5e-4;       // uniform, per component [N·m]
constexpr double kTilt = 0.3;               // of a session [rad]
constexpr double kCurrent = 2.0;            // of a session [A]

/// Poses of a session with a coil (from 0) excited: many with coil 1, for the poles.
std::size_t torquePoses(std::size_t coil) {
  return coil == 0 ? 30 : 4;
}

double uniform(double half_width, Generator& generator) {
  return std::uniform_real_distribution<double>(-half_width, half_width)(generator);
}

}  // namespace

Actuator paperNominal() {
  Actuator actuator;
  actuator.name = "pm_spherical_8x24";
  actuator.serial = "unit-001";
  for (std::size_t k = 0; k < kJoints; ++k) {
    actuator.joints[k] = {
        "joint_" + std::to_string(k + 1), Eigen::Vector3d::Unit(static_cast<Eigen::Index>(k)), 0.0};
  }
  for (int i = 0; i < 8; ++i) {
    actuator.poles.push_back({0.0, i * kPi / 4.0, i % 2 == 0 ? 1 : -1, 1.0});
  }
  for (const double elevation : {kLayerElevation, -kLayerElevation}) {
    for (int j = 0; j < 12; ++j) {
      actuator.coils.push_back({elevation, j * kPi / 6.0, 1.0});
    }
  }
  actuator.torque_curve =
      TorqueCurveDescription{AngleUnit::kDegree,
                             {-5.40e-3, 5.18e-2, -3.73e-6, -4.2e-4, 2.39e-5, -5.07e-7, 3.78e-9},
                             2.0,
                             28.0,
                             32.0};
  actuator.workspace.tilt_limit = 0.6;
  return actuator;
}

Actuator paperTruth() {
  Actuator actuator = paperNominal();
  const Eigen::Vector3d axis_errors[] = {
      {-0.00062, -0.01570, 0.03141}, {0.01745, -0.00037, -0.02094}, {0.01571, 0.01047, -0.00018}};
  const double offset_errors[] = {0.0300, 0.0250, 0.0200};
  for (std::size_t k = 0; k < kJoints; ++k) {
    actuator.joints[k].axis = (actuator.joints[k].axis + axis_errors[k]).normalized();
    actuator.joints[k].offset += offset_errors[k];
  }
  const double polar[] = {0.0200, 0.0200, 0.0100, 0.0200, 0.0100, 0.0100, 0.0200, 0.0150};
  const double azimuth_errors[] = {0.0150, 0.0150, 0.0100, 0.0200, 0.0150, 0.0250, 0.0100, 0.0200};
  for (std::size_t i = 0; i < actuator.poles.size(); ++i) {
    actuator.poles[i].polar = polar[i];
    actuator.poles[i].azimuth += azimuth_errors[i];
  }
  actuator.coils[0].polar += 0.0200;
  actuator.coils[0].azimuth += 0.0200;
  actuator.coils[1].polar += 0.0150;
  actuator.coils[1].azimuth += 0.0200;
  return actuator;
}

Actuator perturbed(const Actuator& nominal, double joints, double axes, Generator& generator) {
  const ParameterSpace space(nominal);
  Eigen::VectorXd x(space.size());
  for (Eigen::Index p = 0; p < x.size(); ++p) {
    x[p] = uniform(p < space.pole(0) ? joints : axes, generator);
  }
  return space.actuatorAt(x);
}

Eigen::Vector3d randomPose(double tilt, Generator& generator) {
  const double q1 = uniform(tilt, generator);
  const double q2 = uniform(tilt, generator);
  return {q1, q2, uniform(kPi, generator)};
}

std::vector<Eigen::Vector3d> randomPoses(std::size_t count, double tilt, Generator& generator) {
  std::vector<Eigen::Vector3d> poses(count);
  std::generate(poses.begin(), poses.end(), [&] { return randomPose(tilt, generator); });
  return poses;
}

std::vector<Eigen::Vector3d> posesThatSeeEveryPole(const Actuator& actuator,
                                                   std::size_t coil,
                                                   std::size_t count,
                                                   double tilt,
                                                   Generator& generator) {
  constexpr double kNear = 4.0 * kOneDegree;
  constexpr double kFar = 24.0 * kOneDegree;
  const TorqueGeometry geometry = torqueGeometry(actuator);
  const JointGeometry joints = jointGeometry(actuator.joints);
  std::vector<Eigen::Vector3d> poses;
  while (poses.size() < count) {
    const auto pole = static_cast<Eigen::Index>(poses.size() % actuator.poles.size());
    const Eigen::Vector3d q = randomPose(tilt, generator);
    const Eigen::Vector3d coil_rotor = rotorOrientation(joints, q).transpose() *
                                       geometry.coils_stator.col(static_cast<Eigen::Index>(coil));
    const double psi = std::acos(coil_rotor.dot(geometry.poles_rotor.col(pole)));
    if (psi > kNear && psi < kFar) {
      poses.push_back(q);
    }
  }
  return poses;
}

std::vector<bool> polesSeen(const Actuator& actuator,
                            std::size_t coil,
                            const std::vector<Eigen::Vector3d>& poses) {
  const TorqueCurve curve(*actuator.torque_curve);
  const TorqueGeometry geometry = torqueGeometry(actuator);
  const JointGeometry joints = jointGeometry(actuator.joints);
  std::vector<bool> seen(actuator.poles.size(), false);
  for (const Eigen::Vector3d& q : poses) {
    const Eigen::Vector3d coil_rotor = rotorOrientation(joints, q).transpose() *
                                       geometry.coils_stator.col(static_cast<Eigen::Index>(coil));
    for (std::size_t i = 0; i < seen.size(); ++i) {
      seen[i] =
          seen[i] ||
          interacts(curve, geometry.poles_rotor.col(static_cast<Eigen::Index>(i)), coil_rotor);
    }
  }
  return seen;
}

Eigen::Vector3d uniformNoise(double half_width, Generator& generator) {
  Eigen::Vector3d noise;
  for (Eigen::Index c = 0; c < 3; ++c) {
    noise[c] = uniform(half_width, generator);
  }
  return noise;
}

double uniformStddev(double half_width) {
  return half_width / std::sqrt(3.0);
}

std::vector<Sample> orientationSamples(const Actuator& truth,
                                       const std::vector<Eigen::Vector3d>& poses,
                                       double noise,
                                       double stddev,
                                       Generator& generator) {
  const JointGeometry joints = jointGeometry(truth.joints);
  std::vector<Sample> samples;
  for (const Eigen::Vector3d& q : poses) {
    Sample sample;
    sample.id = static_cast<std::uint32_t>(samples.size() + 1);
    sample.joint_position = q;
    sample.has_orientation = true;
    sample.R_stator_rotor =
        rotationExp(uniformNoise(noise, generator)) * rotorOrientation(joints, q);
    sample.orientation_stddev = stddev;
    samples.push_back(sample);
  }
  return samples;
}

std::vector<Sample> torqueSamples(const Actuator& truth,
                                  const std::vector<Eigen::Vector3d>& poses,
                                  std::size_t coil,
                                  double current,
                                  double noise,
                                  double stddev,
                                  Generator& generator) {
  const TorqueCurve curve(*truth.torque_curve);
  const TorqueGeometry geometry = torqueGeometry(truth);
  const JointGeometry joints = jointGeometry(truth.joints);
  std::vector<Sample> samples;
  for (const Eigen::Vector3d& q : poses) {
    Sample sample;
    sample.id = static_cast<std::uint32_t>(samples.size() + 1);
    sample.joint_position = q;
    sample.has_torque = true;
    sample.current = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(truth.coils.size()));
    sample.current[static_cast<Eigen::Index>(coil)] = current;
    sample.torque = rotorTorque(curve, geometry, rotorOrientation(joints, q), sample.current) +
                    uniformNoise(noise, generator);
    sample.torque_stddev = stddev;
    samples.push_back(sample);
  }
  return samples;
}

Sample mixedTorqueSample(const Actuator& truth,
                         const Eigen::Vector3d& q,
                         const std::vector<double>& currents,
                         Generator& generator) {
  Sample sample =
      torqueSamples(truth, {q}, 0, 0.0, kTorqueNoise, uniformStddev(kTorqueNoise), generator)[0];
  std::uniform_int_distribution<Eigen::Index> coil(0, sample.current.size() - 1);
  for (const double current : currents) {
    sample.current[coil(generator)] = current;
  }
  sample.torque += rotorTorque(TorqueCurve(*truth.torque_curve),
                               torqueGeometry(truth),
                               rotorOrientation(jointGeometry(truth.joints), q),
                               sample.current);
  return sample;
}

std::vector<Sample> paperSession(const Actuator& truth, Tracker tracker, Generator& generator) {
  const double orientation_stddev = uniformStddev(kOrientationNoise);
  std::vector<Sample> samples = orientationSamples(
      truth, randomPoses(10, kTilt, generator), kOrientationNoise, orientation_stddev, generator);
  for (std::size_t coil = 0; coil < truth.coils.size(); ++coil) {
    const std::vector<Eigen::Vector3d> poses =
        posesThatSeeEveryPole(paperNominal(), coil, torquePoses(coil), kTilt, generator);
    std::vector<Sample> more = torqueSamples(
        truth, poses, coil, kCurrent, kTorqueNoise, uniformStddev(kTorqueNoise), generator);
    if (tracker == Tracker::kEveryPose) {
      const std::vector<Sample> tracked =
          orientationSamples(truth, poses, kOrientationNoise, orientation_stddev, generator);
      for (std::size_t n = 0; n < more.size(); ++n) {
        more[n].has_orientation = true;
        more[n].R_stator_rotor = tracked[n].R_stator_rotor;
        more[n].orientation_stddev = orientation_stddev;
      }
    }
    samples.insert(samples.end(), more.begin(), more.end());
  }
  for (std::size_t n = 0; n < samples.size(); ++n) {
    samples[n].id = static_cast<std::uint32_t>(n + 1);
  }
  return samples;
}

std::vector<Sample> heldOutSession() {
  Generator generator(4);
  std::vector<Sample> samples = paperSession(paperTruth(), Tracker::kEveryPose, generator);
  for (std::size_t n = 9; n < samples.size(); n += 10) {
    samples[n].validation = true;
  }
  return samples;
}

std::vector<Sample> randomSession(const Actuator& truth, Generator& generator) {
  std::vector<Sample> samples = orientationSamples(truth,
                                                   randomPoses(10, kTilt, generator),
                                                   kOrientationNoise,
                                                   uniformStddev(kOrientationNoise),
                                                   generator);
  for (std::size_t coil = 0; coil < truth.coils.size(); ++coil) {
    const std::vector<Sample> more = torqueSamples(truth,
                                                   randomPoses(torquePoses(coil), kTilt, generator),
                                                   coil,
                                                   kCurrent,
                                                   kTorqueNoise,
                                                   uniformStddev(kTorqueNoise),
                                                   generator);
    samples.insert(samples.end(), more.begin(), more.end());
  }
  return samples;
}

Actuator reactionSphere() {
  return loadActuator(SOURCE_DIR "/config/reaction_sphere.yaml");
}

std::vector<Sample> levitatedSession(const Actuator& truth,
                                     std::size_t poses,
                                     std::size_t coils_per_pose,
                                     double orientation,
                                     double torque,
                                     Generator& generator) {
  const TorqueCurve curve(*truth.torque_curve);
  const TorqueGeometry geometry = torqueGeometry(truth);
  std::normal_distribution<double> normal;
  const auto noise = [&](double stddev) -> Eigen::Vector3d {
    return {stddev * normal(generator), stddev * normal(generator), stddev * normal(generator)};
  };
  std::vector<Eigen::Index> coils(truth.coils.size());
  std::iota(coils.begin(), coils.end(), 0);
  std::vector<Sample> samples;
  for (const Eigen::Vector3d& q : randomPoses(poses, 0.5, generator)) {
    const Eigen::Matrix3d R = rotorOrientation(jointGeometry(truth.joints), q);
    Sample sample;
    sample.has_orientation = true;
    sample.R_stator_rotor = rotationExp(noise(orientation)) * R;
    sample.orientation_stddev = orientation;
    sample.has_torque = true;
    sample.torque_stddev = torque;
    std::shuffle(coils.begin(), coils.end(), generator);
    for (std::size_t n = 0; n < coils_per_pose; ++n) {
      sample.id = static_cast<std::uint32_t>(samples.size() + 1);
      sample.current =
          kCurrent * Eigen::VectorXd::Unit(static_cast<Eigen::Index>(coils.size()), coils[n]);
      sample.torque = rotorTorque(curve, geometry, R, sample.current) + noise(torque);
      samples.push_back(sample);
    }
  }
  return samples;
}

CalibrationState exactJoints(const ParameterSpace& space,
                             const Actuator& truth,
                             const ManufacturingTolerance& tolerance) {
  CalibrationState state = nominalState(space, tolerance);
  const Eigen::Index joints = space.pole(0);
  state.belief.x.head(joints) = space.coordinatesOf(truth).head(joints);
  state.belief.covariance.topLeftCorner(joints, joints).setZero();
  std::fill(state.identified.begin(), state.identified.begin() + joints, true);
  return state;
}

OrientationMapDescription orientationMap() {
  OrientationMapDescription map;
  map.length = {0.3, 0.5, 0.8};
  map.amplitude = {1e-3, 2e-3, 5e-4};
  map.noise = {1e-4, 3e-4, 2e-4};
  map.tracker_noise = 5e-5;
  for (int n = 0; n < 12; ++n) {
    map.readings.emplace_back(0.1 * std::sin(n), 0.2 * std::cos(2.0 * n), 0.5 * n);
    map.rotations.emplace_back(1e-3 * std::cos(n), 2e-3 * std::sin(3.0 * n), 5e-4 * std::sin(n));
  }
  return map;
}

}  // namespace sac::scenarios
