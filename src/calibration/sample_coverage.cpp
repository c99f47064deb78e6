#include "spherical_actuator_calibration/calibration/sample_coverage.hpp"

#include <algorithm>

namespace sac {
CoverageCounter::CoverageCounter(const CalibrationModel& model,
                                 const Eigen::VectorXd& x,
                                 double threshold)
    : curve_(model.hasTorqueModel() ? &model.curve() : nullptr), threshold_(threshold) {
  const Actuator actuator = model.space().actuatorAt(x);
  joints_ = jointGeometry(actuator);
  geometry_ = torqueGeometry(actuator);
  coverage_.poles.resize(model.space().poles(), 0);
  coverage_.coils.resize(model.space().coils(), 0);
}

void CoverageCounter::add(const Sample& sample) {
  if (sample.validation) {
    return;
  }
  addMotion(sample);
  if (sample.has_orientation) {
    addOrientation();
  }
  if (sample.has_torque) {
    addTorque(sample);
  }
}

void CoverageCounter::add(const Sample& sample, Quantity quantity) {
  addMotion(sample);
  if (quantity == Quantity::kOrientation) {
    addOrientation();
  } else {
    addTorque(sample);
  }
}

void CoverageCounter::addMotion(const Sample& sample) {
  for (std::size_t k = 0; k < kJoints; ++k) {
    SampleCoverage::Motion& motion = coverage_.joints[k];
    const double angle = sample.joint_position[static_cast<Eigen::Index>(k)];
    motion.lowest = is_first_ ? angle : std::min(motion.lowest, angle);
    motion.highest = is_first_ ? angle : std::max(motion.highest, angle);
  }
  is_first_ = false;
}

/// Counts the poles and coils that meet in the torque of a sample.
void CoverageCounter::addTorque(const Sample& sample) {
  if (curve_ == nullptr) {
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

/// Marks the poles within reach of a coil; whether there is any.
bool CoverageCounter::markSeen(const Eigen::Vector3d& coil_rotor,
                               std::vector<bool>& is_pole_seen) const {
  bool sees_pole = false;
  for (std::size_t i = 0; i < is_pole_seen.size(); ++i) {
    const Eigen::Vector3d pole_rotor = geometry_.poles_rotor.col(static_cast<Eigen::Index>(i));
    if (interacts(*curve_, pole_rotor, coil_rotor)) {
      is_pole_seen[i] = true;
      sees_pole = true;
    }
  }
  return sees_pole;
}

SampleCoverage sampleCoverage(const CalibrationModel& model,
                              const std::vector<Sample>& samples,
                              const Eigen::VectorXd& x,
                              double threshold) {
  CoverageCounter counter(model, x, threshold);
  for (const Sample& sample : samples) {
    counter.add(sample);
  }
  return counter.coverage();
}

SampleCoverage sampleCoverage(const CalibrationModel& model,
                              const std::vector<Sample>& samples,
                              const std::vector<Observation>& observations,
                              const Eigen::VectorXd& x,
                              double threshold) {
  CoverageCounter counter(model, x, threshold);
  for (const Observation& observation : observations) {
    counter.add(samples[observation.sample], observation.quantity);
  }
  return counter.coverage();
}

}  // namespace sac
