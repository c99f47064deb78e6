#include <chrono>
#include <csignal>
#include <cstdint>
#include <random>
#include <string>
#include <thread>

#include <gtest/gtest.h>
#include <sys/wait.h>

#include "spherical_actuator_calibration/storage/session_database.hpp"
#include "storage/database_examples.hpp"
#include "storage/killed_writer.hpp"
#include "support/temporary_folder.hpp"

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

/// Stores samples, removals, cycles and revisions, each acknowledged through the pipe, until it is
/// killed.
[[noreturn]] void writeForever(const std::string& path, int pipe) {
  const auto tell = [pipe](Event event, std::uint32_t number) {
    killed_writer::tell(pipe, event, number);
  };
  SessionDatabase database(path, jointIdentity());
  tell(Event::kOpened, 0);
  for (;;) {
    const std::uint32_t id = database.nextSampleId();
    for (const std::uint32_t next : {id, id + 1}) {
      database.addSample(database_examples::sample(next, kCoils), kDate);
      tell(Event::kSample, next);
    }
    tell(Event::kRemoving, id);
    database.removeSample(id, kDate);
    tell(Event::kRemoved, id);

    CycleReport failed = database_examples::report(id, 1, kJointParameters);
    failed.success = false;
    database.addCycle(failed, kDate);
    const std::uint32_t number = database.current().number + 1;
    database.addCycle(database_examples::report(number, 1, kJointParameters),
                      database_examples::state(number, kJointParameters),
                      false,
                      kDate);
    tell(Event::kRevision, number);
  }
}

/// Runs a writer and kills it after `messages` messages and `delay` more; takes what it
/// acknowledged.
void runAndKill(const std::string& path,
                int messages,
                std::chrono::microseconds delay,
                Acknowledged& acknowledged) {
  int ends[2] = {};
  ASSERT_EQ(::pipe(ends), 0);
  const pid_t writer = ::fork();
  ASSERT_GE(writer, 0);
  if (writer == 0) {
    ::close(ends[0]);
    writeForever(path, ends[1]);
  }
  ::close(ends[1]);
  Message message;
  const auto receive = [&] {
    const bool received = ::read(ends[0], &message, sizeof message) == sizeof message;
    if (received) {
      acknowledged.take(message);
    }
    return received;
  };
  bool is_alive = true;
  for (int n = 0; n < messages && is_alive; ++n) {
    is_alive = receive();
  }
  std::this_thread::sleep_for(delay);
  ::kill(writer, SIGKILL);
  while (receive()) {
  }
  ::close(ends[0]);
  int status = 0;
  ASSERT_EQ(::waitpid(writer, &status, 0), writer);
  ASSERT_TRUE(WIFSIGNALED(status)) << "The writer ended by itself.";
}

TEST(KilledWriter, LosesNothingThatItAcknowledged) {
  constexpr int kKills = 100;
  const TemporaryFolder folder;
  const std::string path = folder.path("session.db");
  std::mt19937_64 generator(20240531);
  std::uniform_int_distribution<int> messages(0, 12);
  std::uniform_int_distribution<int> microseconds(0, 3000);
  Acknowledged acknowledged;
  for (int kill = 0; kill < kKills && !HasFailure(); ++kill) {
    const int count = messages(generator);
    runAndKill(path, count, std::chrono::microseconds(microseconds(generator)), acknowledged);
    expectNothingLost(path, acknowledged);
    expectNothingTorn(path);
  }
  EXPECT_GT(acknowledged.samples.size(), 100U);
  EXPECT_GT(acknowledged.removed.size(), 20U);
  EXPECT_GT(acknowledged.revision, 20U);
}

}  // namespace
}  // namespace sac
