#include "file_roles.hpp"

#include <filesystem>
#include <tuple>

#include <sys/stat.h>

#include "spherical_actuator_calibration/base/error.hpp"

namespace sac {
namespace {

namespace fs = std::filesystem;

/// The same for all names of a file: device, inode and nothing, or those of the folder that it
/// would be in, and its name there.
using Identity = std::tuple<dev_t, ino_t, std::string>;

std::optional<Identity> identityOf(const std::string& path) {
  struct stat status = {};
  if (::stat(path.c_str(), &status) == 0) {
    return Identity(status.st_dev, status.st_ino, "");
  }
  const fs::path name(path);
  const std::string folder = name.has_parent_path() ? name.parent_path().string() : ".";
  if (::stat(folder.c_str(), &status) == 0) {
    return Identity(status.st_dev, status.st_ino, name.filename().string());
  }
  return std::nullopt;  // whoever opens it tells
}

}  // namespace

void FileRoles::read(const std::string& option, const std::string& path) {
  if (!path.empty()) {
    read_.push_back({option, path});
  }
}

void FileRoles::read(const std::string& option, const std::optional<std::string>& path) {
  read(option, path.value_or(""));
}

void FileRoles::read(const std::string& option, const std::vector<std::string>& paths) {
  for (const std::string& path : paths) {
    read(option, path);
  }
}

void FileRoles::write(const std::string& option, const std::string& path) {
  if (!path.empty()) {
    written_.push_back({option, path});
  }
}

void FileRoles::write(const std::string& option, const std::optional<std::string>& path) {
  write(option, path.value_or(""));
}

void FileRoles::requireSeparate() const {
  for (std::size_t n = 0; n < written_.size(); ++n) {
    const Entry& output = written_[n];
    const std::optional<Identity> identity = identityOf(output.path);
    if (!identity) {
      continue;
    }
    for (const Entry& input : read_) {
      if (identityOf(input.path) == identity) {
        throw ConfigError(output.option + ": " + output.path + " is the file that " + input.option +
                          " reads; choose another name.");
      }
    }
    for (std::size_t other = 0; other < n; ++other) {
      if (identityOf(written_[other].path) == identity) {
        throw ConfigError(output.option + ": " + output.path + " is the file that " +
                          written_[other].option + " writes; choose another name.");
      }
    }
  }
}

}  // namespace sac
