#include "cycle_table.hpp"

#include <array>
#include <cstddef>
#include <optional>
#include <utility>

#include "motion_summary_table.hpp"
#include "row_access.hpp"
#include "spherical_actuator_calibration/actuator/cycle.hpp"
#include "spherical_actuator_calibration/base/error.hpp"
#include "spherical_actuator_calibration/base/numbering.hpp"

namespace sac::cycle_table {
namespace {

constexpr std::array<std::pair<ErrorMeasure, const char*>, 3> kErrorMeasures = {{
    {ErrorMeasure::kOrientation, "orientation"},
    {ErrorMeasure::kTorque, "torque"},
    {ErrorMeasure::kStandardized, "standardized"},
}};

constexpr std::array<std::pair<Quantity, const char*>, 2> kQuantities = {{
    {Quantity::kOrientation, "orientation"},
    {Quantity::kTorque, "torque"},
}};

[[noreturn]] void throwUnknown(const std::string& word) {
  throw RowDefect("the unknown word \"" + word + "\"");
}

template <typename Table, typename Value>
std::string wordOf(const Table& table, Value value) {
  for (const auto& [entry, word] : table) {
    if (entry == value) {
      return word;
    }
  }
  throwUnknown(std::to_string(static_cast<int>(value)));
}

template <typename Table>
auto valueOf(const Table& table, const std::string& word) {
  for (const auto& [entry, name] : table) {
    if (word == name) {
      return entry;
    }
  }
  throwUnknown(word);
}

Cycle cycleOf(const std::string& word) {
  const std::optional<Cycle> cycle = cycleNamed(word);
  if (!cycle) {
    throwUnknown(word);
  }
  return *cycle;
}

void insertErrors(const SQLite::Database& database, std::int64_t id, const CycleReport& report) {
  RowWriter row(database, "INSERT INTO cycle_errors (cycle, iteration, error) VALUES (?, ?, ?)");
  for (std::size_t n = 0; n < report.error_history.size(); ++n) {
    row.put(id).put(n).put(report.error_history[n]).write();
  }
}

void insertEstimates(const SQLite::Database& database, std::int64_t id, const CycleReport& report) {
  RowWriter row(database,
                "INSERT INTO cycle_estimates (cycle, position, name, nominal, initial, value, "
                "stddev, observable, unit) VALUES (?, ?, ?, ?, ?, ?, ?, ?, ?)");
  for (std::size_t n = 0; n < report.estimates.size(); ++n) {
    const ParameterEstimate& estimate = report.estimates[n];
    row.put(id).put(n).put(estimate.name).put(estimate.nominal).put(estimate.initial);
    row.put(estimate.value).put(estimate.stddev).put(estimate.observable);
    row.put(estimate.unit).write();
  }
}

/// Windows of motion are no samples.
const char* residualTable(Cycle cycle) {
  return cycle == Cycle::kMotion ? "cycle_window_residuals" : "cycle_residuals";
}
const char* residualColumn(Cycle cycle) {
  return cycle == Cycle::kMotion ? "window" : "sample";
}

void insertResiduals(const SQLite::Database& database, std::int64_t id, const CycleReport& report) {
  const std::string sql = std::string("INSERT INTO ") + residualTable(report.cycle) +
                          " (cycle, position, " + residualColumn(report.cycle) +
                          ", quantity, residual, standardized, rejected, reason) "
                          "VALUES (?, ?, ?, ?, ?, ?, ?, ?)";
  RowWriter row(database, sql.c_str());
  for (std::size_t n = 0; n < report.residuals.size(); ++n) {
    const SampleResidual& residual = report.residuals[n];
    row.put(id).put(n).put(residual.id).put(wordOf(kQuantities, residual.quantity));
    row.put(residual.residual).put(residual.standardized).put(residual.rejected);
    row.put(residual.reason).write();
  }
}

void insertDoubts(const SQLite::Database& database, std::int64_t id, const CycleReport& report) {
  RowWriter row(database, "INSERT INTO cycle_doubts (cycle, position, sentence) VALUES (?, ?, ?)");
  for (std::size_t n = 0; n < report.doubts.size(); ++n) {
    row.put(id).put(n).put(report.doubts[n]).write();
  }
}

void readErrors(const SQLite::Database& database, std::int64_t id, CycleReport& report) {
  RowReader row(database, "SELECT error FROM cycle_errors WHERE cycle = ? ORDER BY iteration", id);
  while (row.next()) {
    report.error_history.push_back(row.number());
  }
}

void readEstimates(const SQLite::Database& database, std::int64_t id, CycleReport& report) {
  RowReader row(database,
                "SELECT name, nominal, initial, value, stddev, observable, unit "
                "FROM cycle_estimates WHERE cycle = ? ORDER BY position",
                id);
  while (row.next()) {
    ParameterEstimate estimate;
    estimate.name = row.text();
    estimate.nominal = row.number();
    estimate.initial = row.number();
    estimate.value = row.number();
    estimate.stddev = row.number();
    estimate.observable = row.flag();
    estimate.unit = row.text();
    report.estimates.push_back(std::move(estimate));
  }
}

void readResiduals(const SQLite::Database& database, std::int64_t id, CycleReport& report) {
  const std::string sql = std::string("SELECT ") + residualColumn(report.cycle) +
                          ", quantity, residual, standardized, rejected, reason FROM " +
                          residualTable(report.cycle) + " WHERE cycle = ? ORDER BY position";
  RowReader row(database, sql.c_str(), id);
  while (row.next()) {
    SampleResidual residual;
    residual.id = row.count();
    residual.quantity = valueOf(kQuantities, row.text());
    residual.residual = row.number();
    residual.standardized = row.number();
    residual.rejected = row.flag();
    residual.reason = row.text();
    report.residuals.push_back(std::move(residual));
  }
}

void readDoubts(const SQLite::Database& database, std::int64_t id, CycleReport& report) {
  RowReader row(
      database, "SELECT sentence FROM cycle_doubts WHERE cycle = ? ORDER BY position", id);
  while (row.next()) {
    report.doubts.push_back(row.text());
  }
}

}  // namespace

std::int64_t insert(const SQLite::Database& database,
                    const CycleReport& report,
                    std::uint32_t in_force,
                    const std::string& software,
                    const std::string& date) {
  RowWriter row(database,
                "INSERT INTO cycles (date, software, cycle, coil, success, message, samples_used, "
                "samples_rejected, iterations, error_measure, reduced_chi_square, "
                "condition_number, solve_time, orientation_uncertainty, torque_uncertainty, "
                "contradicted, degrees_of_freedom, in_force, registration, error_unit) "
                "VALUES (?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?)");
  row.put(date)
      .put(software)
      .put(cycleName(report.cycle))
      .put(numberOrZero(report.coil))
      .put(report.success);
  row.put(report.message).put(report.samples_used).put(report.samples_rejected);
  row.put(report.iterations).put(wordOf(kErrorMeasures, report.error_measure));
  row.put(report.reduced_chi_square).put(report.condition_number).put(report.solve_time);
  row.put(report.orientation_uncertainty).put(report.torque_uncertainty);
  row.put(report.contradicted).put(std::int64_t{report.degrees_of_freedom}).put(in_force);
  row.put(report.registration).put(unitOf(report.error_measure)).write();
  const std::int64_t id = database.getLastInsertRowid();
  insertErrors(database, id, report);
  insertEstimates(database, id, report);
  insertDoubts(database, id, report);
  insertResiduals(database, id, report);
  if (report.motion) {
    motion_summary_table::insert(database, id, *report.motion);
  }
  return id;
}

void addErrorUnits(const SQLite::Database& database) {
  for (const auto& [measure, word] : kErrorMeasures) {
    RowWriter row(database, "UPDATE cycles SET error_unit = ? WHERE error_measure = ?");
    row.put(unitOf(measure)).put(word).write();
  }
}

std::optional<CycleReport> last(const SQLite::Database& database) {
  RowReader row(database, "SELECT id FROM cycles ORDER BY id DESC LIMIT 1");
  if (!row.next()) {
    return std::nullopt;
  }
  return find(database, row.integer());
}

CycleReport find(const SQLite::Database& database, std::int64_t id) {
  RowReader row(database,
                "SELECT cycle, coil, success, message, samples_used, samples_rejected, iterations, "
                "error_measure, reduced_chi_square, condition_number, solve_time, "
                "orientation_uncertainty, torque_uncertainty, contradicted, degrees_of_freedom, "
                "registration FROM cycles WHERE id = ?",
                id);
  row.next();
  CycleReport report;
  report.cycle = cycleOf(row.text());
  report.coil = indexOf(static_cast<std::size_t>(row.integer()));
  report.success = row.flag();
  report.message = row.text();
  report.samples_used = row.count();
  report.samples_rejected = row.count();
  report.iterations = row.count();
  report.error_measure = valueOf(kErrorMeasures, row.text());
  report.reduced_chi_square = row.number();
  report.condition_number = row.number();
  report.solve_time = row.number();
  report.orientation_uncertainty = row.number();
  report.torque_uncertainty = row.number();
  report.contradicted = row.flag();
  report.degrees_of_freedom = static_cast<int>(row.integer());
  report.registration = row.text();
  readErrors(database, id, report);
  if (report.success && report.error_history.empty()) {
    throw RowDefect("cycle " + std::to_string(id) + " has succeeded, and has no errors");
  }
  readEstimates(database, id, report);
  readResiduals(database, id, report);
  readDoubts(database, id, report);
  report.motion = motion_summary_table::find(database, id);
  return report;
}

}  // namespace sac::cycle_table
