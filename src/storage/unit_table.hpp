#pragma once

#include <string>

#include <SQLiteCpp/Database.h>

#include "spherical_actuator_calibration/core/description_file.hpp"

/// Table unit: whom the database belongs to (doc/session_database.md). Throws SQLite::Exception.
namespace spherical_actuator_calibration::unit_table {

/// Throws ConfigError when the description is not valid.
void insert(const SQLite::Database& database, const CalibratedDescription& start);
/// Throws DataError unless the database belongs to this unit and this description of it, the
/// workspace and the record of its calibration aside.
void check(const SQLite::Database& database,
           const std::string& path,
           const CalibratedDescription& start);

}  // namespace spherical_actuator_calibration::unit_table
