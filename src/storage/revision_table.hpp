#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include <SQLiteCpp/Database.h>

#include "spherical_actuator_calibration/storage/revision.hpp"

/// Table revisions (doc/session_database.md). Throws SQLite::Exception; the caller holds the
/// transaction.
namespace sac::revision_table {

/// What led to a revision.
struct Lineage {
  std::optional<std::uint32_t> predecessor;  ///< the revision that it rests on
  std::optional<std::int64_t> cycle;         ///< id of the cycle that made it from there
};

void insert(const SQLite::Database& database, const Revision& revision, const Lineage& lineage);
/// Throws DataError when there is none: the file is damaged.
std::uint32_t newestNumber(const SQLite::Database& database);
std::optional<Revision> find(const SQLite::Database& database, std::uint32_t number);
/// Oldest first.
std::vector<RevisionSummary> all(const SQLite::Database& database);
/// Ids of the cycles that led to a revision, and of those that failed meanwhile, in their order.
std::vector<std::int64_t> cyclesOf(const SQLite::Database& database, std::uint32_t number);
/// Number of the last one that the cycle motion made, of those that led to a revision.
std::optional<std::uint32_t> lastOfMotion(const SQLite::Database& database, std::uint32_t number);

}  // namespace sac::revision_table
