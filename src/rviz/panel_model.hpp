#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include <diagnostic_msgs/DiagnosticArray.h>
#include <ros/time.h>

#include "spherical_actuator_calibration/ActuatorParameters.h"
#include "spherical_actuator_calibration/CalibrationReport.h"
#include "spherical_actuator_calibration/CalibrationStatus.h"
#include "spherical_actuator_calibration/ros/conversion/messages.hpp"
#include "spherical_actuator_calibration/ros/conversion/sample_mirror.hpp"

namespace sac {

/// Health of one stream of measurements, or of what a node tells about itself.
struct HealthLine {
  enum class Level { kUnknown, kGood, kWarning, kError };
  std::string name;  ///< e.g. joint_states
  Level level = Level::kUnknown;
  std::string message;  ///< one sentence
};

/// How far one thing to be identified is sampled.
struct CoverageBar {
  std::string name;  ///< e.g. pole_3
  msg::Coverage coverage;
};

struct CoverageGroup {
  std::string title;
  std::vector<CoverageBar> bars;
};

/// One parameter, ready to be read.
struct ParameterLine {
  std::string name;
  std::string value;        ///< with its unit; a dash where it is not identified
  std::string uncertainty;  ///< ± standard deviation, or "not identified"
};

/// How one sample fits the last cycle, ready to be read.
struct SampleLine {
  std::uint32_t id = 0;
  std::string quantity;      ///< orientation, or torque and of which coil, where it is known
  std::string angles;        ///< where it was taken; empty: not known
  std::string residual;      ///< with its unit
  std::string standardized;  ///< the same in units of its expected size
  std::string verdict;       ///< why it was left out of the estimate; empty: it was not

  bool operator==(const SampleLine& other) const {
    return id == other.id && quantity == other.quantity && angles == other.angles &&
           residual == other.residual && standardized == other.standardized &&
           verdict == other.verdict;
  }
};

/// What a panel shows of a calibration: the last message of each topic, in words. It judges and
/// counts nothing by itself, and knows nothing of windows.
class PanelModel {
 public:
  /// `name_space` is that of the actuator, with or without its slash.
  explicit PanelModel(const std::string& name_space);

  void receive(const msg::CalibrationStatus& message);
  void receive(const msg::CalibrationReport& message) { report_ = message; }
  void receive(const msg::ActuatorParameters& message) { parameters_ = message; }
  /// Nothing before the first status.
  void receive(const msg::CalibrationSample& message);
  /// The answer of list_samples, see takeRequestForSamples().
  void receive(const std::vector<msg::CalibrationSample>& in_use);
  /// Keeps what the nodes in the namespace tell.
  void receive(const diagnostic_msgs::DiagnosticArray& message, const ros::WallTime& now);

  /// Whether the rotor has joints, by the parameters in force; true before any came.
  bool hasJoints() const;
  /// Why level 1 cannot be calibrated, in a sentence; empty where it can.
  std::string whyNoJointCycle() const;

  /// The streams of measurements that the calibration node lives on, without joints three. Unknown
  /// when nothing was heard for some seconds.
  std::vector<HealthLine> streams(const ros::WallTime& now) const;
  /// What else is wrong, most serious first.
  std::vector<HealthLine> troubles(const ros::WallTime& now) const;

  /// Joint, where there is one, poles and coils: what has been sampled, and what is missing.
  std::vector<CoverageGroup> coverage() const;
  std::uint32_t coils() const { return static_cast<std::uint32_t>(status_.coils.size()); }

  /// Joint angles that differ by at most this from a planned pose are at it [rad].
  double poseTolerance() const { return status_.pose_tolerance; }
  /// What a capture averages, at least and at most [s]; both zero before the first status.
  double shortestCapture() const { return status_.shortest_capture; }
  double longestCapture() const { return status_.longest_capture; }
  /// Whether the node captures every dwell by itself.
  bool capturesByItself() const { return status_.auto_capture != 0; }

  /// What to do next, in words.
  std::string nextStep() const;
  /// Parameters in force: revision, and where they come from.
  std::string revision() const;
  std::uint32_t revisionNumber() const { return parameters_.revision; }
  /// What the calibration is worth: "Grade: good.", and why.
  std::string grade() const;
  const std::string& gradeReason() const { return status_.grade_reason; }
  bool isContradicted() const { return status_.grade == "contradicted"; }
  /// The parameters in force; what is not identified has no value to show.
  std::vector<ParameterLine> parameters() const;
  /// The parameters that the last cycle was free to change.
  std::vector<ParameterLine> estimates() const;
  /// The samples of the last cycle that are in use still, worst first; one that has both an
  /// orientation and a torque has two lines. Then those in use that it did not consider.
  std::vector<SampleLine> samples() const;
  /// True, once, when samples are in use that were not received, or were taken away: then the list
  /// of those in use must be asked for.
  bool takeRequestForSamples();
  /// Without an answer: the request stands again.
  void repeatRequestForSamples();
  /// Error before the first and after each iteration of the last cycle, in the unit of the title.
  std::vector<double> errorHistory() const;
  /// Name of the last cycle, and of its error with unit.
  std::string historyTitle() const;

 private:
  struct Heard {
    HealthLine line;
    ros::WallTime at;
  };

  std::string prefix_;
  msg::CalibrationStatus status_;
  msg::CalibrationReport report_;  ///< of the last cycle or validation
  msg::ActuatorParameters parameters_;
  std::vector<SampleLine> linesOfReport() const;

  std::optional<SampleMirror> samples_;  ///< in use, since the first status
  std::map<std::string, Heard> heard_;
};

}  // namespace sac
