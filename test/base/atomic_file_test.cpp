#include "spherical_actuator_calibration/base/atomic_file.hpp"

#include <csignal>
#include <filesystem>
#include <string>

#include <gtest/gtest.h>
#include <sys/resource.h>

#include "spherical_actuator_calibration/base/error.hpp"
#include "support/error_message.hpp"
#include "support/temporary_folder.hpp"

namespace sac {
namespace {

namespace fs = std::filesystem;

/// Lets no file of this process grow beyond a size: a disk that is full.
class FileSizeLimit {
 public:
  explicit FileSizeLimit(rlim_t bytes) {
    previous_action_ = std::signal(SIGXFSZ, SIG_IGN);
    ::getrlimit(RLIMIT_FSIZE, &previous_);
    const rlimit limit = {bytes, previous_.rlim_max};
    ::setrlimit(RLIMIT_FSIZE, &limit);
  }
  ~FileSizeLimit() {
    ::setrlimit(RLIMIT_FSIZE, &previous_);
    std::signal(SIGXFSZ, previous_action_);
  }
  FileSizeLimit(const FileSizeLimit&) = delete;
  FileSizeLimit& operator=(const FileSizeLimit&) = delete;

 private:
  rlimit previous_ = {};
  void (*previous_action_)(int) = nullptr;
};

TEST(AtomicFile, WritesTheContentAndNothingElse) {
  const TemporaryFolder folder;
  writeFileAtomically(folder.path("a.yaml"), "content\n", OverwritePolicy::kRefuse);
  EXPECT_EQ(contentOf(folder.path("a.yaml")), "content\n");
  EXPECT_EQ(folder.files(), 1);
}

TEST(AtomicFile, RefusesToOverwriteUnlessTold) {
  const TemporaryFolder folder;
  const std::string path = folder.write("a.yaml", "old");
  const std::string message =
      errorMessage<DataError>([&] { writeFileAtomically(path, "new", OverwritePolicy::kRefuse); });
  EXPECT_EQ(message, path + ": the file exists already; remove it or choose another name.");
  EXPECT_EQ(contentOf(path), "old");
  writeFileAtomically(path, "new", OverwritePolicy::kReplace);
  EXPECT_EQ(contentOf(path), "new");
  EXPECT_EQ(folder.files(), 1);
}

TEST(AtomicFile, KeepsThePermissionsOfAReplacedFile) {
  const TemporaryFolder folder;
  const std::string path = folder.write("a.yaml", "old");
  const auto owner_only = fs::perms::owner_read | fs::perms::owner_write;
  fs::permissions(path, owner_only);
  writeFileAtomically(path, "new", OverwritePolicy::kReplace);
  EXPECT_EQ(fs::status(path).permissions(), owner_only);
}

TEST(AtomicFile, LeavesTheOldFileWhenTheDiskIsFull) {
  const TemporaryFolder folder;
  const std::string path = folder.write("a.yaml", "old");
  std::string message;
  {
    const FileSizeLimit limit(1000);
    message = errorMessage<DataError>(
        [&] { writeFileAtomically(path, std::string(5000, 'x'), OverwritePolicy::kReplace); });
  }
  EXPECT_NE(message.find(path + ": cannot be written: "), std::string::npos) << message;
  EXPECT_EQ(contentOf(path), "old");
  EXPECT_EQ(folder.files(), 1);
}

TEST(AtomicFile, TellsThatTheFolderIsMissing) {
  const TemporaryFolder folder;
  const std::string path = folder.path("missing/a.yaml");
  EXPECT_EQ(errorMessage<DataError>(
                [&] { writeFileAtomically(path, "content", OverwritePolicy::kRefuse); }),
            path + ": cannot be written: No such file or directory.");
}

TEST(AtomicFile, TakesNamesAsLongAsTheDiskDoes) {
  const TemporaryFolder folder;
  const std::string longest = folder.path(std::string(255, 'x'));
  writeFileAtomically(longest, "content", OverwritePolicy::kRefuse);
  writeFileAtomically(longest, "another", OverwritePolicy::kReplace);
  EXPECT_EQ(contentOf(longest), "another");
  EXPECT_EQ(folder.files(), 1);
  EXPECT_EQ(errorMessage<DataError>(
                [&] { writeFileAtomically(longest + "x", "content", OverwritePolicy::kRefuse); }),
            longest + "x: cannot be written: File name too long.");
  EXPECT_EQ(folder.files(), 1);
}

TEST(AtomicFile, ReplacesNothingButFiles) {
  const TemporaryFolder folder;
  fs::create_directory(folder.path("a"));
  for (const std::string& path : {folder.path("a"), std::string("/dev/null")}) {
    EXPECT_EQ(errorMessage<DataError>(
                  [&] { writeFileAtomically(path, "content", OverwritePolicy::kReplace); }),
              path + ": this is not a regular file; choose another name.");
  }
}

TEST(AtomicFile, DoesNotFollowADanglingLink) {
  const TemporaryFolder folder;
  fs::create_symlink("nowhere", folder.path("link"));
  EXPECT_THROW(writeFileAtomically(folder.path("link"), "content", OverwritePolicy::kRefuse),
               DataError);
  EXPECT_EQ(folder.files(), 1);
}

}  // namespace
}  // namespace sac
