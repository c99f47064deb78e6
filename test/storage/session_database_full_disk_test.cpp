#include <csignal>
#include <filesystem>
#include <fstream>
#include <string>
#include <system_error>

#include <gtest/gtest.h>
#include <sys/mount.h>
#include <sys/resource.h>

#include "spherical_actuator_calibration/base/error.hpp"
#include "spherical_actuator_calibration/storage/session_database.hpp"
#include "storage/database_examples.hpp"
#include "support/error_message.hpp"
#include "support/temporary_folder.hpp"

#include <sched.h>

namespace sac {
namespace {

namespace fs = std::filesystem;
using database_examples::identity;
using database_examples::kCoils;
using database_examples::kDate;
using database_examples::kParameters;

/// A disk that can be filled. Where this process may mount, it is a small file system of its own;
/// elsewhere a limit on the size of files takes the place of the full disk.
class SmallDisk {
 public:
  SmallDisk() {
    // In a namespace of its own the mount ends with this process, however that ends.
    mounted_ = ::unshare(CLONE_NEWNS) == 0 &&
               ::mount("none", "/", nullptr, MS_REC | MS_PRIVATE, nullptr) == 0 &&
               ::mount("none", folder_.path("").c_str(), "tmpfs", 0, "size=2m") == 0;
    ::getrlimit(RLIMIT_FSIZE, &unlimited_);
    previous_action_ = std::signal(SIGXFSZ, SIG_IGN);
  }
  ~SmallDisk() {
    empty();
    std::signal(SIGXFSZ, previous_action_);
    if (mounted_) {
      ::umount2(folder_.path("").c_str(), MNT_DETACH);
    }
  }
  SmallDisk(const SmallDisk&) = delete;
  SmallDisk& operator=(const SmallDisk&) = delete;

  std::string path() const { return folder_.path("session.db"); }

  void fill() {
    if (mounted_) {
      std::ofstream filler(fillerPath(), std::ios::binary);
      const std::string page(4096, 'x');
      while (filler.write(page.data(), static_cast<std::streamsize>(page.size())).flush()) {
      }
      return;
    }
    const rlimit limit = {1, unlimited_.rlim_max};
    ::setrlimit(RLIMIT_FSIZE, &limit);
  }
  void empty() {
    ::setrlimit(RLIMIT_FSIZE, &unlimited_);
    std::error_code ignored;
    fs::remove(fillerPath(), ignored);
  }

 private:
  std::string fillerPath() const { return folder_.path("filler"); }

  TemporaryFolder folder_;
  bool mounted_ = false;
  rlimit unlimited_ = {};
  void (*previous_action_)(int) = nullptr;
};

void expectNotStored(const std::string& message, const std::string& what) {
  EXPECT_NE(message.find(what), std::string::npos) << message;
  EXPECT_NE(message.find("free some space"), std::string::npos) << message;
}

/// Adds samples until one is refused; returns the sentence. Some pages may still be free.
std::string fillWithSamples(SessionDatabase& database, std::uint32_t& id) {
  std::string message = "no exception";
  while (message == "no exception") {
    ++id;
    message = errorMessage<DataError>(
        [&] { database.addSample(database_examples::sample(id, kCoils), kDate); });
  }
  return message;
}

TEST(FullDisk, RefusesWithASentenceAndGoesOnWhenThereIsSpace) {
  SmallDisk disk;
  SessionDatabase database(disk.path(), identity());
  database.addSample(database_examples::sample(1, kCoils), kDate);

  disk.fill();
  std::uint32_t id = 1;
  expectNotStored(fillWithSamples(database, id), "was not stored");
  const std::size_t stored = id - 1;
  const CycleReport report = database_examples::report(1, 1, kParameters);
  const CalibrationState state = database_examples::state(1, kParameters);
  expectNotStored(errorMessage<DataError>([&] { database.addCycle(report, state, false, kDate); }),
                  "the result of cycle coil:3 was not stored");

  // Reading goes on, and nothing is half there.
  EXPECT_EQ(database.samplesInUse().size(), stored);
  EXPECT_EQ(database.nextSampleId(), id);
  EXPECT_FALSE(database.lastCycle());
  EXPECT_EQ(database.current().number, 0U);

  disk.empty();
  database.addSample(database_examples::sample(id, kCoils), kDate);
  EXPECT_EQ(database.addCycle(report, state, false, kDate).number, 1U);
  EXPECT_EQ(database.samplesInUse().size(), stored + 1);
  EXPECT_EQ(database_examples::query(disk.path(), "PRAGMA integrity_check"), "ok");
}

TEST(FullDisk, WhatWasStoredIsThereAfterwards) {
  SmallDisk disk;
  std::uint32_t id = 0;
  {
    SessionDatabase database(disk.path(), identity());
    disk.fill();
    fillWithSamples(database, id);
  }
  disk.empty();
  EXPECT_EQ(SessionDatabase(disk.path(), identity()).nextSampleId(), id);
}

TEST(FullDisk, ANewDatabaseIsMadeWhenThereIsSpace) {
  SmallDisk disk;
  disk.fill();
  expectNotStored(
      errorMessage<DataError>([&] { const SessionDatabase database(disk.path(), identity()); }),
      "the session database ");
  disk.empty();
  EXPECT_EQ(SessionDatabase(disk.path(), identity()).current().number, 0U);
}

}  // namespace
}  // namespace sac
