#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include <SQLiteCpp/Database.h>

#include "spherical_actuator_calibration/measurement/sample.hpp"

/// Tables samples and sample_currents (doc/session_database.md). Throws SQLite::Exception; the
/// caller holds the transaction.
namespace sac::sample_table {

void insert(const SQLite::Database& database, const Sample& sample, const std::string& date);
std::vector<Sample> inUse(const SQLite::Database& database);
/// Marks one sample; false when none in use has this id.
bool remove(const SQLite::Database& database, std::uint32_t id, const std::string& date);
/// Marks all samples in use; returns how many.
std::size_t clear(const SQLite::Database& database, const std::string& date);
std::uint32_t nextId(const SQLite::Database& database);

}  // namespace sac::sample_table
