#include <atomic>
#include <chrono>
#include <csignal>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <filesystem>
#include <map>
#include <random>
#include <string>
#include <thread>

#include <gtest/gtest.h>
#include <linux/fs.h>
#include <sys/ioctl.h>
#include <sys/mount.h>
#include <sys/resource.h>
#include <sys/wait.h>

#include "spherical_actuator_calibration/base/error.hpp"
#include "spherical_actuator_calibration/storage/session_database.hpp"
#include "storage/database_examples.hpp"
#include "storage/killed_writer.hpp"
#include "support/temporary_folder.hpp"

#include <fcntl.h>
#include <sched.h>
#include <unistd.h>

namespace sac {
namespace {

using database_examples::jointIdentity;
using database_examples::kCoils;
using database_examples::kDate;
using database_examples::kJointParameters;
using killed_writer::Acknowledged;
using killed_writer::Event;
using killed_writer::expectNothingLost;
using killed_writer::expectNothingTorn;
using killed_writer::Message;

/// Stores a sample as an operator does who repeats what was refused. Returns whether it had been
/// stored all the same.
bool storeSample(SessionDatabase& database, std::uint32_t id) {
  const Sample sample = database_examples::sample(id, kCoils);
  for (;;) {
    try {
      database.addSample(sample, kDate);
      return false;
    } catch (const DataError& error) {
      if (std::string(error.what()).find("contradict what is stored") != std::string::npos) {
        return true;
      }
    }
  }
}

/// Likewise a revision, which must get this number.
bool storeRevision(SessionDatabase& database, std::uint32_t number) {
  for (;;) {
    try {
      return database
                 .addCycle(database_examples::report(number, 1, kJointParameters),
                           database_examples::state(number, kJointParameters),
                           false,
                           kDate)
                 .number != number;
    } catch (const DataError&) {
    }
  }
}

/// Stores samples and revisions until it is killed. Each is acknowledged through the pipe; one that
/// was refused and stored all the same is told as removed.
[[noreturn]] void repeatForever(const std::string& path, int pipe) {
  std::signal(SIGXFSZ, SIG_IGN);
  const auto tell = [pipe](Event event, std::uint32_t number) {
    killed_writer::tell(pipe, event, number);
  };
  try {
    SessionDatabase database(path, jointIdentity());
    tell(Event::kOpened, 0);
    std::uint32_t revision = database.current().number;
    for (std::uint32_t id = database.nextSampleId();; ++id) {
      if (storeSample(database, id)) {
        tell(Event::kRemoved, id);
      }
      tell(Event::kSample, id);
      if (id % 3 == 0) {
        if (storeRevision(database, ++revision)) {
          tell(Event::kRemoved, id);
        }
        tell(Event::kRevision, revision);
      }
    }
  } catch (const std::exception&) {  // the disk was full when it was opened
  }
  for (;;) {
    ::pause();
  }
}

/// A writer, and what happens to its folder and disk meanwhile.
class Calamities {
 public:
  explicit Calamities(std::uint64_t seed) : random_(seed) {}

  /// How often each happened.
  const std::map<std::string, int>& counts() const { return counts_; }

  /// Lets a writer work through calamities, kills it, and takes what it has acknowledged.
  void run(const std::string& folder, Acknowledged& acknowledged) {
    int ends[2] = {};
    ASSERT_EQ(::pipe2(ends, O_CLOEXEC), 0);
    const pid_t writer = ::fork();
    ASSERT_GE(writer, 0);
    if (writer == 0) {
      ::close(ends[0]);
      repeatForever(folder + "/session.db", ends[1]);
    }
    ::close(ends[1]);
    std::atomic<std::uint64_t> received{0};
    std::thread reader([&] {
      Message message;
      while (::read(ends[0], &message, sizeof message) == sizeof message) {
        acknowledged.take(message);
        ++received;
      }
    });
    // Nothing is wrong yet: it opens the database and stores some, however busy the computer is.
    const std::uint64_t wanted = 1 + random_() % 5;
    while (received < wanted) {
      wait();
    }
    for (std::uint64_t n = 1 + random_() % 3; n > 0; --n) {
      happen(folder, writer);
    }
    const bool away = random_() % 3 == 0;
    if (away) {
      std::filesystem::rename(folder, folder + ".away");
    }
    wait();
    ++counts_["kills"];
    ::kill(writer, SIGKILL);
    reader.join();
    ::close(ends[0]);
    int status = 0;
    ASSERT_EQ(::waitpid(writer, &status, 0), writer);
    ASSERT_TRUE(WIFSIGNALED(status)) << "The writer ended by itself.";
    if (away) {
      std::filesystem::rename(folder + ".away", folder);
    }
  }

 private:
  void wait() { std::this_thread::sleep_for(std::chrono::microseconds(random_() % 4000)); }

