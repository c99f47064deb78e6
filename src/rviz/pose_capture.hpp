#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include <actionlib/client/simple_action_client.h>
#include <ros/node_handle.h>

#include "spherical_actuator_calibration/CaptureAction.h"
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

/// How a measurement ended.
struct CaptureEnd {
  bool success = false;
  std::string message;  ///< one sentence
};

/// Has the engine measure a pose, by its action `calibration/capture`, and follows it. Callbacks
/// come by the queue of the node.
class PoseCapture {
 public:
  explicit PoseCapture(ros::NodeHandle node);

  /// Precondition: !isRunning().
  void begin(const msg::CaptureGoal& goal);
  bool isRunning() const { return is_running_; }
  /// The engine takes the currents to zero; the end comes as any other.
  void cancel() { client_.cancelGoal(); }
  /// In words, while it runs.
  const std::string& progress() const { return words_.text(); }
  /// How it ended, once, when it has; to be asked again and again, as an engine may go without a
  /// word.
  std::optional<CaptureEnd> takeEnd();

 private:
  actionlib::SimpleActionClient<msg::CaptureAction> client_;
  ProgressWords words_;
  bool is_running_ = false;
  std::optional<CaptureEnd> end_;
};

}  // namespace sac
