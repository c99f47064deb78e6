#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <SQLiteCpp/Database.h>

#include "spherical_actuator_calibration/calibration/calibration_report.hpp"

/// Table cycles and those of its parts, cycle_... (doc/session_database.md).
/// Throws SQLite::Exception; the caller holds the transaction.
namespace sac::cycle_table {

/// Returns the id of the new row. `in_force`: the revision that was so when the cycle was run.
std::int64_t insert(const SQLite::Database& database,
                    const CycleReport& report,
                    std::uint32_t in_force,
                    const std::string& software,
                    const std::string& date);
/// To rows of formats before 10, which had none.
void addErrorUnits(const SQLite::Database& database);
std::optional<CycleReport> last(const SQLite::Database& database);
/// Precondition: there is a row with this id.
CycleReport find(const SQLite::Database& database, std::int64_t id);

}  // namespace sac::cycle_table
