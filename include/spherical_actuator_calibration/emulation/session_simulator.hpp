#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

#include <Eigen/Core>

#include "spherical_actuator_calibration/actuator/actuator.hpp"
#include "spherical_actuator_calibration/emulation/emulated_sensors.hpp"
#include "spherical_actuator_calibration/emulation/session_trajectory.hpp"
#include "spherical_actuator_calibration/emulation/true_actuator.hpp"
#include "spherical_actuator_calibration/measurement/measurements.hpp"
#include "spherical_actuator_calibration/measurement/registration.hpp"
#include "spherical_actuator_calibration/measurement/session_plan.hpp"

namespace sac {

/// Registration of a plausible laboratory: every transform away from the identity.
Registration laboratoryRegistration();

/// One emulated session. The seed decides every random number.
struct SimulationOptions {
  std::uint64_t seed = 1;
  Stamp begin = 1'700'000'000'000'000'000;  ///< stamp of the begin of the session
  SessionTiming timing;
  Registration registration = laboratoryRegistration();
  EmulatedJointOptions joint_sensor;
  TrackerOptions tracker;
  WrenchSensorOptions wrench_sensor;
  CurrentSensorOptions current_sensor;
  RotorLoad load;
};

/// Throws ConfigError that names the option, its value and the allowed range.
void validate(const SimulationOptions& options);

/// Takes the measurements of a session, one by one in the order of their stamps.
class MeasurementSink {
 public:
  MeasurementSink() = default;
  MeasurementSink(const MeasurementSink&) = delete;
  MeasurementSink& operator=(const MeasurementSink&) = delete;
  virtual ~MeasurementSink() = default;

  virtual void add(const JointMeasurement& measurement) = 0;
  virtual void add(const MarkerPoseMeasurement& measurement) = 0;
  virtual void add(const WrenchMeasurement& measurement) = 0;
  virtual void add(const CurrentMeasurement& measurement) = 0;
};

/// What an emulated session was like.
struct SimulatedSession {
  double duration = 0.0;                ///< [s]
  std::vector<DwellTimes> dwells;       ///< as planned
  std::vector<std::size_t> bad_dwells;  ///< in which the tracker was off, counted from 0
};

/// Emulates a session of the actuator `truth`: it follows the plan's joint positions exactly, its
/// orientation and torque are those of its true parameters, and the sensors see them with their
/// defects. Without a torque model there are neither wrenches nor currents. Memory does not grow
/// with the length of the session. `progress`, when given, is told the share done (0 to 1) now and
/// then. Throws ConfigError when truth, plan or options are not valid.
SimulatedSession simulateSession(const Actuator& truth,
                                 const SessionPlan& plan,
                                 const SimulationOptions& options,
                                 MeasurementSink& sink,
                                 const std::function<void(double)>& progress = {});

}  // namespace sac
