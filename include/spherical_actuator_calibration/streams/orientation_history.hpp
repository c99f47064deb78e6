#pragma once

#include <deque>

#include <Eigen/Geometry>

#include "spherical_actuator_calibration/measurement/measurements.hpp"
#include "spherical_actuator_calibration/measurement/sample.hpp"

namespace sac {

/// The orientations of the last while, to tell the one at a stamp between two of them.
class OrientationHistory {
 public:
  enum class Answer {
    kKnown,   ///< interpolated between its neighbours
    kNotYet,  ///< newer than the newest orientation
    kNever,   ///< older than the oldest one, or in a hole
  };
  struct Lookup {
    Answer answer = Answer::kNotYet;
    Eigen::Quaterniond q_stator_rotor = Eigen::Quaterniond::Identity();  ///< when known
  };

  /// `span`: what is older than the newest by more is forgotten [s]. `largest_gap`: neighbours
  /// further apart are a hole [s].
  OrientationHistory(double span, double largest_gap);

  /// Must be newer than all before, with a unit quaternion.
  void add(const OrientationMeasurement& orientation);
  void clear() { orientations_.clear(); }

  /// Spherical linear interpolation.
  Lookup at(Stamp stamp) const;

 private:
  Stamp span_;
  Stamp largest_gap_;
  std::deque<OrientationMeasurement> orientations_;  ///< oldest first
};

}  // namespace sac
