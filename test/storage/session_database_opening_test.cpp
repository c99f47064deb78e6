#include <filesystem>
#include <fstream>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "spherical_actuator_calibration/base/error.hpp"
#include "spherical_actuator_calibration/calibration/calibration_session.hpp"
#include "spherical_actuator_calibration/storage/session_database.hpp"
#include "storage/database_examples.hpp"
#include "support/error_message.hpp"
#include "support/temporary_folder.hpp"

namespace sac {
namespace {

using database_examples::identity;
using database_examples::kCoils;
using database_examples::kDate;
using database_examples::kParameters;

class OpeningTest : public ::testing::Test {
 protected:
  std::string path() const { return folder_.path("session.db"); }

  /// Sentence with which opening is refused.
  std::string refusal(const SessionIdentity& who) const {
    return errorMessage<DataError>([&] { const SessionDatabase database(path(), who); });
  }
  void expectRefusal(const std::string& part, const SessionIdentity& who = identity()) const {
    const std::string message = refusal(who);
    EXPECT_NE(message.find(part), std::string::npos) << message;
    EXPECT_NE(message.find(path()), std::string::npos) << message;
  }

  /// A database with some content; returns its text.
  std::string make() const {
    {
      SessionDatabase database(path(), identity());
      for (std::uint32_t id = 1; id <= 20; ++id) {
        database.addSample(database_examples::sample(id, kCoils), kDate);
      }
      database.addCycle(database_examples::report(1, 20, kParameters),
                        database_examples::state(1, kParameters),
                        false,
                        kDate);
    }
    return contentOf(path());
  }

