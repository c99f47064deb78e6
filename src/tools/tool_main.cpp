#include "tool_main.hpp"

#include <cerrno>
#include <csignal>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <iostream>
#include <new>
#include <system_error>

#include <sys/stat.h>

#include "spherical_actuator_calibration/base/error.hpp"
#include "spherical_actuator_calibration/base/printable_text.hpp"

#include <unistd.h>

namespace sac {
namespace {

namespace fs = std::filesystem;

/// Whether all that was printed has arrived: on a full disk, or a closed descriptor, it has not.
bool isOutputWritten() {
  std::cout.flush();
  const bool is_flushed = std::fflush(stdout) == 0;
  return std::cout.good() && is_flushed && std::ferror(stdout) == 0;
}

/// In a folder such as /tmp, whose sticky bit keeps others from replacing a file.
bool isOfSomebodyElse(const struct stat& entry, const fs::path& folder) {
  struct stat own = {};
  const uid_t user = ::geteuid();
  return ::stat(folder.c_str(), &own) == 0 && (own.st_mode & S_ISVTX) != 0 && user != 0 &&
         user != entry.st_uid && user != own.st_uid;
}

}  // namespace

int runTool(const char* name, const std::function<int()>& body) {
  // A file that may not grow any more is an error of writing, which is told, and not the end.
  std::signal(SIGXFSZ, SIG_IGN);
  // Names and sentences from files and recordings come to the terminal.
  const PrintableOutput filter(std::cout);
  try {
    const int status = body();
    if (!isOutputWritten()) {
      std::fprintf(stderr, "%s: the standard output cannot be written.\n", name);
      return kToolUnusable;
    }
    return status;
  } catch (const std::bad_alloc&) {
    std::fprintf(stderr,
                 "%s: there is not enough memory left; close other programs, or raise the limit of "
                 "`ulimit -v`.\n",
                 name);
    return kToolUnusable;
  } catch (const std::exception& error) {
    std::cout.flush();
    std::fflush(stdout);
    std::fprintf(stderr, "%s: %s\n", name, printable(error.what()).c_str());
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
  if (path.empty()) {
    return;
  }
  std::error_code error;
  struct stat entry = {};
  const bool is_there = ::lstat(path.c_str(), &entry) == 0;
  if (!is_there && errno == ENAMETOOLONG) {
    throw DataError(path + ": cannot be written: its name is too long; choose another.");
  }
  // A link that leads nowhere is there, too.
  if (is_there && policy == OverwritePolicy::kRefuse) {
    throw DataError(path + ": the file exists already; choose another name or give --force.");
  }
  const fs::file_status status = fs::status(path, error);
  if (fs::exists(status) && !fs::is_regular_file(status)) {
    throw DataError(path + ": this is not a regular file; choose another name.");
  }
  const fs::path folder = fs::absolute(path, error).parent_path();
  if (error || ::access(folder.c_str(), W_OK | X_OK) != 0) {
    throw DataError(path + ": cannot be written: " +
                    (fs::is_directory(folder, error) ? "its folder takes no files"
                                                     : "there is no folder " + folder.string()) +
                    ".");
  }
  if (is_there && isOfSomebodyElse(entry, folder)) {
    throw DataError(path +
                    ": cannot be written: it is somebody else's, in a folder where only the " +
                    "owner replaces a file; choose another name.");
  }
}

}  // namespace sac
