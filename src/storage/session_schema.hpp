#pragma once

#include <string>

#include <SQLiteCpp/Database.h>

namespace sac {

/// True when the file is a session database; false when it holds nothing yet. Changes nothing.
/// Throws DataError when it is something else, of a newer version, damaged, or holds what
/// this package does not make, such as triggers.
bool hasSessionSchema(const SQLite::Database& database, const std::string& path);

/// Makes the tables of doc/session_database.md, within the caller's transaction.
void createSessionSchema(SQLite::Database& database);

/// Whether the tables are those of an earlier version.
bool isEarlierSchema(const SQLite::Database& database);
/// Brings the tables of an earlier version to the present form, without touching what they hold.
void upgradeSessionSchema(SQLite::Database& database);

}  // namespace sac
