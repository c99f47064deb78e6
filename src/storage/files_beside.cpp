#include "files_beside.hpp"

#include <filesystem>
#include <system_error>

#include "spherical_actuator_calibration/base/error.hpp"

namespace sac {
namespace {

/// What stands at a path where a file, or nothing, belongs; empty when there is nothing wrong.
std::string wrongKind(const std::string& path) {
  std::error_code ignored;
  switch (std::filesystem::symlink_status(path, ignored).type()) {
    case std::filesystem::file_type::none:
    case std::filesystem::file_type::not_found:
    case std::filesystem::file_type::regular:
      return "";
    case std::filesystem::file_type::directory:
      return "a folder";
    case std::filesystem::file_type::symlink:
      return "a symbolic link";
    case std::filesystem::file_type::fifo:
      return "a FIFO";
    case std::filesystem::file_type::socket:
      return "a socket";
    default:
      return "a device";
  }
}

[[noreturn]] void throwBeside(const std::string& path,
                              const std::string& failure,
                              const std::string& beside,
                              const std::string& kind) {
  throw DataError(path + ": " + failure + ", because " + beside + " is " + kind +
                  ", not a file; remove it, and try again.");
}

}  // namespace

void requireFilesBeside(const std::string& path,
                        const std::string& file,
                        const std::string& failure) {
  for (const char* const ending : {"-journal", "-wal", "-shm"}) {
    const std::string beside = file + ending;
    const std::string kind = wrongKind(beside);
    if (!kind.empty()) {
      throwBeside(path, failure, beside, kind);
    }
  }
}

}  // namespace sac
