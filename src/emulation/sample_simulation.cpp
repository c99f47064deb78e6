#include "spherical_actuator_calibration/emulation/sample_simulation.hpp"

#include <optional>

#include "spherical_actuator_calibration/actuator/spherical_joint.hpp"
#include "spherical_actuator_calibration/actuator/torque_model.hpp"
#include "spherical_actuator_calibration/base/noise_source.hpp"
#include "spherical_actuator_calibration/base/random_purpose.hpp"
#include "spherical_actuator_calibration/base/rotations.hpp"
#include "spherical_actuator_calibration/base/value_range.hpp"

namespace sac {
namespace {

/// What the sensors of one actuator tell at a pose.
class SampleSource {
 public:
  SampleSource(const Actuator& truth, const SampleNoise& noise, std::uint64_t seed)
      : joints_(jointGeometry(truth)), noise_(noise), random_(seed, RandomPurpose::kSampleNoise) {
    if (truth.hasTorqueModel()) {
      curve_.emplace(*truth.torque_curve);
      geometry_ = torqueGeometry(truth);
    }
  }

  Sample at(const Eigen::Vector3d& q) {
    Sample sample;
    sample.id = ++last_id_;
    R_stator_rotor_ = rotorOrientation(joints_, q);
    sample.joint_position = q + random_.gaussianVector(noise_.joint);
    sample.joint_stddev.setConstant(noise_.joint);
    return sample;
  }

  /// Of the pose of the last at(), like addTorque().
  void addOrientation(Sample& sample) {
    sample.has_orientation = true;
    sample.R_stator_rotor =
        rotationExp(random_.gaussianVector(noise_.orientation)) * R_stator_rotor_;
    sample.orientation_stddev = noise_.orientation;
  }

  void addTorque(Sample& sample, const Eigen::VectorXd& current) {
    sample.has_torque = true;
    sample.current = current;
    sample.torque = rotorTorque(*curve_, geometry_, R_stator_rotor_, current) +
                    random_.gaussianVector(noise_.torque);
    sample.torque_stddev = noise_.torque;
  }

 private:
  JointGeometry joints_;
  std::optional<TorqueCurve> curve_;
  TorqueGeometry geometry_;
  SampleNoise noise_;
  NoiseSource random_;
  Eigen::Matrix3d R_stator_rotor_ = Eigen::Matrix3d::Identity();
  std::uint32_t last_id_ = 0;
};

}  // namespace

void validate(const SampleNoise& noise) {
  requireInRange("noise of orientations", noise.orientation, ValueRange::closed(0.0, 0.1, "rad"));
  requireInRange("noise of torques", noise.torque, ValueRange::closed(0.0, 10.0, "N·m"));
  requireInRange("noise of joints", noise.joint, ValueRange::closed(0.0, 0.1, "rad"));
}

std::vector<Sample> simulateSamples(const Actuator& truth,
                                    const SessionPlan& plan,
                                    TrackerUse tracker,
                                    const SampleNoise& noise,
                                    std::uint64_t seed) {
  validate(noise);
  validate(plan, truth.coils.size());
  SampleSource source(truth, noise, seed);
  std::vector<Sample> samples;
  for (const PlannedDwell& dwell : plan.dwells) {
    const auto add = [&](const Eigen::VectorXd* pattern) {
      Sample sample = source.at(dwell.joint_position);
      sample.validation = dwell.validation;
      if (pattern == nullptr || tracker == TrackerUse::kEveryPose) {
        source.addOrientation(sample);
      }
      if (pattern != nullptr) {
        source.addTorque(sample, *pattern);
      }
      samples.push_back(sample);
    };
    if (dwell.patterns.empty()) {
      add(nullptr);
    }
    for (const Eigen::VectorXd& pattern : dwell.patterns) {
      add(&pattern);
    }
  }
  return samples;
}

}  // namespace sac
