#pragma once

#include <string>

namespace sac {

/// Throws DataError where something else than a file stands at a name that SQLite opens beside a
/// database, and might wait for. `path`: as errors name it; `file`: where its links lead.
void requireFilesBeside(const std::string& path,
                        const std::string& file,
                        const std::string& failure);

}  // namespace sac
