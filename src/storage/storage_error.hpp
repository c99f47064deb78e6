#pragma once

#include <string>

#include <SQLiteCpp/Exception.h>

namespace sac {

/// Throws DataError for an error of SQLite: the file, what failed ("Sample 3 was not stored"), why,
/// and what to do.
[[noreturn]] void throwStorageError(const std::string& path,
                                    const std::string& failure,
                                    const SQLite::Exception& error);

/// Throws DataError: the database at `path` is damaged, as `finding` tells.
[[noreturn]] void throwDamaged(const std::string& path, const std::string& finding);

}  // namespace sac
