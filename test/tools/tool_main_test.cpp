#include "tool_main.hpp"

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <new>
#include <string>

#include <gtest/gtest.h>
#include <sys/wait.h>

#include "spherical_actuator_calibration/base/error.hpp"
#include "support/error_message.hpp"
#include "support/source_dir.hpp"
#include "support/temporary_folder.hpp"

namespace sac {
namespace {

/// A program, started by a shell, as people start it.
class ToolMain : public testing::Test {
 protected:
  /// Exit status; -1 when a signal ended it.
  int run(const std::string& before, const std::string& arguments) {
    const std::string errors = folder_.path("errors");
    const std::string command =
        before + "exec " + SIMULATE_RECORDING + " " + arguments + " 2>" + errors;
    const int status = std::system(command.c_str());
    std::ifstream file(errors);
    errors_ = std::string(std::istreambuf_iterator<char>(file), {});
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  }

  const TemporaryFolder folder_;
  std::string errors_;
};

TEST_F(ToolMain, WhatCannotBePrintedIsAnError) {
  EXPECT_EQ(run("", "--help >/dev/null"), kToolSuccess);
  EXPECT_EQ(run("", "--help >/dev/full"), kToolUnusable);
  EXPECT_EQ(errors_, "simulate_recording: the standard output cannot be written.\n");
}

TEST_F(ToolMain, ALackOfMemoryIsTold) {
  testing::internal::CaptureStderr();
  EXPECT_EQ(runTool("tool", []() -> int { throw std::bad_alloc(); }), kToolUnusable);
  EXPECT_NE(testing::internal::GetCapturedStderr().find("tool: there is not enough memory left"),
            std::string::npos);
}

TEST_F(ToolMain, NamesThatAreTooLongAreToldFirst) {
  const std::string longest = folder_.path(std::string(255, 'x'));
  EXPECT_NO_THROW(requireNewFile(longest, OverwritePolicy::kRefuse));
  EXPECT_EQ(
      errorMessage<DataError>([&] { requireNewFile(longest + "x", OverwritePolicy::kReplace); }),
      longest + "x: cannot be written: its name is too long; choose another.");
}

TEST_F(ToolMain, OutputsThatCannotBeWrittenAreToldFirst) {
  std::filesystem::create_symlink("nowhere", folder_.path("link"));
  EXPECT_NE(errorMessage<DataError>([&] {
              requireNewFile(folder_.path("link"), OverwritePolicy::kRefuse);
            }).find("exists already"),
            std::string::npos);
  EXPECT_NO_THROW(requireNewFile(folder_.path("link"), OverwritePolicy::kReplace));
  EXPECT_NE(errorMessage<DataError>([&] {
              requireNewFile(folder_.path("missing/file"), OverwritePolicy::kReplace);
            }).find("there is no folder"),
            std::string::npos);
}

TEST_F(ToolMain, FilesThatMayNotGrowAreAnError) {
  const std::string arguments =
      "--actuator " SOURCE_DIR "/config/pm_spherical_8x24.yaml --output " + folder_.path("s.bag") +
      " --joint-poses 2 --main-coil-poses 0 --coil-poses 0";
  EXPECT_EQ(run("ulimit -f 8; ", arguments), kToolUnusable);
  EXPECT_NE(errors_.find("simulate_recording: " + folder_.path("s.bag") + ": cannot be written"),
            std::string::npos)
      << errors_;
}

}  // namespace
}  // namespace sac
