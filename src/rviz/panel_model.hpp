#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include <diagnostic_msgs/DiagnosticArray.h>
#include <ros/time.h>

#include "spherical_actuator_calibration/ActuatorParameters.h"
#include "spherical_actuator_calibration/Calibrate.h"
#include "spherical_actuator_calibration/CalibrationReport.h"
#include "spherical_actuator_calibration/CalibrationSample.h"
#include "spherical_actuator_calibration/CalibrationStatus.h"
#include "spherical_actuator_calibration/PlanPoses.h"
#include "spherical_actuator_calibration/estimation/calibration_model.hpp"
#include "spherical_actuator_calibration/ros/conversion/messages.hpp"
#include "spherical_actuator_calibration/ros/view/sample_mirror.hpp"

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
  std::string name;         ///< e.g. pole_3
  std::uint32_t count = 0;  ///< samples that tell something about it
  std::uint32_t advised = 1;
  bool done = false;  ///< identified
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

/// What a panel shows of a calibration, gathered from topics only; knows nothing of windows.
class PanelModel {
 public:
  /// `nominal` tells which poles a coil reaches; `name_space` is that of the actuator, with or
  /// without its slash.
  PanelModel(const Actuator& nominal, const std::string& name_space);

  void receive(const msg::CalibrationStatus& message);
  void receive(const msg::CalibrationReport& message);
  void receive(const msg::ActuatorParameters& message);
  void receive(const msg::CalibrationSample& message);
  /// Keeps what the nodes in the namespace tell.
  void receive(const diagnostic_msgs::DiagnosticArray& message, const ros::WallTime& now);

  SampleMirror& samples() { return samples_; }

  /// The four streams of measurements that the calibration node lives on. Unknown when nothing was
  /// heard for some seconds.
  std::vector<HealthLine> streams(const ros::WallTime& now) const;
  /// What else is wrong, most serious first.
  std::vector<HealthLine> troubles(const ros::WallTime& now) const;

  /// Joint, poles and coils: what has been sampled, and what is missing.
  std::vector<CoverageGroup> coverage() const;
  std::uint32_t coils() const { return static_cast<std::uint32_t>(nominal_.coils.size()); }

  /// What to do next, in words.
  std::string nextStep() const;
  /// Parameters in force: revision, and where they come from.
  std::string revision() const;
  /// How good the calibration is, in one sentence.
  std::string verdict() const;
  /// Every parameter that a cycle was free to change since the nominal ones, by the last that was.
  std::vector<ParameterLine> parameters() const;
  /// Error before the first and after each iteration of the last cycle, in the unit of the title.
  std::vector<double> errorHistory() const;
  /// Name of the last cycle, and of its error with unit.
  std::string historyTitle() const;

 private:
  struct Heard {
    HealthLine line;
    ros::WallTime at;
  };

  bool isIdentified() const;
  bool isStandardized() const;
  std::vector<CoverageBar> poleBars() const;
  std::vector<CoverageBar> coilBars() const;

  Actuator nominal_;
  std::string prefix_;
  CalibrationModel model_;
  double peak_torque_ = 0.0;  ///< largest torque per ampere of one pole and coil [N·m/A]
  msg::CalibrationStatus status_;
  bool has_status_ = false;
  msg::CalibrationReport last_;  ///< the last cycle or validation
  msg::CalibrationReport
      accepted_;  ///< the last cycle that succeeded since the parameters were nominal
  msg::ActuatorParameters parameters_;
  std::vector<std::string> order_;  ///< of the estimates' names
  std::map<std::string, msg::ParameterEstimate> estimates_;
  SampleMirror samples_;
  std::map<std::string, Heard> heard_;
};

}  // namespace sac
