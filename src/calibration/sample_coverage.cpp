#include "spherical_actuator_calibration/calibration/sample_coverage.hpp"

#include <algorithm>

#include "spherical_actuator_calibration/actuator/spherical_joint.hpp"
#include "spherical_actuator_calibration/actuator/torque_model.hpp"

namespace sac {
namespace {

/// Adds sample by sample to a coverage.
class Counter {
 public:
  Counter(const CalibrationModel& model, const Eigen::VectorXd& x, double threshold)
      : model_(model), threshold_(threshold) {
    const Actuator actuator = model.space().actuatorAt(x);
    joints_ = jointGeometry(actuator);
    geometry_ = torqueGeometry(actuator);
    coverage_.poles.resize(model.space().poles(), 0);
    coverage_.coils.resize(model.space().coils(), 0);
  }

  void addMotion(const Sample& sample) {
    for (std::size_t k = 0; k < kJoints; ++k) {
      SampleCoverage::Motion& motion = coverage_.joints[k];
      const double angle = sample.joint_position[static_cast<Eigen::Index>(k)];
      motion.lowest = is_first_ ? angle : std::min(motion.lowest, angle);
      motion.highest = is_first_ ? angle : std::max(motion.highest, angle);
    }
    is_first_ = false;
  }

  void addOrientation() { ++coverage_.orientations; }

  /// Counts the poles and coils that meet in the torque of a sample.
  void addTorque(const Sample& sample) {
    if (!model_.hasTorqueModel()) {
      return;
    }
    const Eigen::Matrix3d R_stator_rotor = rotorOrientation(joints_, sample.joint_position);
    std::vector<bool> is_pole_seen(coverage_.poles.size(), false);
    for (const Excitation& excitation : excitedCoils(sample, threshold_)) {
      const auto j = static_cast<Eigen::Index>(excitation.coil);
      const Eigen::Vector3d coil_rotor = R_stator_rotor.transpose() * geometry_.coils_stator.col(j);
      coverage_.coils[excitation.coil] += markSeen(coil_rotor, is_pole_seen) ? 1U : 0U;
    }
    for (std::size_t i = 0; i < is_pole_seen.size(); ++i) {
      coverage_.poles[i] += is_pole_seen[i] ? 1U : 0U;
    }
  }

  const SampleCoverage& coverage() const { return coverage_; }

 private:
  /// Marks the poles within reach of a coil; whether there is any.
  bool markSeen(const Eigen::Vector3d& coil_rotor, std::vector<bool>& is_pole_seen) const {
    bool sees_pole = false;
    for (std::size_t i = 0; i < is_pole_seen.size(); ++i) {
      const Eigen::Vector3d pole_rotor = geometry_.poles_rotor.col(static_cast<Eigen::Index>(i));
      if (interacts(model_.curve(), pole_rotor, coil_rotor)) {
        is_pole_seen[i] = true;
        sees_pole = true;
      }
    }
    return sees_pole;
  }

  const CalibrationModel& model_;
  double threshold_;
  JointGeometry joints_;
  TorqueGeometry geometry_;
  SampleCoverage coverage_;
  bool is_first_ = true;
};

}  // namespace

SampleCoverage sampleCoverage(const CalibrationModel& model,
                              const std::vector<Sample>& samples,
                              const Eigen::VectorXd& x,
                              double threshold) {
  Counter counter(model, x, threshold);
  for (const Sample& sample : samples) {
    if (sample.validation) {
      continue;
    }
    counter.addMotion(sample);
    if (sample.has_orientation) {
      counter.addOrientation();
    }
    if (sample.has_torque) {
      counter.addTorque(sample);
    }
  }
  return counter.coverage();
}

SampleCoverage sampleCoverage(const CalibrationModel& model,
                              const std::vector<Sample>& samples,
                              const std::vector<Observation>& observations,
                              const Eigen::VectorXd& x,
                              double threshold) {
  Counter counter(model, x, threshold);
  for (const Observation& observation : observations) {
    const Sample& sample = samples[observation.sample];
    counter.addMotion(sample);
    if (observation.quantity == Quantity::kOrientation) {
      counter.addOrientation();
    } else {
      counter.addTorque(sample);
    }
  }
  return counter.coverage();
}

}  // namespace sac
