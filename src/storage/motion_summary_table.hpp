#pragma once

#include <cstdint>
#include <optional>

#include <SQLiteCpp/Database.h>

#include "spherical_actuator_calibration/motion/motion_summary.hpp"

/// Tables cycle_motions, cycle_windows_left_out and cycle_windows_held_out
/// (doc/session_database.md). Throws SQLite::Exception; the caller holds the transaction.
namespace sac::motion_summary_table {

void insert(const SQLite::Database& database, std::int64_t cycle, const MotionSummary& summary);
/// Nothing where the cycle has none.
std::optional<MotionSummary> find(const SQLite::Database& database, std::int64_t cycle);

}  // namespace sac::motion_summary_table
