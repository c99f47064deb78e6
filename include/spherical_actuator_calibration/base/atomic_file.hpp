#pragma once

#include <string>

namespace sac {

/// What to do with a file that is there already.
enum class OverwritePolicy { kRefuse, kReplace };

/// Writes a file so that it is there with its whole content or, whatever happens, as before: into a
/// temporary file in the same folder, to the disk, then under its name. A replaced file keeps its
/// permissions; a symbolic link is replaced by the file.
///
/// Throws DataError when the file exists and the policy refuses, when `path` is something else than
/// a regular file (a folder, a device), or when folder or disk do not take it. The temporary file
/// is gone then.
void writeFileAtomically(const std::string& path,
                         const std::string& content,
                         OverwritePolicy policy);

}  // namespace sac
