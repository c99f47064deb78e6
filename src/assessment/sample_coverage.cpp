#include "spherical_actuator_calibration/assessment/sample_coverage.hpp"

#include <algorithm>

#include "spherical_actuator_calibration/actuator/spherical_joint.hpp"
#include "spherical_actuator_calibration/actuator/torque_model.hpp"

namespace sac {
namespace {

void widen(SampleCoverage::Motion& motion, double angle, bool is_first) {
  motion.lowest = is_first ? angle : std::min(motion.lowest, angle);
  motion.highest = is_first ? angle : std::max(motion.highest, angle);
}

/// Counts the poles and coils that meet in one torque sample.
void countMeetings(const TorqueCurve& curve,
                   const TorqueGeometry& geometry,
                   const Eigen::Matrix3d& R_stator_rotor,
                   const std::vector<Excitation>& excited,
                   SampleCoverage& coverage) {
  std::vector<bool> is_pole_seen(coverage.poles.size(), false);
  for (const Excitation& excitation : excited) {
    const auto j = static_cast<Eigen::Index>(excitation.coil);
    const Eigen::Vector3d coil_rotor = R_stator_rotor.transpose() * geometry.coils_stator.col(j);
    bool sees_pole = false;
    for (std::size_t i = 0; i < is_pole_seen.size(); ++i) {
      if (interacts(curve, geometry.poles_rotor.col(static_cast<Eigen::Index>(i)), coil_rotor)) {
        is_pole_seen[i] = true;
        sees_pole = true;
      }
    }
    coverage.coils[excitation.coil] += sees_pole ? 1U : 0U;
  }
  for (std::size_t i = 0; i < is_pole_seen.size(); ++i) {
    coverage.poles[i] += is_pole_seen[i] ? 1U : 0U;
  }
}

}  // namespace

SampleCoverage sampleCoverage(const CalibrationModel& model,
                              const std::vector<Sample>& samples,
                              const Eigen::VectorXd& x,
                              double threshold) {
  const Actuator actuator = model.space().actuatorAt(x);
  const JointGeometry joints = jointGeometry(actuator.joints);
  const TorqueGeometry geometry = torqueGeometry(actuator);
  SampleCoverage coverage;
  coverage.poles.resize(model.space().poles(), 0);
  coverage.coils.resize(model.space().coils(), 0);
  bool is_first = true;
  for (const Sample& sample : samples) {
    if (sample.validation) {
      continue;
    }
    for (std::size_t k = 0; k < kJoints; ++k) {
      const double angle = sample.joint_position[static_cast<Eigen::Index>(k)];
      widen(coverage.joints[k], angle, is_first);
    }
    is_first = false;
    if (sample.has_torque && model.hasTorqueModel()) {
      countMeetings(model.curve(),
                    geometry,
                    rotorOrientation(joints, sample.joint_position),
                    excitedCoils(sample, threshold),
                    coverage);
    }
  }
  return coverage;
}

}  // namespace sac
