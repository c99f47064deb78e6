#include "spherical_actuator_calibration/assessment/covariance_file.hpp"

#include <vector>

#include "spherical_actuator_calibration/assessment/reported_covariance.hpp"
#include "spherical_actuator_calibration/base/yaml_writer.hpp"
#include "spherical_actuator_calibration/estimation/distributions.hpp"
#include "uncertainty_budget.hpp"

namespace sac {
namespace {

/// Shares of each parameter's variance, a row each, a column for each source.
void writeBudget(YamlWriter& writer, const CalibrationSession& session) {
  const std::vector<BudgetEntry> budget = uncertaintyBudget(session);
  if (budget.empty()) {
    return;
  }
  const Eigen::MatrixXd shares = budgetShares(budget);
  std::vector<std::string> sources;
  sources.reserve(budget.size());
  for (const BudgetEntry& entry : budget) {
    sources.push_back(yamlText(entry.source));
  }
  std::vector<std::string> rows;
  for (Eigen::Index p = 0; p < shares.rows(); ++p) {
    const Eigen::RowVectorXd row = shares.row(p);
    rows.push_back(yamlNumbers(row));
  }
  writer.map(1, "budget");
  writer.line(2,
              "# share of each parameter's variance (rows, as above) from each source (columns)");
  writer.entry(2, "sources", yamlList(sources));
  writer.list(2, "shares", rows);
}

const CycleReport* lastSuccess(const CalibrationSession& session) {
  const CycleReport* last = nullptr;
  for (const CycleReport& report : session.reports()) {
    last = report.success ? &report : last;
  }
  return last;
}

}  // namespace

int degreesOfFreedom(const CalibrationSession& session) {
  const CycleReport* last = lastSuccess(session);
  return last == nullptr ? 0 : last->degrees_of_freedom;
}

double coverageFactor(const CalibrationSession& session) {
  constexpr double kUpper = 0.975;
  constexpr double kWidened = 1.0;
  const CycleReport* last = lastSuccess(session);
  if (last == nullptr || last->degrees_of_freedom <= 0 || last->reduced_chi_square <= kWidened) {
    return normalQuantile(kUpper);
  }
  return studentQuantile(last->degrees_of_freedom, kUpper);
}

std::string renderCovariance(const CalibrationSession& session) {
  std::vector<std::string> names;
  std::vector<std::string> units;
  std::vector<double> values;
  for (const ParameterEstimate& parameter : session.parameters()) {
    names.push_back(yamlText(parameter.name));
    units.push_back(yamlText(parameter.unit));
    values.push_back(parameter.value);
  }
  const Eigen::MatrixXd covariance = reportedCovariance(session);
  std::vector<std::string> rows;
  for (Eigen::Index p = 0; p < covariance.rows(); ++p) {
    const Eigen::RowVectorXd row = covariance.row(p);
    rows.push_back(yamlNumbers(row));
  }
  YamlWriter writer;
  writer.map(0, "covariance");
  writer.entry(1, "actuator", yamlText(session.start().actuator.name));
  writer.entry(1, "serial", yamlText(session.start().actuator.serial));
  writer.line(1, "# entry (a, b) of the matrix: in the unit of a times that of b");
  writer.entry(1, "names", yamlList(names));
  writer.entry(1, "units", yamlList(units));
  writer.entry(1, "values", yamlNumbers(values));
  writer.list(1, "matrix", rows);
  writer.line(1, "# value +- coverage_factor times standard deviation holds 95 %");
  writer.entry(1, "coverage_factor", yamlNumber(coverageFactor(session)));
  writer.entry(1, "degrees_of_freedom", std::to_string(degreesOfFreedom(session)));
  writeBudget(writer, session);
  return writer.text();
}

}  // namespace sac
