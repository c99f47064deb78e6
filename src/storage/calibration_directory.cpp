#include "spherical_actuator_calibration/storage/calibration_directory.hpp"

#include <algorithm>
#include <cerrno>
#include <cstddef>
#include <cstdlib>
#include <filesystem>
#include <system_error>

#include "spherical_actuator_calibration/base/error.hpp"
#include "spherical_actuator_calibration/base/folder_sync.hpp"

#include <unistd.h>

namespace sac {
namespace {

namespace fs = std::filesystem;

constexpr char kPackageFolder[] = "spherical_actuator_calibration";

/// A name that is one step of a path and no more. Leaves room for what is added to it.
bool isFileName(const std::string& name) {
  constexpr std::size_t kLongest = 200;
  constexpr unsigned char kFirstPrintable = 0x20;
  return !name.empty() && name.size() <= kLongest && name.front() != '.' &&
         std::none_of(name.begin(), name.end(), [](char c) {
           return c == '/' || static_cast<unsigned char>(c) < kFirstPrintable;
         });
}

const std::string& requireFileName(const std::string& name, const std::string& key) {
  if (!isFileName(name)) {
    throw ConfigError(key + ": \"" + name +
                      "\" cannot name files; use up to 200 letters, digits and signs, no \"/\" and "
                      "no \".\" at the start.");
  }
  return name;
}

/// Value of an environment variable; empty when it is not set.
std::string environment(const char* variable) {
  const char* value = std::getenv(variable);  // NOLINT(concurrency-mt-unsafe)
  return value == nullptr ? "" : value;
}

fs::path rosHome() {
  const std::string ros_home = environment("ROS_HOME");
  if (!ros_home.empty()) {
    return ros_home;
  }
  const std::string home = environment("HOME");
  if (home.empty()) {
    throw ConfigError(
        "Neither ROS_HOME nor HOME is set; give the calibration directory as a parameter.");
  }
  return fs::path(home) / ".ros";
}

fs::path defaultDirectory(const Actuator& actuator) {
  const std::string unit = actuator.serial.empty()
                               ? requireFileName(actuator.name, "actuator.name")
                               : requireFileName(actuator.serial, "actuator.serial");
  return rosHome() / kPackageFolder / unit;
}

[[noreturn]] void failWith(const fs::path& path, const std::string& failure, int error) {
  throw DataError(path.string() + ": the calibration directory " + failure + ": " +
                  std::generic_category().message(error) +
                  "; check it, or choose another directory.");
}

/// Makes a folder with those above it so that they survive a power failure.
void makeFolder(const fs::path& folder) {
  if (fs::is_directory(folder)) {
    return;
  }
  if (folder.has_relative_path()) {
    makeFolder(folder.parent_path());
  }
  std::error_code error;
  fs::create_directory(folder, error);
  if (error) {
    failWith(folder, "cannot be made", error.value());
  }
  syncFolder(folder.parent_path());
}

}  // namespace

CalibrationDirectory::CalibrationDirectory(const std::string& directory, const Actuator& actuator)
    : name_(requireFileName(actuator.name, "actuator.name")) {
  std::error_code error;
  fs::path folder =
      fs::absolute(directory.empty() ? defaultDirectory(actuator) : fs::path(directory), error);
  if (error) {
    failWith(directory, "has no absolute path", error.value());
  }
  folder = folder.lexically_normal();
  if (!folder.has_filename()) {
    folder = folder.parent_path();
  }
  makeFolder(folder);
  if (::access(folder.c_str(), W_OK | X_OK) != 0) {
    failWith(folder, "cannot be written", errno);
  }
  path_ = folder.string();
}

std::string CalibrationDirectory::database() const {
  return (fs::path(path_) / "session.db").string();
}

std::string CalibrationDirectory::description(std::uint32_t revision, unsigned edition) const {
  return revisionFile(revision, edition > 1 ? "_" + std::to_string(edition) + ".yaml" : ".yaml");
}

std::string CalibrationDirectory::urdf(std::uint32_t revision) const {
  return revisionFile(revision, ".urdf");
}

std::string CalibrationDirectory::report(std::uint32_t revision) const {
  return (fs::path(path_) / ("report_revision_" + std::to_string(revision))).string();
}

std::string CalibrationDirectory::revisionFile(std::uint32_t revision,
                                               const std::string& ending) const {
  const std::string file = name_ + "_revision_" + std::to_string(revision) + ending;
  return (fs::path(path_) / file).string();
}

}  // namespace sac
