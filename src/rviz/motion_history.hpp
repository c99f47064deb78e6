#pragma once

#include <string>
#include <vector>

#include "spherical_actuator_calibration/MotionProgress.h"
#include "spherical_actuator_calibration/ros/conversion/messages.hpp"

namespace sac {

inline constexpr double kMilli = 1e3;  ///< mrad in a rad

/// How the uncertainty of one group of parameters has fallen while the rotor moved.
struct UncertaintyCurve {
  std::string group;            ///< joints, poles, coils
  std::vector<double> seconds;  ///< of motion that serves
  std::vector<double> stddevs;  ///< of the least known parameter, after each [rad]
};

/// What a motion has told since its begin, for a picture of it. Knows nothing of windows on a
/// screen.
class MotionHistory {
 public:
  void receive(const msg::MotionProgress& message);

  /// Since the first estimate; those of an hour have no more than some thousand places.
  const std::vector<UncertaintyCurve>& curves() const { return curves_; }
  double wantedStddev() const { return last_.wanted_stddev; }  ///< [rad]; 0: nothing was told
  /// What is known and what is left, in sentences.
  std::string words() const;
  /// Inertia, unbalance, friction and delays, a line each.
  std::vector<std::string> dynamics() const;

 private:
  void thin();

  msg::MotionProgress last_;
  std::vector<UncertaintyCurve> curves_;
};

}  // namespace sac
