#include "panel_model.hpp"

#include <algorithm>
#include <cmath>

#include <diagnostic_msgs/DiagnosticStatus.h>

#include "spherical_actuator_calibration/assessment/sample_coverage.hpp"
#include "spherical_actuator_calibration/base/error.hpp"
#include "spherical_actuator_calibration/base/text_format.hpp"
#include "spherical_actuator_calibration/estimation/estimation_problem.hpp"
#include "spherical_actuator_calibration/ros/conversion/messages.hpp"
#include "spherical_actuator_calibration/ros/conversion/msg_conversion.hpp"

namespace sac {
namespace {

/// Diagnostics come every second; after this they are old [s].
constexpr double kLongestSilence = 3.5;

/// Topics of the measurements, in the order of the wires.
constexpr const char* kStreams[] = {
    "joint_states", "coil_currents", "measured_orientation", "measured_torque"};

// What a bar needs to be full: as the node's advice on the next step counts.
constexpr std::uint32_t kAdvisedOrientations = 10;
constexpr std::uint32_t kAdvisedPerPole = 3;
constexpr std::uint32_t kAdvisedPerCoil = 4;

// Expected errors over the workspace up to which a calibration is called good, or fair.
constexpr double kGoodOrientation = 1e-3;  // [rad]
constexpr double kFairOrientation = 5e-3;
constexpr double kGoodTorque = 0.01;  // of the largest torque per ampere
constexpr double kFairTorque = 0.05;

HealthLine::Level levelOf(int level) {
  using diagnostic_msgs::DiagnosticStatus;
  if (level == DiagnosticStatus::OK) {
    return HealthLine::Level::kGood;
  }
  return level == DiagnosticStatus::WARN ? HealthLine::Level::kWarning : HealthLine::Level::kError;
}

std::string withoutSlash(const std::string& name_space) {
  const std::size_t start = name_space.find_first_not_of('/');
  return start == std::string::npos ? "" : name_space.substr(start) + "/";
}

double peakOf(const TorqueCurve& curve) {
  constexpr int kSteps = 500;
  double peak = 0.0;
  for (int n = 1; n <= kSteps; ++n) {
    peak = std::max(peak, std::abs(curve.value(n * curve.supportEnd() / kSteps)));
  }
  return peak;
}

bool isAngle(const std::string& parameter) {
  const auto ends = [&](const std::string& end) {
    return parameter.size() > end.size() &&
           parameter.compare(parameter.size() - end.size(), end.size(), end) == 0;
  };
  return ends("/offset") || ends("/axis_u") || ends("/axis_v") || ends("/polar") ||
         ends("/azimuth");
}

std::string cycleName(const msg::CalibrationReport& report) {
  if (report.cycle == msg::CalibrationReport::REFINE) {
    return "Refinement";
  }
  if (report.cycle == msg::CalibrationReport::JOINT) {
    return "Joint";
  }
  return (report.cycle == msg::CalibrationReport::POLES ? "Poles with coil " : "Coil ") +
         std::to_string(report.coil);
}

/// A malformed sample is somebody else's error, and nothing to show.
void append(const msg::CalibrationSample& message, std::vector<Sample>& samples) {
  try {
    samples.push_back(sampleFromRos(message));
  } catch (const Error&) {
    return;
  }
}

std::string gradeOf(double orientation, double torque) {
  if (orientation <= kGoodOrientation && torque <= kGoodTorque) {
    return "good";
  }
  return orientation <= kFairOrientation && torque <= kFairTorque ? "fair" : "poor";
}

}  // namespace

PanelModel::PanelModel(const Actuator& nominal, const std::string& name_space)
    : nominal_(nominal), prefix_(withoutSlash(name_space)), model_(ParameterSpace(nominal)) {
  if (model_.hasTorqueModel()) {
    peak_torque_ = peakOf(model_.curve());
  }
}

void PanelModel::receive(const msg::CalibrationStatus& message) {
  status_ = message;
  has_status_ = true;
  samples_.receive(message);
}

void PanelModel::receive(const msg::CalibrationReport& message) {
  last_ = message;
  if (message.success == 0) {
    return;
  }
  accepted_ = message;
  for (const msg::ParameterEstimate& estimate : message.estimates) {
    if (estimates_.find(estimate.name) == estimates_.end()) {
      order_.push_back(estimate.name);
    }
    estimates_[estimate.name] = estimate;
  }
}

void PanelModel::receive(const msg::ActuatorParameters& message) {
  parameters_ = message;
  // Of other than identified parameters the topics tell no uncertainty.
  if (message.source != msg::ActuatorParameters::IDENTIFIED) {
    accepted_ = msg::CalibrationReport();
    estimates_.clear();
    order_.clear();
  }
}

void PanelModel::receive(const msg::CalibrationSample& message) {
  samples_.receive(message);
}

void PanelModel::receive(const diagnostic_msgs::DiagnosticArray& message,
                         const ros::WallTime& now) {
  for (const diagnostic_msgs::DiagnosticStatus& status : message.status) {
    if (status.name.compare(0, prefix_.size(), prefix_) == 0) {
      const std::string name = status.name.substr(prefix_.size());
      heard_[name] = {{name, levelOf(status.level), status.message}, now};
    }
  }
}

std::vector<HealthLine> PanelModel::streams(const ros::WallTime& now) const {
  std::vector<HealthLine> lines;
  for (const char* const stream : kStreams) {
    HealthLine line = {stream, HealthLine::Level::kUnknown, "nothing was heard of it"};
    const auto place = heard_.find(std::string("calibration: ") + stream);
    if (place != heard_.end() && (now - place->second.at).toSec() < kLongestSilence) {
      line.level = place->second.line.level;
      line.message = place->second.line.message;
    }
    lines.push_back(line);
  }
  return lines;
}

std::vector<HealthLine> PanelModel::troubles(const ros::WallTime& now) const {
  std::vector<HealthLine> lines;
  for (const auto& [name, heard] : heard_) {
    if (heard.line.level == HealthLine::Level::kGood) {
      continue;
    }
    if ((now - heard.at).toSec() < kLongestSilence) {
      lines.push_back(heard.line);
    }
  }
  std::stable_sort(lines.begin(), lines.end(), [](const HealthLine& one, const HealthLine& other) {
    return one.level > other.level;
  });
  return lines;
}

std::vector<CoverageGroup> PanelModel::coverage() const {
  std::vector<CoverageGroup> groups = {{"Joint",
                                        {{"orientations",
                                          status_.orientation_samples,
                                          kAdvisedOrientations,
                                          status_.joint_done != 0}}}};
  if (model_.hasTorqueModel()) {
    groups.push_back({"Poles", poleBars()});
    groups.push_back({"Coils", coilBars()});
  }
  return groups;
}

std::vector<CoverageBar> PanelModel::poleBars() const {
  std::vector<Sample> samples;
  samples.reserve(samples_.samples().size());
  for (const auto& [id, message] : samples_.samples()) {
    if (message.current.size() == nominal_.coils.size() || message.has_torque == 0) {
      append(message, samples);
    }
  }
  const SampleCoverage seen = sampleCoverage(model_,
                                             samples,
                                             model_.space().coordinatesOf(nominal_),
                                             EstimationOptions{}.current_threshold);
  std::vector<CoverageBar> bars;
  bars.reserve(seen.poles.size());
  for (std::size_t i = 0; i < seen.poles.size(); ++i) {
    const std::string name = "pole_" + std::to_string(i + 1);
    const auto estimate = estimates_.find(name + "/polar");
    const bool is_done =
        isIdentified() && estimate != estimates_.end() && estimate->second.observable != 0;
    bars.push_back({name, seen.poles[i], kAdvisedPerPole, is_done});
  }
  return bars;
}

std::vector<CoverageBar> PanelModel::coilBars() const {
  std::vector<CoverageBar> bars;
  bars.reserve(nominal_.coils.size());
  for (std::size_t j = 0; j < nominal_.coils.size(); ++j) {
    const bool is_told = j < status_.torque_samples.size();
    const bool is_done = j < status_.coil_done.size() && status_.coil_done[j] != 0;
    bars.push_back({"coil_" + std::to_string(j + 1),
                    is_told ? status_.torque_samples[j] : 0U,
                    kAdvisedPerCoil,
                    is_done});
  }
  return bars;
}

std::string PanelModel::nextStep() const {
  return has_status_ ? status_.next_step : "Waiting for the calibration node.";
}

std::string PanelModel::revision() const {
  if (parameters_.source.empty()) {
    return "no parameters yet";
  }
  return "revision " + std::to_string(parameters_.revision) + ", " + parameters_.source;
}

std::string PanelModel::verdict() const {
  if (parameters_.source == msg::ActuatorParameters::RESTORED) {
    return "Restored: run a cycle, or see the saved report, for the uncertainty.";
  }
  if (!isIdentified()) {
    return "Not calibrated.";
  }
  std::string text =
      format("Orientation known to %.2g mrad", 1e3 * accepted_.orientation_uncertainty);
  double torque = 0.0;
  if (accepted_.torque_uncertainty > 0.0 && peak_torque_ > 0.0) {
    torque = accepted_.torque_uncertainty / peak_torque_;
    text += format(", torque to %.2g %%", 100.0 * torque);
  }
  text += ": " + gradeOf(accepted_.orientation_uncertainty, torque) + ".";
  const auto open = std::count_if(estimates_.begin(), estimates_.end(), [](const auto& item) {
    return item.second.observable == 0;
  });
  if (open > 0) {
    text += format(" %td of %zu parameters are not identified.", open, estimates_.size());
  }
  return text;
}

// A report may outlive its parameters: after a reset it is still the last one.
bool PanelModel::isIdentified() const {
  return parameters_.source == msg::ActuatorParameters::IDENTIFIED && !estimates_.empty();
}

std::vector<ParameterLine> PanelModel::parameters() const {
  if (!isIdentified()) {
    return {};
  }
  std::vector<ParameterLine> lines;
  lines.reserve(order_.size());
  for (const std::string& name : order_) {
    const msg::ParameterEstimate& estimate = estimates_.at(name);
    if (estimate.observable == 0 || !std::isfinite(estimate.stddev)) {
      lines.push_back({name, "–", "not identified"});
    } else if (isAngle(name)) {
      lines.push_back(
          {name, format("%.5f rad", estimate.value), format("± %.3f mrad", 1e3 * estimate.stddev)});
    } else {
      lines.push_back({name, format("%.5g", estimate.value), format("± %.2g", estimate.stddev)});
    }
  }
  return lines;
}

std::vector<double> PanelModel::errorHistory() const {
  std::vector<double> errors = last_.error_history;
  if (!isStandardized()) {
    for (double& error : errors) {
      error *= 1e3;
    }
  }
  return errors;
}

// Orientations and torques together have no common unit.
bool PanelModel::isStandardized() const {
  return last_.cycle == msg::CalibrationReport::REFINE && status_.orientation_samples > 0;
}

std::string PanelModel::historyTitle() const {
  if (last_.cycle.empty()) {
    return "No cycle has run";
  }
  if (isStandardized()) {
    return cycleName(last_) + ": standardised residuals [1]";
  }
  const bool is_joint = last_.cycle == msg::CalibrationReport::JOINT;
  return cycleName(last_) + (is_joint ? ": orientation error [mrad]" : ": torque error [mN·m]");
}

}  // namespace sac
