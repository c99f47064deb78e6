#include "tool_main.hpp"

#include <cstdio>
#include <exception>
#include <filesystem>
#include <iostream>

#include "spherical_actuator_calibration/base/error.hpp"

#include <unistd.h>

namespace sac {

int runTool(const char* name, const std::function<int()>& body) {
  try {
    return body();
  } catch (const std::exception& error) {
    std::cout.flush();
    std::fflush(stdout);
    std::fprintf(stderr, "%s: %s\n", name, error.what());
    return kToolUnusable;
  }
}

std::function<void(double)> terminalProgress(const std::string& what) {
  if (::isatty(STDERR_FILENO) == 0) {
    return {};
  }
  return [what](double share) {
    std::fprintf(stderr, "\r%s %3.0f %%%s", what.c_str(), 100.0 * share, share < 1.0 ? "" : "\n");
  };
}

void requireNewFile(const std::string& path, OverwritePolicy policy) {
  if (policy == OverwritePolicy::kRefuse && std::filesystem::exists(path)) {
    throw DataError(path + ": the file exists already; choose another name or give --force.");
  }
}

}  // namespace sac
