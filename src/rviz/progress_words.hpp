#pragma once

#include <cstdint>
#include <string>

#include "spherical_actuator_calibration/ExciteFeedback.h"
#include "spherical_actuator_calibration/MeasurementProgress.h"
#include "spherical_actuator_calibration/ros/conversion/messages.hpp"

namespace sac {

/// What the feedback of a measurement tells, in words for a window: what is under way, and beside
/// it what disturbs it, until the next capture. Knows no windows and no ROS but messages.
class ProgressWords {
 public:
  void receive(const msg::MeasurementProgress& progress);
  const std::string& text() const { return text_; }

 private:
  std::uint32_t told_ = 0;      ///< sentences that belong to captures that are done
  std::uint32_t captures_ = 0;  ///< that are done
  std::string text_ = "Measuring …";
};

/// What the feedback of a guided session tells, so that nobody at the panel works against it: which
/// pose, what is under way, and which way a hand is still to turn the rotor.
std::string sessionInWords(const msg::MeasurementProgress& progress);

/// What the feedback of an excitation tells, likewise: what the coils carry by the amplifier's own
/// measurement, not what they were commanded.
class ExcitationWords {
 public:
  void receive(const msg::ExciteFeedback& feedback);
  const std::string& text() const { return text_; }
  /// "Coil 3 carried 1.998 A, the others at most 0.004 A." of the last time when it did; else
  /// empty.
  const std::string& carried() const { return carried_; }

 private:
  std::string text_ = "Asking the engine …";
  std::string carried_;
};

}  // namespace sac
