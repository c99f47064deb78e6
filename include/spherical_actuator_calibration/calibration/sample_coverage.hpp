#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "spherical_actuator_calibration/actuator/spherical_joint.hpp"
#include "spherical_actuator_calibration/actuator/torque_model.hpp"
#include "spherical_actuator_calibration/estimation/calibration_model.hpp"
#include "spherical_actuator_calibration/estimation/estimation_problem.hpp"
#include "spherical_actuator_calibration/measurement/sample.hpp"

namespace sac {

/// How often the samples that serve an estimate look at each part of the actuator. How much such a
/// look tells is in the standard deviations, not here.
struct SampleCoverage {
  /// Range of one joint's sensor angle over the samples [rad]; both 0 without samples.
  struct Motion {
    double lowest = 0.0;
    double highest = 0.0;
  };
  std::array<Motion, kJoints> joints;
  std::uint32_t orientations = 0;  ///< samples with an orientation
  /// Torque samples in which some excited coil reaches the pole.
  std::vector<std::uint32_t> poles;
  /// Torque samples in which the coil is excited and reaches some pole.
  std::vector<std::uint32_t> coils;
};

/// Counts sample by sample. `x` are the coordinates in force, `threshold` the current from which on
/// a coil counts as excited [A]. Keeps the torque curve of `model`.
class CoverageCounter {
 public:
  CoverageCounter(const CalibrationModel& model, const Eigen::VectorXd& x, double threshold);

  /// All that a sample tells; one that is held out does not count.
  void add(const Sample& sample);
  /// One of its quantities.
  void add(const Sample& sample, Quantity quantity);

  const SampleCoverage& coverage() const { return coverage_; }

 private:
  void addMotion(const Sample& sample);
  void addOrientation() { ++coverage_.orientations; }
  void addTorque(const Sample& sample);
  bool markSeen(const Eigen::Vector3d& coil_rotor, std::vector<bool>& is_pole_seen) const;

  const TorqueCurve* curve_;  ///< null without a torque model
  double threshold_;
  JointGeometry joints_;
  TorqueGeometry geometry_;
  SampleCoverage coverage_;
  bool is_first_ = true;
};

/// Counts over all samples that are not held out. `x` are the coordinates in force, `threshold` the
/// current from which on a coil counts as excited [A].
SampleCoverage sampleCoverage(const CalibrationModel& model,
                              const std::vector<Sample>& samples,
                              const Eigen::VectorXd& x,
                              double threshold);

/// The same over what serves one cycle: torques count where they are among the observations.
SampleCoverage sampleCoverage(const CalibrationModel& model,
                              const std::vector<Sample>& samples,
                              const std::vector<Observation>& observations,
                              const Eigen::VectorXd& x,
                              double threshold);

}  // namespace sac
