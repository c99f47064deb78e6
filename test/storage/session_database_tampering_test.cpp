#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <functional>
#include <string>

#include <SQLiteCpp/Database.h>
#include <gtest/gtest.h>

#include "session_connection.hpp"
#include "spherical_actuator_calibration/base/error.hpp"
#include "spherical_actuator_calibration/storage/live_session.hpp"
#include "spherical_actuator_calibration/storage/session_database.hpp"
#include "storage/database_examples.hpp"
#include "support/error_message.hpp"
#include "support/temporary_folder.hpp"

namespace sac {
namespace {

namespace fs = std::filesystem;
using database_examples::jointIdentity;
using database_examples::kCoils;
using database_examples::kDate;

/// Files of a session that are changed under their names while it is open.
class TamperingTest : public ::testing::Test {
 protected:
  std::string path() const { return folder_.path("session.db"); }

  static std::string add(SessionDatabase& database, std::uint32_t id) {
    return errorMessage<DataError>(
        [&] { database.addSample(database_examples::sample(id, kCoils), kDate); });
  }
  static void expectRefusal(const std::string& message) {
    EXPECT_NE(message.find("another program changed or shortened it"), std::string::npos)
        << message;
  }
  /// A session with two samples, and the text of its file with the first only.
  std::string fill(SessionDatabase& database) const {
    EXPECT_EQ(add(database, 1), "no exception");
    std::string text = textOf(path());
    EXPECT_EQ(add(database, 2), "no exception");
    return text;
  }
  // Closing any descriptor of the file would drop the locks of SQLite in this process; another
  // program does not.
  std::string textOf(const std::string& file) const {
    run("cat '" + file + "' > '" + folder_.path("text") + "'");
    return contentOf(folder_.path("text"));
  }
  void put(const std::string& text) const {
    folder_.write("text", text);
    run("cat '" + folder_.path("text") + "' > '" + path() + "'");
  }
  static void run(const std::string& command) {
    EXPECT_EQ(std::system(command.c_str()), 0);  // NOLINT(cert-env33-c,concurrency-mt-unsafe)
  }

