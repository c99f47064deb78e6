#include "panel_model.hpp"

#include <algorithm>
#include <cmath>
#include <set>

#include <diagnostic_msgs/DiagnosticStatus.h>

#include "sample_place.hpp"
#include "shown_unit.hpp"
#include "spherical_actuator_calibration/base/numbering.hpp"

namespace sac {
namespace {

/// Diagnostics come every second; after this they are old [s].
constexpr double kLongestSilence = 3.5;

/// Topics of the measurements, in the order of the wires.
constexpr const char* kStreams[] = {
    "joint_states", "coil_currents", "measured_orientation", "measured_torque"};

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

/// "joint", 1 → "joint_1"
std::string numbered(const std::string& name, std::size_t index) {
  return name + "_" + std::to_string(numberOf(index));
}

ParameterLine line(const std::string& name, double value, double stddev, const std::string& unit) {
  if (!std::isfinite(stddev)) {
    return {name, "–", "not identified"};
  }
  const ShownUnit shown = shownIn(unit);
  // Delays and inertia are small beside angles, torques and gains.
  const char* const format = shown.name == unit && !unit.empty() ? "%.5g" : "%.5f";
  return {name,
          withUnit(format, value, unit == "1" ? "" : unit),
          "± " + withUnit(shown.format, shown.factor * stddev, shown.name)};
}

/// A direction has two deviations, across it.
ParameterLine axisLine(const std::string& name, const msg::JointAxis& joint) {
  const double worse = std::max(joint.axis_stddev[0], joint.axis_stddev[1]);
  if (!std::isfinite(worse)) {
    return {name, "–", "not identified"};
  }
  return {name,
          number("%.4f, ", joint.axis.x) + number("%.4f, ", joint.axis.y) +
              number("%.4f", joint.axis.z),
          "± " + number("%.3f mrad", 1e3 * worse)};
}

template <typename Axis>
void addAxis(const std::string& name, const Axis& axis, std::vector<ParameterLine>& lines) {
  lines.push_back(line(name + "/polar", axis.polar, axis.polar_stddev, "rad"));
  lines.push_back(line(name + "/azimuth", axis.azimuth, axis.azimuth_stddev, "rad"));
  // Gains are identified where the configuration models them only.
  if (std::isfinite(axis.gain_stddev)) {
    lines.push_back(line(name + "/gain", axis.gain, axis.gain_stddev, "1"));
  }
}

std::vector<CoverageBar> bars(const std::string& name, const std::vector<msg::Coverage>& coverage) {
  std::vector<CoverageBar> result;
  result.reserve(coverage.size());
  for (std::size_t n = 0; n < coverage.size(); ++n) {
    result.push_back({numbered(name, n), coverage[n]});
  }
  return result;
}

std::string cycleName(const msg::CalibrationReport& report) {
  return report.coil == 0 ? report.cycle : report.cycle + ", coil " + std::to_string(report.coil);
}

/// A sample that the last cycle did not consider.
SampleLine lineWithoutCycle(const msg::CalibrationSample& sample, double current_threshold) {
  const std::string coils = coilsOf(sample, current_threshold);
  SampleLine line;
  line.id = sample.id;
  line.quantity = coils.empty() ? "orientation" : "torque, " + coils;
  line.angles = anglesOf(sample);
  line.residual = line.standardized = "–";
  line.verdict = sample.validation != 0 ? "held out" : "not in the last cycle";
  return line;
}

}  // namespace

PanelModel::PanelModel(const std::string& name_space) : prefix_(withoutSlash(name_space)) {}

void PanelModel::receive(const diagnostic_msgs::DiagnosticArray& message,
                         const ros::WallTime& now) {
  for (const diagnostic_msgs::DiagnosticStatus& status : message.status) {
    if (status.name.compare(0, prefix_.size(), prefix_) == 0) {
      const std::string name = status.name.substr(prefix_.size());
      heard_[name] = {{name, levelOf(status.level), status.message}, now};
    }
  }
}

// Without parameters it is not known.
bool PanelModel::hasJoints() const {
  return parameters_.source.empty() || parameters_.has_joints != 0;
}

std::string PanelModel::whyNoJointCycle() const {
  return hasJoints()
             ? ""
             : "The rotor has no joints: the tracker alone tells its orientation, and level "
               "1 has nothing to calibrate. Begin with poles and coils.";
}

std::vector<HealthLine> PanelModel::streams(const ros::WallTime& now) const {
  std::vector<HealthLine> lines;
  for (const char* const stream : kStreams) {
    if (!hasJoints() && stream == kStreams[0]) {
      continue;
    }
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
  std::vector<CoverageGroup> groups;
  if (hasJoints()) {
    groups.push_back({"Joint", {{"orientations", status_.joint}}});
  }
  if (!status_.poles.empty()) {
    groups.push_back({"Poles", bars("pole", status_.poles)});
    groups.push_back({"Coils", bars("coil", status_.coils)});
  }
  return groups;
}

std::string PanelModel::nextStep() const {
  return status_.next_step.empty() ? "Waiting for the calibration node." : status_.next_step;
}

std::string PanelModel::revision() const {
  if (parameters_.source.empty()) {
    return "no parameters yet";
  }
  return "revision " + std::to_string(parameters_.revision) + ", " + parameters_.source;
}

std::string PanelModel::grade() const {
  return status_.grade.empty() ? "" : "Grade: " + status_.grade + ".";
}

std::vector<ParameterLine> PanelModel::parameters() const {
  if (parameters_.source.empty()) {
    return {};
  }
  std::vector<ParameterLine> lines;
  for (std::size_t k = 0; hasJoints() && k < parameters_.joints.size(); ++k) {
    const msg::JointAxis& joint = parameters_.joints[k];
    const std::string name = numbered("joint", k);
    lines.push_back(line(name + "/offset", joint.offset, joint.offset_stddev, "rad"));
    lines.push_back(axisLine(name + "/axis", joint));
  }
  for (std::size_t i = 0; i < parameters_.poles.size(); ++i) {
    addAxis(numbered("pole", i), parameters_.poles[i], lines);
  }
  for (std::size_t j = 0; j < parameters_.coils.size(); ++j) {
    addAxis(numbered("coil", j), parameters_.coils[j], lines);
  }
  return lines;
}

std::vector<ParameterLine> PanelModel::estimates() const {
  std::vector<ParameterLine> lines;
  lines.reserve(report_.estimates.size());
  for (const msg::ParameterEstimate& estimate : report_.estimates) {
    lines.push_back(line(estimate.name, estimate.value, estimate.stddev, estimate.unit));
  }
  return lines;
}

void PanelModel::receive(const msg::CalibrationStatus& message) {
  if (!samples_ || status_.coils.size() != message.coils.size()) {
    samples_.emplace(message.coils.size());
  }
  samples_->receive(message);
  status_ = message;
}

void PanelModel::receive(const msg::CalibrationSample& message) {
  if (samples_) {
    samples_->receive(message);
  }
}

void PanelModel::receive(const std::vector<msg::CalibrationSample>& in_use) {
  if (samples_) {
    samples_->set(in_use);
  }
}

bool PanelModel::takeRequestForSamples() {
  return samples_ && samples_->takeRequest();
}

void PanelModel::repeatRequestForSamples() {
  if (samples_) {
    samples_->repeatRequest();
  }
}

std::vector<SampleLine> PanelModel::samples() const {
  std::vector<SampleLine> lines = linesOfReport();
  // Residuals of a motion are of its windows.
  if (!samples_ || report_.cycle == msg::CalibrationReport::MOTION) {
    return lines;
  }
  const std::map<std::uint32_t, msg::CalibrationSample>& in_use = samples_->samples();
  std::set<std::uint32_t> considered;
  for (SampleLine& line : lines) {
    considered.insert(line.id);
    const auto sample = in_use.find(line.id);
    if (sample == in_use.end()) {
      continue;
    }
    line.angles = anglesOf(sample->second);
    const std::string coils = coilsOf(sample->second, status_.current_threshold);
    line.quantity += line.quantity == "torque" && !coils.empty() ? ", " + coils : "";
  }
  for (const auto& [id, sample] : in_use) {
    if (considered.count(id) == 0) {
      lines.push_back(lineWithoutCycle(sample, status_.current_threshold));
    }
  }
  return lines;
}

std::vector<SampleLine> PanelModel::linesOfReport() const {
  std::vector<msg::SampleResidual> residuals = report_.residuals;
  const auto worse = [](const msg::SampleResidual& one, const msg::SampleResidual& other) {
    return one.standardized > other.standardized;
  };
  std::stable_sort(residuals.begin(), residuals.end(), worse);
  std::vector<SampleLine> lines;
  lines.reserve(residuals.size());
  for (const msg::SampleResidual& one : residuals) {
    const ShownUnit shown = shownIn(one.unit);
    lines.push_back({one.id,
                     one.quantity,
                     "",
                     withUnit("%.3f", shown.factor * one.residual, shown.name),
                     number("%.1f", one.standardized),
                     one.rejected == 0    ? ""
                     : one.reason.empty() ? "rejected"
                                          : one.reason});
  }
  return lines;
}

std::vector<double> PanelModel::errorHistory() const {
  std::vector<double> errors = report_.error_history;
  for (double& error : errors) {
    error *= shownIn(report_.error_unit).factor;
  }
  return errors;
}

std::string PanelModel::historyTitle() const {
  if (report_.cycle.empty()) {
    return "No cycle has run";
  }
  const std::string unit = shownIn(report_.error_unit).name;
  return "Cycle " + cycleName(report_) + ": error [" + (unit.empty() ? "1" : unit) + "]";
}

}  // namespace sac
