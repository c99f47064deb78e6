#include "spherical_actuator_calibration/emulation/session_simulator.hpp"

#include <algorithm>
#include <optional>

#include <Eigen/Geometry>

#include "spherical_actuator_calibration/base/random_purpose.hpp"
#include "spherical_actuator_calibration/base/rotations.hpp"
#include "spherical_actuator_calibration/base/value_range.hpp"

namespace sac {
namespace {

/// Simulated time between two reports of progress [s].
constexpr double kProgressStep = 1.0;

Eigen::Isometry3d transform(const Eigen::Vector3d& translation, const Eigen::Vector3d& rotation) {
  Eigen::Isometry3d X = Eigen::Isometry3d::Identity();
  X.translation() = translation;
  X.linear() = rotationExp(rotation);
  return X;
}

class Simulation {
 public:
  Simulation(const Actuator& truth,
             const SessionPlan& plan,
             const SimulationOptions& options,
             MeasurementSink& sink)
      : options_(options),
        sink_(sink),
        actuator_(truth, options.load),
        trajectory_(plan, options.timing, truth.coils.size()),
        joint_sensor_(options.joint_sensor, options.seed),
        tracker_(options.tracker, options.registration, plan.dwells.size(), options.seed),
        wrench_sensor_(options.wrench_sensor, options.registration, options.seed),
        current_sensor_(options.current_sensor, options.seed),
        joint_stream_(schedule(options.joint_sensor.stream, RandomPurpose::kJointStream)),
        tracker_stream_(schedule(options.tracker.stream, RandomPurpose::kTrackerStream)),
        wrench_stream_(schedule(options.wrench_sensor.stream, RandomPurpose::kWrenchStream)),
        current_stream_(schedule(options.current_sensor.stream, RandomPurpose::kCurrentStream)),
        tracker_end_(trackerEnd()) {
    if (!actuator_.hasTorque()) {
      wrench_stream_.stop();
      current_stream_.stop();
    }
  }

  SimulatedSession run(const std::function<void(double)>& progress) {
    double next_progress = 0.0;
    while (StreamSchedule* stream = earliestStream()) {
      const double time = secondsBetween(0, stream->next().since_begin);
      if (progress && time >= next_progress) {
        progress(time / trajectory_.duration());
        next_progress = time + kProgressStep;
      }
      measure(*stream, trajectory_.at(time), time);
      stream->advance();
    }
    if (progress) {
      progress(1.0);
    }
    return {trajectory_.duration(), trajectory_.dwells(), tracker_.badDwells()};
  }

 private:
  StreamSchedule schedule(const StreamOptions& stream, RandomPurpose purpose) const {
    return {stream, trajectory_.duration(), options_.seed, purpose};
  }

  /// Time at which the tracker is switched off [s].
  double trackerEnd() const {
    const std::size_t dwells = trajectory_.dwells().size();
    const std::size_t poses = std::min(options_.tracker.poses.value_or(dwells), dwells);
    return poses == 0 ? 0.0 : trajectory_.dwells()[poses - 1].end;
  }

  /// The stream that delivers next; none at the end of the session.
  StreamSchedule* earliestStream() {
    StreamSchedule* earliest = nullptr;
    for (StreamSchedule* stream :
         {&joint_stream_, &tracker_stream_, &wrench_stream_, &current_stream_}) {
      const bool earlier = !earliest || (!stream->done() &&
                                         stream->next().since_begin < earliest->next().since_begin);
      if (!stream->done() && earlier) {
        earliest = stream;
      }
    }
    return earliest;
  }

  void measure(const StreamSchedule& stream, const SessionState& state, double time) {
    const ScheduledMeasurement& scheduled = stream.next();
    const Stamp stamp = options_.begin + scheduled.since_begin;
    if (&stream == &joint_stream_) {
      deliver(joint_sensor_.measure(stamp, state.joint_position, scheduled), scheduled);
      return;
    }
    if (&stream == &current_stream_) {
      deliver(current_sensor_.measure(stamp, state.current, scheduled), scheduled);
      return;
    }
    const Eigen::Matrix3d R_stator_rotor = actuator_.orientation(state.joint_position);
    if (&stream == &wrench_stream_) {
      deliver(wrench_sensor_.measure(stamp,
                                     actuator_.torque(R_stator_rotor, state.current),
                                     actuator_.weight(R_stator_rotor),
                                     scheduled),
              scheduled);
      return;
    }
    if (time < tracker_end_) {
      deliver(tracker_.measure(stamp, R_stator_rotor, state.dwell, scheduled), scheduled);
    }
  }

  template <typename Measurement>
  void deliver(const Measurement& measurement, const ScheduledMeasurement& scheduled) {
    sink_.add(measurement);
    if (scheduled.repeated) {
      sink_.add(measurement);
    }
  }

  SimulationOptions options_;
  MeasurementSink& sink_;
  TrueActuator actuator_;
  SessionTrajectory trajectory_;
  EmulatedJointSensor joint_sensor_;
  EmulatedTracker tracker_;
  EmulatedWrenchSensor wrench_sensor_;
  EmulatedCurrentSensor current_sensor_;
  StreamSchedule joint_stream_;
  StreamSchedule tracker_stream_;
  StreamSchedule wrench_stream_;
  StreamSchedule current_stream_;
  double tracker_end_;
};

}  // namespace

Registration laboratoryRegistration() {
  Registration registration;
  registration.X_stator_tracker = transform({0.82, -0.35, 0.61}, {0.4, -2.1, 0.9});
  registration.X_rotor_marker = transform({0.021, -0.014, 0.088}, {-0.3, 0.2, 1.2});
  registration.X_rotor_sensor = transform({0.004, -0.003, 0.062}, {0.02, -0.01, 0.52});
  return registration;
}

void validate(const SimulationOptions& options) {
  validate(options.timing);
  validate(options.joint_sensor);
  validate(options.tracker);
  validate(options.wrench_sensor);
  validate(options.current_sensor);
  requireInRange("rotor weight", options.load.weight, ValueRange::nonNegative("N"));
  for (const double component : options.load.unbalance) {
    requireInRange("rotor unbalance", component, ValueRange::finite("N m"));
  }
}

SimulatedSession simulateSession(const Actuator& truth,
                                 const SessionPlan& plan,
                                 const SimulationOptions& options,
                                 MeasurementSink& sink,
                                 const std::function<void(double)>& progress) {
  validate(truth);
  validate(options);
  return Simulation(truth, plan, options, sink).run(progress);
}

}  // namespace sac
