#pragma once

#include <string>
#include <vector>

#include <SQLiteCpp/Database.h>

#include "spherical_actuator_calibration/motion/motion_slice.hpp"

/// Table motion_windows (doc/session_database.md). Throws SQLite::Exception; the caller holds the
/// transaction.
namespace sac::motion_table {

/// The oldest windows make room for it where all of them have more than so many bytes.
constexpr std::int64_t kMostBytes = 20'000'000;

void insert(const SQLite::Database& database, const MotionSlice& slice, const std::string& date);
/// Oldest first. Throws RowDefect where a row holds no window.
std::vector<MotionSlice> all(const SQLite::Database& database);
void clear(const SQLite::Database& database);

}  // namespace sac::motion_table