  TemporaryFolder folder_;
};

TEST_F(TamperingTest, NothingIsAcknowledgedAfterTheFileWasCutOff) {
  for (const char* const size : {"0", "50", "4096", "20000"}) {
    fs::remove(path());
    SessionDatabase database(path(), jointIdentity());
    fill(database);
    run(std::string("truncate -s ") + size + " '" + path() + "'");
    expectRefusal(add(database, 3));
    expectRefusal(add(database, 3));
    expectRefusal(errorMessage<DataError>([&] { database.confirmSample(2); }));
    expectRefusal(errorMessage<DataError>([&] { database.clearSamples(kDate); }));
    expectRefusal(errorMessage<DataError>([&] { database.removeSample(7, kDate); }));
  }
}

TEST_F(TamperingTest, NothingIsAcknowledgedAfterAnOlderCopyWasWrittenOverIt) {
  {
    SessionDatabase database(path(), jointIdentity());
    const std::string older = fill(database);
    const std::string newest = textOf(path());
    put(older);
    expectRefusal(add(database, 3));
    // Where the content is the same again, nothing is lost.
    put(newest);
    EXPECT_EQ(add(database, 3), "no exception");
    put(older);
    expectRefusal(add(database, 4));
  }
  EXPECT_EQ(SessionDatabase(path(), jointIdentity()).samplesInUse().size(), 1U);
}

TEST_F(TamperingTest, ACopyWithAsManyTransactionsIsNoticed) {
  fs::create_directory(folder_.path("other"));
  const std::string other = folder_.path("other/session.db");
  SessionDatabase database(path(), jointIdentity());
  EXPECT_EQ(add(database, 1), "no exception");
  run("cp '" + path() + "' '" + other + "'");
  {
    SessionDatabase copy(other, jointIdentity());
    EXPECT_EQ(add(copy, 5), "no exception");
  }
  EXPECT_EQ(add(database, 2), "no exception");
  put(textOf(other));
  expectRefusal(add(database, 3));
}

TEST_F(TamperingTest, OneByteIsNoticed) {
  SessionDatabase database(path(), jointIdentity());
  fill(database);
  const std::string whole = textOf(path());
  for (const std::size_t place : {std::size_t{30}, whole.size() / 2, whole.size() - 1}) {
    std::string changed = whole;
    changed[place] = static_cast<char>(changed[place] ^ 1);
    put(changed);
    EXPECT_NE(add(database, 3), "no exception") << place;
  }
  put(whole);
  EXPECT_EQ(add(database, 3), "no exception");
}

TEST_F(TamperingTest, WhatAnotherProgramStoredIsNotTakenForOnesOwn) {
  SessionDatabase database(path(), jointIdentity());
  fill(database);
  database_examples::change(path(), "DELETE FROM sample_currents; DELETE FROM samples");
  expectRefusal(add(database, 3));
}

TEST_F(TamperingTest, WhatAnotherJournalTookBackIsNoticed) {
  const std::string other = folder_.path("other.db");
  SessionDatabase database(path(), jointIdentity());
  EXPECT_EQ(add(database, 1), "no exception");
  run("cp '" + path() + "' '" + other + "'");
  EXPECT_EQ(add(database, 2), "no exception");
  {
    // As a copy of the folder holds it that was made while a transaction was half written.
    SQLite::Database copy(other, SQLite::OPEN_READWRITE);
    copy.exec(
        "PRAGMA cache_size = 2; BEGIN; UPDATE samples SET validation = 1;"
        "CREATE TABLE large AS SELECT randomblob(100000) FROM revisions");
    run("cat '" + other + "-journal' > '" + path() + "-journal'");
  }
  expectRefusal(add(database, 3));
}

/// A session of which pages are changed within a transaction.
class MomentTest : public TamperingTest {
 protected:
  MomentTest() {
    SessionDatabase database(path(), jointIdentity());
    for (std::uint32_t id = 1; id <= 20; ++id) {
      EXPECT_EQ(add(database, id), "no exception");
    }
  }
  /// Writes into the file as another program does.
  void overwrite(std::size_t place, const std::string& bytes) const {
    run("printf '" + bytes + "' | dd of='" + path() +
        "' bs=1 conv=notrunc status=none seek=" + std::to_string(place));
  }
  static std::string write(SessionConnection& connection,
                           const std::function<void(SQLite::Database&)>& action) {
    return errorMessage<DataError>([&] { connection.write("it was not stored", action); });
  }
  static void insert(SQLite::Database& database) {
    database.exec(
        "INSERT INTO cycle_errors SELECT 1, 7, 0.5 FROM cycles;"
        "UPDATE samples SET validation = 1 WHERE id = 20");
  }

