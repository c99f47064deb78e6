#pragma once

#include <string>

namespace sac {

/// Makes the names in a folder survive a power failure. Some file systems cannot sync a folder;
/// then nothing happens.
void syncFolder(const std::string& folder);

}  // namespace sac
