#pragma once

#include <string>

namespace sac {

/// SHA-256 of a file's content: "sha256:" and 64 hexadecimal digits. Reads the file piece by piece.
/// Throws DataError that names the file when it cannot be read.
std::string fileChecksum(const std::string& path);

}  // namespace sac