  static constexpr auto kNothing = [](SQLite::Database&) {};
};

TEST_F(MomentTest, AByteThatChangesWithinATransactionIsNoticed) {
  const std::size_t place = textOf(path()).find("actuator:");
  ASSERT_NE(place, std::string::npos);
  SessionConnection connection(path(), kNothing);
  expectRefusal(write(connection, [&](SQLite::Database& database) {
    insert(database);
    overwrite(place, "P");
  }));
  // Nobody knows any more what will be read back.
  overwrite(place, textOf(path()).substr(place, 1));
  expectRefusal(write(connection, insert));
}

TEST_F(MomentTest, NoPageIsReadThatWasChangedWithinATransaction) {
  const std::string whole = textOf(path());
  SessionConnection connection(path(), kNothing);
  expectRefusal(write(connection, [&](SQLite::Database& database) {
    overwrite(whole.size() - 1, "x");
    database.exec("PRAGMA shrink_memory; DELETE FROM sample_currents; DELETE FROM samples");
  }));
  put(whole);
  EXPECT_EQ(write(connection, insert), "no exception");
  EXPECT_EQ(database_examples::query(path(), "SELECT count(*) FROM sample_currents"), "480");
}

TEST_F(MomentTest, WhatIsCutOffOrAddedWithinATransactionIsNoticed) {
  const std::string whole = textOf(path());
  for (const char* const size : {"-4096", "+1", "+4096"}) {
    put(whole);
    SessionConnection connection(path(), kNothing);
    expectRefusal(write(connection, [&](SQLite::Database& database) {
      insert(database);
      run(std::string("truncate -s ") + size + " '" + path() + "'");
    }));
  }
}

TEST_F(MomentTest, WhatWasWrittenBeforeATransactionFailedIsUndone) {
  SessionConnection connection(path(), kNothing);
  const auto fail = [](SQLite::Database& database) {
    // More than SQLite keeps in memory.
    database.exec("PRAGMA cache_size = 2; UPDATE samples SET date = hex(randomblob(5000))");
    throw DataError("no");
  };
  EXPECT_EQ(write(connection, fail), "no");
  EXPECT_EQ(write(connection, insert), "no exception");
  EXPECT_EQ(database_examples::query(path(), "SELECT count(*) FROM samples WHERE date LIKE '20%'"),
            "20");
}

TEST_F(TamperingTest, WhoReadsIsWaitedForAndThenTold) {
  SessionDatabase database(path(), jointIdentity());
  {
    SQLite::Database reader(path(), SQLite::OPEN_READONLY);
    reader.exec("BEGIN; SELECT count(*) FROM samples");
    EXPECT_NE(add(database, 1).find("another program reads or writes the file"), std::string::npos);
    reader.exec("COMMIT");
    EXPECT_EQ(add(database, 1), "no exception");
  }
  EXPECT_EQ(database.samplesInUse().size(), 1U);
}

TEST_F(TamperingTest, ARepetitionIsNotAcknowledgedEither) {
  const SessionIdentity who = jointIdentity();
  LiveSession session(who.start, who.config, path(), "0.1.0");
  Sample sample = database_examples::sample(1, 0);
  sample.has_torque = false;
  sample.R_stator_rotor.setIdentity();
  sample.joint_stddev.setConstant(1e-4);
  sample.orientation_stddev = 1e-4;
  sample.duration = 1.0;
  sample.joint_shared_stddev.setZero();
  sample.torque_shared_stddev = 0.0;
  session.addSample(sample, kDate);
  session.addSample(sample, kDate);
  run("truncate -s 0 '" + path() + "'");
  expectRefusal(errorMessage<DataError>([&] { session.addSample(sample, kDate); }));
  // As the sentence says, the session is held all the same.
  EXPECT_EQ(session.calibration().samples().size(), 1U);
  EXPECT_NO_THROW(session.description(kDate));
}

TEST_F(TamperingTest, NothingBesideTheFileHoldsWhatWasAcknowledged) {
  SessionDatabase database(path(), jointIdentity());
  fill(database);
  for (const auto& file : fs::directory_iterator(fs::path(path()).parent_path())) {
    if (file.path() != path() && file.path().filename() != "text") {
      EXPECT_EQ(file.path().filename(), "session.db-journal");
      EXPECT_EQ(fs::file_size(file.path()), 0U);
      fs::remove(file.path());
    }
  }
  EXPECT_EQ(add(database, 3), "no exception");
  EXPECT_EQ(database.samplesInUse().size(), 3U);
}

TEST_F(TamperingTest, TheLogOfEarlierVersionsIsTakenOver) {
  const std::string copy = folder_.path("copy.db");
  {
    SessionDatabase database(path(), jointIdentity());
    fill(database);
  }
  database_examples::change(path(), "PRAGMA journal_mode = WAL");
  {
    SQLite::Database earlier(path(), SQLite::OPEN_READWRITE);
    earlier.exec("UPDATE samples SET validation = 1");
    // As one that was killed leaves it: what it stored last is in the log alone.
    run("cp '" + path() + "' '" + copy + "' && cp '" + path() + "-wal' '" + copy + "-wal'");
  }
  SessionDatabase database(copy, jointIdentity());
  ASSERT_EQ(database.samplesInUse().size(), 2U);
  EXPECT_TRUE(database.samplesInUse()[0].validation);
  EXPECT_FALSE(fs::exists(copy + "-wal"));
  EXPECT_FALSE(fs::exists(copy + "-shm"));
  EXPECT_EQ(add(database, 3), "no exception");
}

}  // namespace
}  // namespace sac
