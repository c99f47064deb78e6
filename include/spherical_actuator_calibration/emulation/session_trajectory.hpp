#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include <Eigen/Core>

#include "spherical_actuator_calibration/measurement/session_plan.hpp"

namespace sac {

/// Time course of a session. Durations in seconds.
struct SessionTiming {
  double move = 0.8;              ///< shortest move between two dwells; longer where speed forbids
  double peak_joint_speed = 8.0;  ///< of the fastest joint during a move [rad/s]
  double settle = 0.3;            ///< at rest after a move, without current
  double zero_current = 0.4;      ///< then: the zero-current part of a dwell with patterns
  double pattern = 0.6;           ///< each pattern
  double release = 0.3;           ///< at rest without current before the next move
  double orientation_only = 0.6;  ///< after settling, in a dwell without patterns
  double current_time_constant = 0.005;  ///< first-order lag of the amplifiers
};

/// Throws ConfigError that names the duration, its value and the allowed range.
void validate(const SessionTiming& timing);

/// Span of time in which the rotor rests at one pose [s from the begin of the session].
struct DwellTimes {
  double begin = 0.0;
  double end = 0.0;
};

/// What the actuator does at one instant.
struct SessionState {
  Eigen::Vector3d joint_position = Eigen::Vector3d::Zero();  ///< raw sensor angles, exact [rad]
  Eigen::VectorXd current;                                   ///< actual coil currents [A]
  std::optional<std::size_t> dwell;  ///< the dwell in which the rotor rests, counted from 0
};

/// A session plan laid out in time: from zero angles to each dwell in turn by minimum-jerk moves in
/// joint space; in a dwell without current, with each pattern in turn, and without current again.
class SessionTrajectory {
 public:
  /// Throws ConfigError when plan or timing is not valid.
  SessionTrajectory(const SessionPlan& plan, const SessionTiming& timing, std::size_t coils);

  /// Length of the session [s]; it ends with the last dwell.
  double duration() const { return phases_.back().end; }
  /// When each dwell of the plan is at rest.
  const std::vector<DwellTimes>& dwells() const { return dwells_; }

  /// State at a time [s from the begin]; later than the end it is the state at the end. Times must
  /// not decrease from call to call. Valid until the next call.
  const SessionState& at(double time);

 private:
  /// Span of time with one target of position and current.
  struct Phase {
    double begin;
    double end;
    Eigen::Vector3d from;  ///< joint position at the begin
    Eigen::Vector3d to;    ///< joint position at the end
    Eigen::VectorXd start_current;
    Eigen::VectorXd target_current;
    std::optional<std::size_t> dwell;
  };

  void append(double duration,
              const Eigen::Vector3d& to,
              const Eigen::VectorXd& target_current,
              std::optional<std::size_t> dwell);
  void appendDwell(const PlannedDwell& dwell, std::size_t index);
  double moveDuration(const Eigen::Vector3d& to) const;
  void currentIn(const Phase& phase, double time, Eigen::VectorXd& current) const;

  SessionTiming timing_;
  Eigen::VectorXd no_current_;
  std::vector<Phase> phases_;
  std::vector<DwellTimes> dwells_;
  std::size_t phase_ = 0;
  SessionState state_;
};

}  // namespace sac
