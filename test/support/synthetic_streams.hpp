#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "spherical_actuator_calibration/measurement/measurements.hpp"
#include "spherical_actuator_calibration/streams/sample_builder.hpp"

/// Streams of measurements with a known truth, for tests of what turns streams into samples.
namespace sac::synthetic {

/// Stamp of a time since the begin of a script [s].
Stamp stampAt(double time);
/// Time since the begin of a script [s].
double timeOf(Stamp stamp);

/// What the rotor and the coils do, phase after phase. The truth at any time follows from it.
class Script {
 public:
  explicit Script(std::size_t coils);

  /// Minimum-jerk move without current, over `duration` [s].
  Script& moveTo(const Eigen::Vector3d& position, double duration = 0.8);
  /// Uniform motion by `step` [rad] over `duration` [s], currents as they are.
  Script& driftBy(const Eigen::Vector3d& step, double duration);
  /// Stands still without current.
  Script& rest(double duration);
  /// Stands still with one coil (from 0) at `current` [A].
  Script& excite(std::size_t coil, double current, double duration);
  /// Stands still while the current of one coil changes uniformly to `current` [A].
  Script& rampTo(std::size_t coil, double current, double duration);

  double duration() const;
  Eigen::Vector3d position(double time) const;  ///< joint angles [rad]
  Eigen::VectorXd current(double time) const;   ///< per coil [A]
  /// Orientation that belongs to joint angles, for ideal axes.
  static Eigen::Matrix3d orientation(const Eigen::Vector3d& position);
  /// Torque of the currents alone, without any bias [N·m].
  static Eigen::Vector3d torque(const Eigen::VectorXd& current);

 private:
  enum class Profile { kMinimumJerk, kUniform };
  struct Phase {
    double begin;
    double duration;
    Profile profile;
    Eigen::Vector3d from;
    Eigen::Vector3d to;
    Eigen::VectorXd current_from;
    Eigen::VectorXd current_to;
  };

  Script& append(Profile profile,
                 double duration,
                 const Eigen::Vector3d& to,
                 const Eigen::VectorXd& current_from,
                 const Eigen::VectorXd& current_to);
  const Phase& phaseAt(double time) const;

  Eigen::VectorXd zero_current_;
  std::vector<Phase> phases_;
};

/// How the streams see it: rates [Hz], standard deviations of normal noise, torque bias.
struct Sensors {
  double joint_rate = 200.0;
  double orientation_rate = 120.0;
  double torque_rate = 500.0;
  double current_rate = 200.0;
  double jitter = 0.0;  ///< of the stamps, share of the period
  double joint_noise = 5e-5;
  double orientation_noise = 5e-4;
  double torque_noise = 2e-3;
  double current_noise = 1e-3;
  Eigen::Vector3d torque_bias = Eigen::Vector3d::Zero();
  double current_offset = 0.0;  ///< of every current sensor [A]
};

struct Streams {
  std::vector<JointMeasurement> joints;
  std::vector<OrientationMeasurement> orientations;
  std::vector<TorqueMeasurement> torques;
  std::vector<CurrentMeasurement> currents;
};

/// Measurements of the whole script. A rate of zero leaves a stream out.
Streams record(const Script& script, const Sensors& sensors, std::uint64_t seed);

/// Adds all measurements in the order of their stamps.
void feed(SampleBuilder& builder, const Streams& streams);

/// Adds all measurements as they may arrive: each is late by up to `largest_delay` [s], the order
/// within each stream is kept.
void feedDelayed(SampleBuilder& builder,
                 const Streams& streams,
                 double largest_delay,
                 std::uint64_t seed);

/// All samples of the streams, with finish().
std::vector<Sample> samplesOf(SampleBuilder& builder, const Streams& streams);

}  // namespace sac::synthetic
