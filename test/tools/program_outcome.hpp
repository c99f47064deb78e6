#pragma once

#include <cstdlib>
#include <string>

#include <sys/wait.h>

#include "support/temporary_folder.hpp"

namespace sac {

/// What a run of a program left.
struct Outcome {
  int status = -1;
  std::string output;
  std::string errors;
};

/// Runs a command; what it says is kept in the folder.
inline Outcome outcomeOf(const std::string& command, const TemporaryFolder& folder) {
  const std::string output = folder.path("output");
  const std::string errors = folder.path("errors");
  const int status = std::system((command + " >" + output + " 2>" + errors).c_str());
  return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, contentOf(output), contentOf(errors)};
}

}  // namespace sac
