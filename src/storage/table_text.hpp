#pragma once

#include <map>
#include <set>
#include <string>

#include <SQLiteCpp/Database.h>

namespace sac {

/// By name of a table, what its SQL consists of: the words before its columns, each column or
/// constraint, the words after them.
using TableTexts = std::map<std::string, std::set<std::string>>;

/// Of all tables of a database.
TableTexts tableTexts(const SQLite::Database& database);

/// Finds what the tables of a session are not made of: a view or trigger, an index that somebody
/// made, or a table of which a part is not among those that `own` has for it. Says what it is, such
/// as `the trigger "x"`; empty where there is none. What has fewer columns than `own` passes.
std::string foreignObject(const SQLite::Database& database, const TableTexts& own);

}  // namespace sac
