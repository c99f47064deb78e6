#pragma once

#include <string>

#include <SQLiteCpp/Database.h>

#include "spherical_actuator_calibration/actuator/description_file.hpp"
#include "spherical_actuator_calibration/estimation/laboratory_effects.hpp"

/// Table unit: whom the database belongs to (doc/session_database.md). Throws SQLite::Exception.
namespace sac::unit_table {

/// Throws ConfigError when the description is not valid.
void insert(const SQLite::Database& database,
            const CalibratedDescription& start,
            const EffectSelection& effects);
/// Throws DataError unless the database belongs to this unit, to this description of it, the
/// workspace and the record of its calibration aside, and to these laboratory effects.
void check(const SQLite::Database& database,
           const std::string& path,
           const CalibratedDescription& start,
           const EffectSelection& effects);

}  // namespace sac::unit_table
