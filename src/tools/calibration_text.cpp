#include "calibration_text.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "spherical_actuator_calibration/assessment/sample_influence.hpp"
#include "spherical_actuator_calibration/assessment/torque_linearity.hpp"
#include "spherical_actuator_calibration/base/normal_distribution.hpp"
#include "spherical_actuator_calibration/base/text_format.hpp"
#include "spherical_actuator_calibration/calibration/cycle_selection.hpp"

namespace sac {
namespace {

/// Errors in thousandths of their unit, "[mrad]"; standardized ones as they are.
std::string errorHistory(const CycleReport& report) {
  const bool standardized = report.error_measure == ErrorMeasure::kStandardized;
  std::string text;
  switch (report.error_measure) {
    case ErrorMeasure::kOrientation:
      text = "mean orientation error [mrad]:";
      break;
    case ErrorMeasure::kTorque:
      text = "rms torque error [mN.m]:";
      break;
    case ErrorMeasure::kStandardized:
      text = "rms standardized error [1]:";
      break;
  }
  for (const double error : report.error_history) {
    text += format(" %.4g", standardized ? error : 1e3 * error);
  }
  return text;
}

std::string rms(const CycleReport& report) {
  std::string text;
  if (const auto orientation = residualRms(report, Quantity::kOrientation)) {
    text += format(", orientation rms %.4g mrad", 1e3 * *orientation);
  }
  if (const auto torque = residualRms(report, Quantity::kTorque)) {
    text += format(", torque rms %.4g mN.m", 1e3 * *torque);
  }
  return text;
}

std::string rejectedLine(const SampleResidual& residual, Cycle cycle) {
  return format("  rejected: %s %u, ", cycle == Cycle::kMotion ? "window" : "sample", residual.id) +
         (residual.quantity == Quantity::kOrientation ? "orientation" : "torque") + ": " +
         residual.reason + "\n";
}

/// "torque of sample 53"
std::string observationName(const SampleInfluence& influence) {
  return format("%s of sample %u",
                influence.quantity == Quantity::kOrientation ? "orientation" : "torque",
                influence.id);
}

/// Names one of the samples that nothing checks.
std::string irreplaceableSentence(const std::vector<SampleInfluence>& influences) {
  const auto is_sole = [](const SampleInfluence& influence) { return influence.irreplaceable; };
  const auto first = std::find_if(influences.begin(), influences.end(), is_sole);
  if (first == influences.end()) {
    return {};
  }
  return format(
      "%td measurements are irreplaceable: without the %s, for one, %s could not be told.\n",
      std::count_if(influences.begin(), influences.end(), is_sole),
      observationName(*first).c_str(),
      first->parameter.c_str());
}

struct Row {
  ParameterEstimate parameter;
  std::optional<double> truth;
};

std::vector<Row> rowsOf(const CalibrationSession& session, const std::optional<Actuator>& truth) {
  std::vector<Row> rows;
  for (const ParameterEstimate& parameter : session.parameters()) {
    rows.push_back({parameter, std::nullopt});
  }
  if (truth) {
    const ParameterSpace& space = session.model().space();
    const Eigen::VectorXd values = space.reportedValues(space.coordinatesOf(*truth));
    // What the laboratory adds is not in a description of axes.
    for (Eigen::Index p = 0; p < space.effect(); ++p) {
      rows[static_cast<std::size_t>(p)].truth = values[p];
    }
  }
  return rows;
}

/// Whether the parameter has a value with an uncertainty: one that takes part in an open direction
/// has, though it is not identified.
bool hasValue(const ParameterEstimate& parameter) {
  return parameter.observable || parameter.value != parameter.nominal;
}

double errorOf(const Row& row) {
  return row.parameter.value - *row.truth;
}

std::string rowText(const Row& row) {
  constexpr double kSmall = 1e-5;
  const ParameterEstimate& p = row.parameter;
  std::string text = format("%-18s %12.6f", p.name.c_str(), p.nominal);
  if (!hasValue(p)) {
    text += format(" %16s %13s %11s", "not identified", "-", "-");
  } else {
    // Inertia and delays are small beside angles.
    const double change = 1e3 * (p.value - p.nominal);
    text += p.unit == "rad" || p.stddev >= kSmall
                ? format(" %16.6f %13.3f %11.3f", p.value, change, 1e3 * p.stddev)
                : format(" %16.6g %13.4g %11.2g", p.value, change, 1e3 * p.stddev);
  }
  if (row.truth) {
    text += format(" %12.6f", *row.truth);
    text += hasValue(p) ? format(" %13.3f %10.2f", 1e3 * errorOf(row), errorOf(row) / p.stddev)
                        : format(" %13s %10s", "-", "-");
  }
  return text + "  " + p.unit + "\n";
}

std::string coverageLine(const std::vector<Row>& rows) {
  int identified = 0;
  int covered = 0;
  for (const Row& row : rows) {
    if (row.parameter.observable && row.truth) {
      ++identified;
      covered += std::abs(errorOf(row)) <= kTwoSided95 * row.parameter.stddev ? 1 : 0;
    }
  }
  if (identified == 0) {
    return "No parameter whose truth is known is identified.\n";
  }
  return format(
      "The 95 %% interval holds the truth for %d of %d identified parameters (%.1f %%).\n",
      covered,
      identified,
      100.0 * covered / identified);
}

}  // namespace

std::string cycleParagraph(const CycleReport& report) {
  std::string text = cycleText({report.cycle, report.coil}) +
                     (report.success ? ": " : ": FAILED. ") + report.message + "\n";
  if (!report.success) {
    return text;
  }
  text += "  " + errorHistory(report) + "\n";
  text += format("  reduced chi-square %.3g, condition number %.3g",
                 report.reduced_chi_square,
                 report.condition_number) +
          rms(report) + "\n";
  for (const SampleResidual& residual : report.residuals) {
    if (residual.rejected) {
      text += rejectedLine(residual, report.cycle);
    }
  }
  return text;
}

std::string influenceParagraph(const CalibrationSession& session) {
  const std::vector<SampleInfluence> influences = sampleInfluences(session);
  if (influences.empty()) {
    return {};
  }
  const auto most = std::max_element(
      influences.begin(), influences.end(), [](const SampleInfluence& a, const SampleInfluence& b) {
        return a.largest_shift < b.largest_shift;
      });
  return format(
             "Most influential: the %s; without it %s would move by %.2g of its standard "
             "deviations.\n",
             observationName(*most).c_str(),
             most->parameter.c_str(),
             most->largest_shift) +
         irreplaceableSentence(influences);
}

std::string linearityParagraph(const CalibrationSession& session) {
  const std::vector<Sample>& samples = session.samples();
  const bool has_torque = std::any_of(
      samples.begin(), samples.end(), [](const Sample& sample) { return sample.has_torque; });
  return has_torque ? describe(torqueLinearity(samples, session.config())) + "\n" : "";
}

std::string validationParagraph(const HeldOutValidation& validation) {
  return "Validation: " + verdict(validation) + "\n";
}

std::string openParagraph(const CalibrationSession& session) {
  const std::vector<std::string> open = session.openParameters();
  std::string held;
  std::string relative;
  for (const ParameterEstimate& parameter : session.parameters()) {
    if (std::find(open.begin(), open.end(), parameter.name) != open.end()) {
      std::string& list = hasValue(parameter) ? relative : held;
      list += " ";
      list += parameter.name;
    }
  }
  std::string text;
  if (!held.empty()) {
    text += "Not observable, left as they were:" + held + "\n";
  }
  if (!relative.empty()) {
    text += "Not identified, known only relative to each other:" + relative + "\n";
  }
  return text;
}

std::string parameterTable(const CalibrationSession& session,
                           const std::optional<Actuator>& truth) {
  std::string text = format("%-18s %12s %16s %13s %11s",
                            "parameter",
                            "nominal",
                            "identified",
                            "change [e-3]",
                            "std [e-3]");
  text += truth ? format(" %12s %13s %10s", "truth", "error [e-3]", "error/std") : "";
  text += "  unit\n";
  const std::vector<Row> rows = rowsOf(session, truth);
  for (const Row& row : rows) {
    text += rowText(row);
  }
  return truth ? text + coverageLine(rows) : text;
}

}  // namespace sac
