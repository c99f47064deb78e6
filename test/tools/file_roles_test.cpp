#include "file_roles.hpp"

#include <filesystem>
#include <fstream>
#include <optional>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "spherical_actuator_calibration/base/error.hpp"
#include "support/error_message.hpp"
#include "support/temporary_folder.hpp"

namespace sac {
namespace {

namespace fs = std::filesystem;

class FileRolesTest : public testing::Test {
 protected:
  FileRolesTest() { std::ofstream(recording_) << "measured once"; }

  std::string path(const std::string& name) const { return folder_.path(name); }
  std::string refusal() const {
    return errorMessage<ConfigError>([&] { files_.requireSeparate(); });
  }

  const TemporaryFolder folder_;
  const std::string recording_ = folder_.path("in.bag");
  FileRoles files_;
};

TEST_F(FileRolesTest, NothingThatIsReadIsReplaced) {
  files_.read("--actuator", std::optional<std::string>());
  files_.read("BAG", std::vector<std::string>{path("other.bag"), recording_});
  files_.write("--output", recording_);
  EXPECT_EQ(refusal(),
            "--output: " + recording_ + " is the file that BAG reads; choose another name.");
}

TEST_F(FileRolesTest, LinksAreTheFileThatTheyLeadTo) {
  fs::create_hard_link(recording_, path("hard.bag"));
  fs::create_symlink(recording_, path("soft.bag"));
  fs::create_directory_symlink(path(""), path("folder"));
  for (const char* name : {"hard.bag", "soft.bag", "folder/in.bag", "./in.bag"}) {
    FileRoles files;
    files.read("--samples", recording_);
    files.write("--output", path(name));
    EXPECT_NE(
        errorMessage<ConfigError>([&] { files.requireSeparate(); }).find("that --samples reads"),
        std::string::npos)
        << name;
  }
}

TEST_F(FileRolesTest, OutputsAreDifferentFilesAlsoBeforeTheyAreThere) {
  files_.write("--output", path("result"));
  files_.write("--urdf", std::optional<std::string>(path("./result")));
  EXPECT_EQ(
      refusal(),
      "--urdf: " + path("./result") + " is the file that --output writes; choose another name.");
}

TEST_F(FileRolesTest, DifferentFilesMayBeReadAndWritten) {
  files_.read("--actuator", recording_);
  files_.read("--truth", recording_);
  files_.write("--output", path("result"));
  files_.write("--urdf", path("other"));
  files_.write("--covariance", path("no folder/result"));
  files_.write("--certificate", std::optional<std::string>());
  EXPECT_NO_THROW(files_.requireSeparate());
}

}  // namespace
}  // namespace sac