  void happen(const std::string& folder, pid_t writer) {
    wait();
    switch (random_() % 5) {
      case 0: {  // hidden by an empty folder, as by another disk
        ++counts_["folders hidden"];
        std::filesystem::rename(folder, folder + ".away");
        std::filesystem::create_directory(folder);
        wait();
        std::filesystem::remove_all(folder);
        std::filesystem::rename(folder + ".away", folder);
        break;
      }
      case 1: {  // no space left
        ++counts_["full disks"];
        const rlimit full = {random_() % 60000, RLIM_INFINITY};
        const rlimit free = {RLIM_INFINITY, RLIM_INFINITY};
        ::prlimit(writer, RLIMIT_FSIZE, &full, nullptr);
        wait();
        ::prlimit(writer, RLIMIT_FSIZE, &free, nullptr);
        break;
      }
      case 2:
        mountReadOnly(folder);
        break;
      case 3:
        refuseWrites(folder);
        break;
      default:
        break;
    }
  }

  /// The same folder, read-only from now on for who opens files in it; those that are open are
  /// written as before.
  void mountReadOnly(const std::string& folder) {
    // Made aside: a mount that the writer has a file open in cannot be made read-only.
    const std::string aside = folder + ".read_only";
    std::filesystem::create_directory(aside);
    if (!may_mount_ || ::mount(folder.c_str(), aside.c_str(), nullptr, MS_BIND, nullptr) != 0) {
      return;
    }
    constexpr unsigned long kReadOnly = MS_REMOUNT | MS_BIND | MS_RDONLY;
    EXPECT_EQ(::mount(nullptr, aside.c_str(), nullptr, kReadOnly, nullptr), 0);
    EXPECT_EQ(::mount(aside.c_str(), folder.c_str(), nullptr, MS_BIND, nullptr), 0);
    ++counts_["mounted read-only"];
    wait();
    EXPECT_EQ(::umount2(folder.c_str(), MNT_DETACH), 0);
    EXPECT_EQ(::umount2(aside.c_str(), MNT_DETACH), 0);
  }

  /// Open files cannot be written either, as on a file system that an error has made read-only.
  void refuseWrites(const std::string& folder) {
    bool is_refused = false;
    for (const bool refuse : {true, false}) {
      for (const char* const end : {"", "-journal"}) {
        const int file = ::open((folder + "/session.db" + end).c_str(), O_RDONLY | O_CLOEXEC);
        int flags = 0;
        if (::ioctl(file, FS_IOC_GETFLAGS, &flags) == 0) {
          flags = refuse ? flags | FS_IMMUTABLE_FL : flags & ~FS_IMMUTABLE_FL;
          is_refused = ::ioctl(file, FS_IOC_SETFLAGS, &flags) == 0 || is_refused;
        }
        ::close(file);
      }
      wait();
    }
    counts_["writes refused"] += is_refused ? 1 : 0;
  }

  std::mt19937_64 random_;
  /// Mounts are seen by this process and its children alone; only root may.
  bool may_mount_ = ::unshare(CLONE_NEWNS) == 0 &&
                    ::mount("none", "/", nullptr, MS_REC | MS_PRIVATE, nullptr) == 0;
  std::map<std::string, int> counts_;
};

/// Another number of kills than is quick: STORAGE_KILLS=1000.
int killsAskedFor() {
  constexpr int kKills = 60;
  const char* const asked = std::getenv("STORAGE_KILLS");  // NOLINT(concurrency-mt-unsafe)
  return asked == nullptr ? kKills : std::atoi(asked);     // NOLINT(cert-err34-c)
}

// What was refused while folder or disk were away may be stored only where nothing more is taken
// until the node starts again.
TEST(KilledWriter, LosesNothingWhileFolderAndDiskComeAndGo) {
  const TemporaryFolder temporary;
  const std::string folder = temporary.path("unit");
  std::filesystem::create_directory(folder);
  Calamities calamities(20240601);
  Acknowledged acknowledged;
  for (int kill = 0; kill < killsAskedFor() && !HasFailure(); ++kill) {
    calamities.run(folder, acknowledged);
    if (!HasFailure()) {
      expectNothingLost(folder + "/session.db", acknowledged);
      expectNothingTorn(folder + "/session.db");
    }
    EXPECT_TRUE(acknowledged.removed.empty()) << "refused, and stored all the same";
  }
  EXPECT_GT(acknowledged.samples.size(), 20U);
  for (const auto& [what, count] : calamities.counts()) {
    std::printf("%s: %d\n", what.c_str(), count);
  }
  std::printf("samples acknowledged: %zu, revision: %u\n",
              acknowledged.samples.size(),
              acknowledged.revision);
}

}  // namespace
}  // namespace sac