  TemporaryFolder folder_;
};

TEST_F(OpeningTest, OneProcessAtATime) {
  const SessionDatabase first(path(), identity());
  expectRefusal("another calibration node works with this session");
}

TEST_F(OpeningTest, AfterClosingItIsFreeAgain) {
  make();
  EXPECT_EQ(SessionDatabase(path(), identity()).samplesInUse().size(), 20U);
}

TEST_F(OpeningTest, AnotherUnitIsRefused) {
  const std::string before = make();
  SessionIdentity other = identity();
  other.start.actuator.serial = "SA-002";
  expectRefusal("with serial \"SA-001\", but the description is of \"", other);
  other.start.actuator.serial = "";
  expectRefusal("without serial", other);
  other = identity();
  other.start.actuator.name = "other";
  expectRefusal("but the description is of \"other\"", other);
  EXPECT_EQ(contentOf(path()), before);
}

TEST_F(OpeningTest, AnotherDescriptionOfTheUnitIsRefused) {
  make();
  SessionIdentity other = identity();
  other.start.actuator.coils[3].polar += 1e-12;
  expectRefusal("started with another description", other);
  other = identity();
  other.start.actuator.poles.pop_back();
  expectRefusal("started with another description", other);
  other = identity();
  other.start.actuator.torque_curve->coefficients[0] += 1e-9;
  expectRefusal("started with another description", other);
  other = identity();
  other.start = CalibrationSession(other.start, {}, {}).description({kDate, {}, "0.1.0", 1});
  other.start.stddevs.joints[1].offset = 1e-3;
  expectRefusal("started with another description", other);
}

TEST_F(OpeningTest, OtherLaboratoryEffectsAreRefused) {
  make();
  SessionIdentity other = identity();
  other.config.effects["torque_bias"] = true;
  expectRefusal("models the laboratory effects \"none\"", other);
  expectRefusal("asks for \"torque_bias\"", other);
}

TEST_F(OpeningTest, AnotherWorkspaceIsTheSameUnit) {
  make();
  SessionIdentity other = identity();
  other.start.actuator.workspace.tilt_limit = 0.4;
  EXPECT_EQ(refusal(other), "no exception");
}

TEST_F(OpeningTest, ANewerFormatIsRefused) {
  make();
  database_examples::change(path(), "PRAGMA user_version = 11");
  expectRefusal("a newer version of this package made this session database");
}

TEST_F(OpeningTest, OtherFilesAreRefusedAndKept) {
  folder_.write("session.db", std::string(5000, 'x'));
  expectRefusal("the file is damaged");
  EXPECT_EQ(contentOf(path()), std::string(5000, 'x'));
}

TEST_F(OpeningTest, OtherDatabasesAreRefusedAndKept) {
  folder_.write("session.db", "");
  database_examples::change(path(), "CREATE TABLE addresses (name TEXT)");
  const std::string before = contentOf(path());
  expectRefusal("this is not a session database");
  EXPECT_EQ(contentOf(path()), before);
}

TEST_F(OpeningTest, WhatThisPackageDoesNotMakeIsRefused) {
  const std::string whole = make();
  const std::vector<std::pair<std::string, std::string>> cases = {
      {"CREATE TRIGGER t AFTER INSERT ON samples BEGIN DELETE FROM samples WHERE id = NEW.id; END",
       "the trigger \"t\""},
      {"CREATE TABLE q AS SELECT * FROM unit; DROP TABLE unit; CREATE VIEW unit AS WITH RECURSIVE "
       "r(n) AS (SELECT 1 UNION ALL SELECT n + 1 FROM r) SELECT q.* FROM q, r WHERE n < 0",
       "the table \"q\""},
      {"DROP TABLE unit; CREATE VIEW unit AS WITH RECURSIVE r(n) AS (SELECT 1 UNION ALL "
       "SELECT n + 1 FROM r) SELECT n FROM r WHERE n < 0",
       "the view \"unit\""},
      {"CREATE INDEX stamps ON samples (stamp)", "the index \"stamps\""},
      {"DROP TABLE sample_currents; CREATE TABLE sample_currents (sample INTEGER, coil INTEGER, "
       "current ANY NOT NULL, UNIQUE (sample) ON CONFLICT REPLACE) STRICT",
       "the table \"sample_currents\""},
      {"ALTER TABLE unit ADD COLUMN bytes BLOB AS (zeroblob(1000000000))", "the table \"unit\""},
      {"DROP TABLE unit; CREATE TABLE unit (id INTEGER PRIMARY KEY /* , */ CHECK (id = 1), name "
       "TEXT NOT NULL)",
       "the table \"unit\""},
      {"CREATE TABLE \"\x1b[31m\" (a)", "the table \"\\x1b[31m\""},
  };
  for (const auto& [sql, part] : cases) {
    folder_.write("session.db", whole);
    database_examples::change(path(), sql);
    const std::string before = contentOf(path());
    expectRefusal("the session database holds " + part + " as this package does not make it");
    EXPECT_EQ(contentOf(path()), before);
  }
}

TEST_F(OpeningTest, RowsThatHoldNoSampleAreTold) {
  const std::vector<std::pair<std::string, std::string>> cases = {
      {"UPDATE samples SET id = 4294967301 WHERE id = 20", "4294967301 stands where"},
      {"UPDATE samples SET measurements = -1 WHERE id = 20", "-1 stands where"},
      {"UPDATE samples SET r11 = 'east' WHERE id = 20", "\"east\" stands where"},
      {"UPDATE samples SET r11 = x'00' WHERE id = 20", "stands where"},
      {"UPDATE sample_currents SET coil = 30 WHERE sample = 7 AND coil = 3",
       "Sample 7: its currents"},
      {"DELETE FROM sample_currents WHERE sample = 7 AND coil = 1", "Sample 7: its currents"},
  };
  for (const auto& [change, words] : cases) {
    std::filesystem::remove(path());
    make();
    database_examples::change(path(), change);
    const std::string message = errorMessage<DataError>([&] {
      SessionDatabase database(path(), identity());
      database.samplesInUse();
    });
    EXPECT_NE(message.find(words), std::string::npos) << change << ": " << message;
  }
}

TEST_F(OpeningTest, RowsThatHoldNoWindowAreTold) {
  for (const char* change : {
           "UPDATE motion_windows SET joints = substr(joints, 2)",
           "UPDATE motion_windows SET coils = 23",
           "UPDATE motion_windows SET first = -1",
       }) {
    std::filesystem::remove(path());
    SessionDatabase(path(), identity()).addMotion({database_examples::window(1, kCoils)}, kDate);
    database_examples::change(path(), change);
    const std::string message =
        errorMessage<DataError>([&] { SessionDatabase(path(), identity()).motion(); });
    EXPECT_NE(message.find(path() + ": the file is damaged"), std::string::npos) << message;
  }
}

TEST_F(OpeningTest, TheLastNumberOfASampleIsFollowedByNone) {
  make();
  database_examples::change(path(), "UPDATE samples SET id = 4294967295 WHERE id = 20");
  SessionDatabase database(path(), identity());
  EXPECT_NE(errorMessage<DataError>([&] { database.nextSampleId(); }).find("the last number"),
            std::string::npos);
}

// The parameters in force, and the cycles that led to them, which the node reads when it starts.
TEST_F(OpeningTest, RowsThatHoldNoParametersAreTold) {
  const std::string nan = "x'000000000000f87f'";
  for (const std::string& sql : {
           "UPDATE revisions SET coordinates = CAST(" + nan + " || substr(coordinates, 9) AS BLOB)",
           "UPDATE revisions SET covariance = CAST(" + nan + " || substr(covariance, 9) AS BLOB)",
           std::string("UPDATE revisions SET covariance = x'00'"),
           std::string("DELETE FROM cycle_errors"),
           std::string("UPDATE cycles SET cycle = 'unknown'"),
           std::string("UPDATE cycles SET iterations = -1"),
           std::string("PRAGMA foreign_keys = OFF; DELETE FROM revisions"),
       }) {
    std::filesystem::remove(path());
    make();
    database_examples::change(path(), sql);
    const SessionDatabase database(path(), identity());
    const std::string message = errorMessage<DataError>([&] {
      database.current();
      database.cyclesOfRevision(1);
    });
    EXPECT_NE(message.find(path() + ": the file is damaged"), std::string::npos)
        << sql << ": " << message;
  }
}

TEST_F(OpeningTest, AnEmptyFileBecomesADatabase) {
  // What is left when the process ends before the first transaction.
  folder_.write("session.db", "");
  EXPECT_EQ(SessionDatabase(path(), identity()).current().number, 0U);
}

TEST_F(OpeningTest, ATruncatedFileIsRefused) {
  const std::string whole = make();
  for (const std::size_t size : {whole.size() / 2, whole.size() - 4096, whole.size() - 1}) {
    folder_.write("session.db", whole.substr(0, size));
    expectRefusal("the file is damaged; put a copy of it back");
  }
}

TEST_F(OpeningTest, ACorruptFileIsRefused) {
  const std::string whole = make();
  std::string corrupt = whole;
  // The header of every page but the first.
  for (std::size_t page = 4096; page < corrupt.size(); page += 4096) {
    corrupt.replace(page, 8, "\x55\x55\x55\x55\x55\x55\x55\x55");
  }
  folder_.write("session.db", corrupt);
  expectRefusal("the file is damaged");
  folder_.write("session.db", whole);
  EXPECT_EQ(refusal(identity()), "no exception");
}

TEST_F(OpeningTest, AFolderInItsPlaceIsRefused) {
  std::filesystem::create_directory(path());
  expectRefusal("the session database cannot be opened, because the file or its folder cannot be");
}

TEST_F(OpeningTest, AFolderThatIsNotThereIsRefused) {
  const std::string message = errorMessage<DataError>(
      [&] { const SessionDatabase database(folder_.path("none/session.db"), identity()); });
  EXPECT_NE(message.find("No such file or directory"), std::string::npos) << message;
}

TEST_F(OpeningTest, AFolderThatTakesNoFilesIsRefused) {
  // Not even root makes files here.
  const std::string message = errorMessage<DataError>(
      [&] { const SessionDatabase database("/proc/self/session.db", identity()); });
  EXPECT_NE(message.find("/proc/self/session.db: the session database cannot be opened"),
            std::string::npos)
      << message;
}

}  // namespace
}  // namespace sac
