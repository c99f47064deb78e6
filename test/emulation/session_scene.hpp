#pragma once

#include <vector>

#include <Eigen/Core>

#include "spherical_actuator_calibration/emulation/session_simulator.hpp"
#include "spherical_actuator_calibration/emulation/session_trajectory.hpp"
#include "spherical_actuator_calibration/measurement/registration.hpp"
#include "spherical_actuator_calibration/measurement/session_plan.hpp"
#include "support/scenarios.hpp"

namespace sac {

/// Everything that a session delivered.
struct Recording {
  std::vector<JointMeasurement> joints;
  std::vector<MarkerPoseMeasurement> poses;
  std::vector<WrenchMeasurement> wrenches;
  std::vector<CurrentMeasurement> currents;
  std::vector<Stamp> order;
};

/// Keeps all of it.
class Recorder : public MeasurementSink {
 public:
  explicit Recorder(Recording& recording) : recording_(recording) {}

  void add(const JointMeasurement& measurement) override { keep(recording_.joints, measurement); }
  void add(const MarkerPoseMeasurement& measurement) override {
    keep(recording_.poses, measurement);
  }
  void add(const WrenchMeasurement& measurement) override {
    keep(recording_.wrenches, measurement);
  }
  void add(const CurrentMeasurement& measurement) override {
    keep(recording_.currents, measurement);
  }

 private:
  template <typename Measurement>
  void keep(std::vector<Measurement>& list, const Measurement& measurement) {
    list.push_back(measurement);
    recording_.order.push_back(measurement.stamp);
  }

  Recording& recording_;
};

/// A small session: 3 joint poses, 4 of coil 1, one for validation.
inline SessionPlan smallPlan() {
  SessionPlanOptions layout;
  layout.joint_poses = 3;
  layout.main_coil_poses = 4;
  layout.coil_poses = 0;
  layout.validation_poses = 1;
  return planSession(scenarios::paperNominal(), layout, 1);
}

/// A session of the paper's actuator, to be changed and recorded.
struct Scene {
  Actuator truth = scenarios::paperTruth();
  SessionPlan plan = smallPlan();
  SimulationOptions options;

  Recording record() const {
    Recording recording;
    Recorder recorder(recording);
    simulateSession(truth, plan, options, recorder);
    return recording;
  }

  SessionTrajectory trajectory() const { return {plan, options.timing, truth.coils.size()}; }

  double secondsInto(Stamp stamp) const { return secondsBetween(options.begin, stamp); }
};

/// A scene whose sensors are exact.
inline Scene exactScene() {
  Scene scene;
  scene.options.joint_sensor.noise = 0.0;
  scene.options.joint_sensor.quantisation = 0.0;
  scene.options.tracker.orientation_noise = 0.0;
  scene.options.tracker.position_noise = 0.0;
  scene.options.wrench_sensor.force_noise = 0.0;
  scene.options.wrench_sensor.torque_noise = 0.0;
  scene.options.current_sensor.noise = 0.0;
  scene.options.current_sensor.quantisation = 0.0;
  return scene;
}

/// R_stator_rotor by a pose of the marker.
inline Eigen::Matrix3d orientationOf(const Scene& scene, const MarkerPoseMeasurement& pose) {
  return orientationFromMarkerPose(scene.options.registration, pose)
      .q_stator_rotor.toRotationMatrix();
}

}  // namespace sac
