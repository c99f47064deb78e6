#pragma once

#include <cstdint>
#include <set>
#include <string>

#include <Eigen/Core>

#include <gtest/gtest.h>

#include "spherical_actuator_calibration/storage/session_database.hpp"
#include "storage/database_examples.hpp"

#include <unistd.h>

/// What tests of killed writers share: what a writer says through a pipe, and what must be there
/// after it was killed.
namespace sac::killed_writer {

using database_examples::isSame;
using database_examples::jointIdentity;
using database_examples::kCoils;
using database_examples::kJointParameters;

/// What the writer says: that it has stored something, or is about to remove a sample.
enum class Event : std::uint32_t { kOpened, kSample, kRemoving, kRemoved, kRevision };
struct Message {
  Event event = Event::kOpened;
  std::uint32_t number = 0;  ///< id of the sample, or number of the revision
};

/// Says it through the pipe; ends the process when nobody listens.
inline void tell(int pipe, Event event, std::uint32_t number) {
  const Message message = {event, number};
  if (::write(pipe, &message, sizeof message) != sizeof message) {
    ::_exit(1);
  }
}

/// All that writers have acknowledged.
struct Acknowledged {
  std::set<std::uint32_t> samples;
  std::set<std::uint32_t> removing;
  std::set<std::uint32_t> removed;
  std::uint32_t revision = 0;

  void take(const Message& message) {
    switch (message.event) {
      case Event::kOpened:
        break;
      case Event::kSample:
        samples.insert(message.number);
        break;
      case Event::kRemoving:
        removing.insert(message.number);
        break;
      case Event::kRemoved:
        removed.insert(message.number);
        break;
      case Event::kRevision:
        revision = message.number;
        break;
    }
  }
};

inline void expectNothingLost(const std::string& path, const Acknowledged& acknowledged) {
  const SessionDatabase database(path, jointIdentity());
  std::set<std::uint32_t> in_use;
  for (const Sample& sample : database.samplesInUse()) {
    in_use.insert(sample.id);
    EXPECT_TRUE(isSame(sample, database_examples::sample(sample.id, kCoils))) << sample.id;
    EXPECT_EQ(acknowledged.removed.count(sample.id), 0U) << sample.id;
  }
  for (const std::uint32_t id : acknowledged.samples) {
    EXPECT_EQ(in_use.count(id) + acknowledged.removing.count(id) > 0, true) << id;
  }
  const Revision current = database.current();
  EXPECT_GE(current.number, acknowledged.revision);
  if (current.number > 0) {
    EXPECT_TRUE(isSame(current.state, database_examples::state(current.number, kJointParameters)));
  }
}

/// Counts of what must not be: torn pages, rows without what they rest on, cycles without their
/// revision, samples without all currents.
inline void expectNothingTorn(const std::string& path) {
  using database_examples::query;
  EXPECT_EQ(query(path, "PRAGMA integrity_check"), "ok");
  EXPECT_EQ(query(path, "PRAGMA foreign_key_check"), "");
  EXPECT_EQ(query(path,
                  "SELECT count(*) FROM cycles WHERE success AND id NOT IN (SELECT cycle FROM "
                  "revisions WHERE cycle IS NOT NULL)"),
            "0");
  EXPECT_EQ(query(path, "SELECT count(*) FROM revisions WHERE number > 0 AND cycle IS NULL"), "0");
  EXPECT_EQ(query(path,
                  "SELECT count(*) FROM cycles WHERE (SELECT count(*) FROM cycle_estimates "
                  "WHERE cycle = cycles.id) <> 9"),
            "0");
  EXPECT_EQ(query(path,
                  "SELECT count(*) FROM samples WHERE (SELECT count(*) FROM sample_currents "
                  "WHERE sample = samples.id) <> 24"),
            "0");
}

}  // namespace sac::killed_writer
