#pragma once

#include <vector>

#include <SQLiteCpp/Database.h>

#include "spherical_actuator_calibration/measurement/pose_to_measure.hpp"

/// Tables planned_poses and planned_patterns (doc/session_database.md). Throws SQLite::Exception;
/// the caller holds the transaction.
namespace sac::plan_table {

/// In the place of the one that was there; empty: none is left.
void replace(const SQLite::Database& database, const PosesToMeasure& plan);
/// In its order. Throws RowDefect where a row holds no pattern.
PosesToMeasure find(const SQLite::Database& database);

}  // namespace sac::plan_table
