#include "spherical_actuator_calibration/storage/calibration_directory.hpp"

#include <cstdlib>
#include <filesystem>
#include <optional>
#include <string>

#include <gtest/gtest.h>

#include "spherical_actuator_calibration/base/error.hpp"
#include "support/error_message.hpp"
#include "support/scenarios.hpp"
#include "support/temporary_folder.hpp"

namespace sac {
namespace {

namespace fs = std::filesystem;

/// Sets an environment variable, or with a null pointer removes it, until the end of the test.
class Variable {
 public:
  Variable(const char* name, const char* value) : name_(name) {
    const char* previous = std::getenv(name);  // NOLINT(concurrency-mt-unsafe)
    if (previous != nullptr) {
      previous_ = previous;
    }
    set(value);
  }
  ~Variable() { set(previous_ ? previous_->c_str() : nullptr); }
  Variable(const Variable&) = delete;
  Variable& operator=(const Variable&) = delete;

 private:
  void set(const char* value) const {
    if (value == nullptr) {
      ::unsetenv(name_);
    } else {
      ::setenv(name_, value, 1);
    }
  }

  const char* name_;
  std::optional<std::string> previous_;
};

Actuator unit(const std::string& name, const std::string& serial) {
  Actuator actuator = scenarios::paperNominal();
  actuator.name = name;
  actuator.serial = serial;
  return actuator;
}

TEST(CalibrationDirectory, IsBelowRosHomeUnderTheSerial) {
  const TemporaryFolder folder;
  const Variable ros_home("ROS_HOME", folder.path("ros").c_str());
  const CalibrationDirectory directory("", unit("rotor", "SA-001"));
  EXPECT_EQ(directory.path(), folder.path("ros/spherical_actuator_calibration/SA-001"));
  EXPECT_TRUE(fs::is_directory(directory.path()));
  EXPECT_EQ(directory.database(), directory.path() + "/session.db");
  EXPECT_EQ(directory.description(3), directory.path() + "/rotor_revision_3.yaml");
  EXPECT_EQ(directory.urdf(12), directory.path() + "/rotor_revision_12.urdf");
  EXPECT_EQ(directory.report(12), directory.path() + "/report_revision_12");
  EXPECT_EQ(CalibrationDirectory("", unit("rotor", "")).path(),
            folder.path("ros/spherical_actuator_calibration/rotor"));
}

TEST(CalibrationDirectory, WithoutRosHomeIsBelowTheHomeFolder) {
  const TemporaryFolder folder;
  const Variable ros_home("ROS_HOME", nullptr);
  const Variable home("HOME", folder.path("home").c_str());
  EXPECT_EQ(CalibrationDirectory("", unit("rotor", "SA-001")).path(),
            folder.path("home/.ros/spherical_actuator_calibration/SA-001"));
  const Variable no_home("HOME", nullptr);
  EXPECT_THROW(CalibrationDirectory("", unit("rotor", "SA-001")), ConfigError);
}

TEST(CalibrationDirectory, AGivenFolderWins) {
  const TemporaryFolder folder;
  const Variable ros_home("ROS_HOME", folder.path("ros").c_str());
  const CalibrationDirectory directory(folder.path("given/./here/"), unit("rotor", "a/b"));
  EXPECT_EQ(directory.path(), folder.path("given/here"));
  EXPECT_FALSE(fs::exists(folder.path("ros")));
}

TEST(CalibrationDirectory, NamesThatLeadElsewhereAreRefused) {
  const TemporaryFolder folder;
  const Variable ros_home("ROS_HOME", folder.path("ros").c_str());
  for (const std::string& name : {std::string("../out"),
                                  std::string(".."),
                                  std::string("/etc"),
                                  std::string("a/b"),
                                  std::string("."),
                                  std::string("a\nb"),
                                  std::string("a\0b", 3),
                                  std::string(300, 'x')}) {
    EXPECT_NE(errorMessage<ConfigError>([&] {
                const CalibrationDirectory directory("", unit("rotor", name));
              }).find("actuator.serial: \""),
              std::string::npos)
        << name;
    EXPECT_NE(errorMessage<ConfigError>([&] {
                const CalibrationDirectory directory(folder.path("given"), unit(name, ""));
              }).find("actuator.name: \""),
              std::string::npos)
        << name;
  }
  EXPECT_EQ(folder.files(), 0);
}

TEST(CalibrationDirectory, AFolderThatCannotBeMadeIsNamed) {
  const TemporaryFolder folder;
  const std::string file = folder.write("file", "");
  const Actuator actuator = unit("rotor", "SA-001");
  const auto refusal = [&](const std::string& path) {
    return errorMessage<DataError>([&] { const CalibrationDirectory directory(path, actuator); });
  };
  EXPECT_NE(refusal(file + "/below").find("the calibration directory cannot be made: "),
            std::string::npos);
  EXPECT_NE(refusal(file).find("the calibration directory cannot be made: "), std::string::npos)
      << refusal(file);
  EXPECT_NE(refusal("/proc/self/calibration").find("the calibration directory cannot be made: "),
            std::string::npos);
}

}  // namespace
}  // namespace sac
