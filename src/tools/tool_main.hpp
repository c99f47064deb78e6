#pragma once

#include <functional>
#include <string>

#include "spherical_actuator_calibration/base/atomic_file.hpp"

namespace sac {

/// Exit status of tools, beside their own: done; bad usage or unreadable input.
inline constexpr int kToolSuccess = 0;
inline constexpr int kToolUnusable = 2;

/// The main function of a tool: the status that `body` returns, or kToolUnusable, with "name:
/// message" on the standard error, when it throws, or when what it printed cannot be written.
int runTool(const char* name, const std::function<int()>& body);

/// Shows the share done on a terminal, "what  37 %", and nothing anywhere else.
std::function<void(double)> terminalProgress(const std::string& what);

/// Throws DataError when the file is there and must not be replaced: nothing is computed for a file
/// that could not be written in the end.
void requireNewFile(const std::string& path, OverwritePolicy policy);

}  // namespace sac
