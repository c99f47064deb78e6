#include <cstdint>
#include <filesystem>
#include <string>

#include <gtest/gtest.h>
#include <sys/stat.h>
#include <sys/wait.h>

#include "spherical_actuator_calibration/base/error.hpp"
#include "spherical_actuator_calibration/measurement/pose_to_measure.hpp"
#include "spherical_actuator_calibration/storage/session_database.hpp"
#include "storage/database_examples.hpp"
#include "support/error_message.hpp"
#include "support/temporary_folder.hpp"

#include <unistd.h>

namespace sac {
namespace {

namespace fs = std::filesystem;
using database_examples::identity;
using database_examples::jointIdentity;
using database_examples::kCoils;
using database_examples::kDate;
using database_examples::kParameters;

/// A session in a folder that can be taken away.
class PlaceTest : public ::testing::Test {
 protected:
  PlaceTest() { fs::create_directory(directory()); }

  std::string directory() const { return folder_.path("unit"); }
  std::string path() const { return directory() + "/session.db"; }

  static std::string add(SessionDatabase& database, std::uint32_t id) {
    return errorMessage<DataError>(
        [&] { database.addSample(database_examples::sample(id, kCoils), kDate); });
  }
  static void expectRefusal(SessionDatabase& database) {
    const std::string message = add(database, 7);
    EXPECT_NE(message.find("sample 7 was not stored, because the file was removed or replaced"),
              std::string::npos)
        << message;
  }

  TemporaryFolder folder_;
};

TEST_F(PlaceTest, NothingIsAcknowledgedAfterTheFolderIsGone) {
  SessionDatabase database(path(), jointIdentity());
  fs::remove_all(directory());
  expectRefusal(database);
  fs::create_directory(directory());
  expectRefusal(database);
  EXPECT_THROW(database.removeSample(1, kDate), DataError);
  EXPECT_THROW(database.clearSamples(kDate), DataError);
}

TEST_F(PlaceTest, WhatWasRefusedMeanwhileIsNotThereAfterwards) {
  {
    SessionDatabase database(path(), jointIdentity());
    EXPECT_EQ(add(database, 1), "no exception");
    // As when another disk is mounted there, and unmounted again.
    fs::rename(directory(), folder_.path("away"));
    fs::create_directory(directory());
    { SessionDatabase other(path(), jointIdentity()); }
    expectRefusal(database);
    fs::remove_all(directory());
    fs::rename(folder_.path("away"), directory());
    EXPECT_EQ(add(database, 2), "no exception");
  }
  SessionDatabase database(path(), jointIdentity());
  ASSERT_EQ(database.samplesInUse().size(), 2U);
  EXPECT_EQ(database.samplesInUse()[1].id, 2U);
}

TEST_F(PlaceTest, WhatIsNoFileBesideItIsToldAndNotOpened) {
  SessionDatabase database(path(), jointIdentity());
  std::uint32_t id = 0;
  for (const char* const ending : {"-journal", "-wal", "-shm"}) {
    const std::string beside = path() + ending;
    fs::remove(beside);
    ASSERT_EQ(::mkfifo(beside.c_str(), 0600), 0);
    const std::string told = ", because " + beside + " is a FIFO, not a file; remove it";
    EXPECT_NE(add(database, 9).find(told), std::string::npos) << add(database, 9);
    EXPECT_NE(errorMessage<DataError>([&] { database.samplesInUse(); }).find(told),
              std::string::npos);
    fs::remove(beside);
    fs::create_symlink("elsewhere", beside);
    EXPECT_NE(add(database, 9).find("is a symbolic link, not a file"), std::string::npos);
    fs::remove(beside);
    EXPECT_EQ(add(database, ++id), "no exception");
  }
}

TEST_F(PlaceTest, ASessionIsNotOpenedWithWhatIsNoFileBesideIt) {
  for (const char* const ending : {"-journal", "-wal", "-shm"}) {
    const std::string beside = path() + ending;
    ASSERT_EQ(::mkfifo(beside.c_str(), 0600), 0);
    const std::string told =
        errorMessage<DataError>([&] { const SessionDatabase opened(path(), jointIdentity()); });
    EXPECT_NE(told.find(beside + " is a FIFO, not a file; remove it"), std::string::npos) << told;
    fs::remove(beside);
    { const SessionDatabase opened(path(), jointIdentity()); }
    // What a link leads to has its journal there.
    fs::remove(beside);
    fs::create_symlink(path(), folder_.path("link.db"));
    ASSERT_EQ(::mkfifo(beside.c_str(), 0600), 0);
    EXPECT_THROW(SessionDatabase(folder_.path("link.db"), jointIdentity()), DataError);
    fs::remove(beside);
    fs::remove(folder_.path("link.db"));
  }
}

/// Whether a process that knows nothing of this one can open the session: it waits for a byte.
class Stranger {
 public:
  explicit Stranger(const std::string& path) {
    if (::pipe(pipe_) != 0 || (process_ = ::fork()) < 0) {
      throw std::runtime_error("No process could be made.");
    }
    if (process_ == 0) {
      char byte = 0;
      const bool told = ::read(pipe_[0], &byte, 1) == 1;
      const std::string message =
          errorMessage<DataError>([&] { const SessionDatabase mine(path, jointIdentity()); });
      const bool refused =
          message.find("another calibration node works with this session") != std::string::npos;
      ::_exit(told && refused ? 1 : 0);
    }
  }
  bool isRefused() {
    int status = 0;
    const bool done = ::write(pipe_[1], "x", 1) == 1 && ::waitpid(process_, &status, 0) == process_;
    return done && WIFEXITED(status) && WEXITSTATUS(status) == 1;
  }

 private:
  int pipe_[2] = {};
  pid_t process_ = -1;
};

TEST_F(PlaceTest, TheLockCannotBeRemoved) {
  Stranger early(path());
  Stranger late(path());
  {
    const SessionDatabase database(path(), jointIdentity());
    // Nothing but the database and its journals can be removed.
    for (const auto& file : fs::directory_iterator(directory())) {
      if (file.path().string().compare(0, path().size(), path()) != 0 ||
          file.path().extension() == ".lock") {
        fs::remove(file.path());
      }
    }
    EXPECT_TRUE(early.isRefused());
  }
  EXPECT_FALSE(late.isRefused());
}

TEST_F(PlaceTest, TheLockHoldsByAnotherName) {
  fs::create_directory(folder_.path("second"));
  const SessionDatabase database(path(), jointIdentity());
  fs::create_hard_link(path(), folder_.path("second/session.db"));
  const std::string message = errorMessage<DataError>(
      [&] { const SessionDatabase other(folder_.path("second/session.db"), jointIdentity()); });
  EXPECT_NE(message.find("another calibration node"), std::string::npos) << message;
}

TEST_F(PlaceTest, RevisionsOfKnownParametersTakeLittle) {
  constexpr unsigned kTimes = 100;
  CalibrationState state = database_examples::state(1, kParameters);
  state.belief.covariance = (state.belief.covariance + state.belief.covariance.transpose()).eval();
  const auto size = [&] { return fs::file_size(path()); };
  CalibrationState start;
  {
    SessionDatabase database(path(), identity());
    start = database.current().state;
    database.addCycle(database_examples::report(1, 0, kParameters), state, false, kDate);
  }
  const std::uintmax_t before = size();
  {
    SessionDatabase database(path(), identity());
    for (unsigned n = 0; n < kTimes; ++n) {
      database.addRevision(start, "nominal", "reset", false, kDate);
      database.addRevision(state, "restored", "revision 1", false, kDate, 1);
    }
  }
  EXPECT_LT(size() - before, 2 * kTimes * 2000U);  // a covariance alone has 43 kB
  SessionDatabase database(path(), identity());
  EXPECT_TRUE(database_examples::isSame(database.revision(2 * kTimes)->state, start));
  EXPECT_TRUE(database_examples::isSame(database.current().state, state));
}

/// Cycles as formats before 6 had them.
constexpr char kWithoutDoubts[] =
    "ALTER TABLE cycles DROP COLUMN error_unit;"
    "ALTER TABLE cycles DROP COLUMN registration;"
    "DROP TABLE cycle_motions;"
    "DROP TABLE cycle_windows_left_out;"
    "DROP TABLE cycle_windows_held_out;"
    "DROP TABLE cycle_window_residuals;"
    "DROP TABLE planned_patterns;"
    "DROP TABLE planned_poses;"
    "DROP TABLE cycle_doubts;"
    "ALTER TABLE cycles DROP COLUMN contradicted;"
    "ALTER TABLE cycles DROP COLUMN degrees_of_freedom;"
    "ALTER TABLE cycles DROP COLUMN in_force";

/// Cycles as formats before 4 had them.
constexpr char kWithoutMotionAndUnits[] =
    "DROP TABLE motion_windows;"
    "ALTER TABLE cycle_estimates DROP COLUMN unit;"
    "PRAGMA writable_schema = ON;"
    "UPDATE sqlite_schema SET sql = replace(sql, 'cycle TEXT NOT NULL,', 'cycle TEXT NOT NULL "
    "CHECK (cycle IN (''joint'', ''poles'', ''coil'', ''refine'')),') WHERE name = 'cycles';"
    "PRAGMA writable_schema = OFF; PRAGMA user_version = 3";

/// Samples as formats before 3 had them.
constexpr char kWithoutSharedErrors[] =
    "ALTER TABLE samples DROP COLUMN dwell;"
    "ALTER TABLE samples DROP COLUMN joint_1_shared_stddev;"
    "ALTER TABLE samples DROP COLUMN joint_2_shared_stddev;"
    "ALTER TABLE samples DROP COLUMN joint_3_shared_stddev;"
    "ALTER TABLE samples DROP COLUMN torque_shared_stddev";

TEST_F(PlaceTest, ADatabaseOfTheFirstFormatIsTakenOver) {
  const CalibrationState state = database_examples::state(1, kParameters);
  {
    SessionDatabase database(path(), identity());
    database.addCycle(database_examples::report(1, 0, kParameters), state, false, kDate);
  }
  // What the first format did not have are the last columns of two tables.
  database_examples::change(path(), kWithoutDoubts);
  database_examples::change(path(), kWithoutMotionAndUnits);
  database_examples::change(path(), kWithoutSharedErrors);
  database_examples::change(
      path(),
      "PRAGMA writable_schema = ON;"
      "UPDATE sqlite_schema SET sql = substr(sql, 1, instr(sql, ',\n  covariance_of') - 1) || "
      "'\n) STRICT' WHERE name = 'revisions';"
      "PRAGMA writable_schema = OFF; PRAGMA user_version = 1");
  ASSERT_EQ(database_examples::query(path(), "SELECT count(*) FROM pragma_table_info('revisions')"),
            "11");
  {
    SessionDatabase database(path(), identity());
    EXPECT_TRUE(database_examples::isSame(database.current().state, state));
    database.addRevision(state, "restored", "revision 1", false, kDate, 1);
  }
  EXPECT_TRUE(
      database_examples::isSame(SessionDatabase(path(), identity()).current().state, state));
  EXPECT_EQ(database_examples::query(path(), "PRAGMA user_version"), "10");
}

TEST_F(PlaceTest, SamplesOfTheSecondFormatShareNothing) {
  Sample sample = database_examples::sample(1, 24);
  {
    SessionDatabase database(path(), identity());
    database.addSample(sample, kDate);
  }
  database_examples::change(path(), kWithoutDoubts);
  database_examples::change(path(), kWithoutMotionAndUnits);
  database_examples::change(path(), kWithoutSharedErrors);
  database_examples::change(path(), "PRAGMA user_version = 2");
  sample.dwell = 0;
  sample.joint_shared_stddev.setZero();
  sample.torque_shared_stddev = 0.0;
  const std::vector<Sample> samples = SessionDatabase(path(), identity()).samplesInUse();
  ASSERT_EQ(samples.size(), 1U);
  EXPECT_TRUE(database_examples::isSame(samples.front(), sample));
}

TEST_F(PlaceTest, ADatabaseOfTheThirdFormatTakesMotions) {
  CycleReport report = database_examples::report(1, 0, kParameters);
  const CalibrationState state = database_examples::state(1, kParameters);
  {
    SessionDatabase database(path(), identity());
    database.addCycle(report, state, false, kDate);
  }
  database_examples::change(path(), kWithoutDoubts);
  database_examples::change(path(), kWithoutMotionAndUnits);
  SessionDatabase database(path(), identity());
  report.doubts.clear();
  report.degrees_of_freedom = 0;
  for (ParameterEstimate& estimate : report.estimates) {
    estimate.unit.clear();
  }
  ASSERT_EQ(database.cyclesOfRevision(1).size(), 1U);
  EXPECT_TRUE(database_examples::isSame(database.cyclesOfRevision(1)[0], report));
  report.cycle = Cycle::kMotion;
  database.addCycle(report, kDate);
  EXPECT_EQ(database.lastCycle()->cycle, Cycle::kMotion);
  database.addMotion({database_examples::window(1, 24)}, kDate);
  EXPECT_EQ(database.motion().size(), 1U);
  EXPECT_EQ(database_examples::query(path(), "SELECT parent FROM pragma_foreign_key_check"), "");
  EXPECT_EQ(database_examples::query(path(),
                                     "SELECT name FROM sqlite_schema WHERE name LIKE '%earlier%'"),
            "");
}

TEST_F(PlaceTest, ADatabaseOfTheFourthFormatKeepsMotions) {
  CycleReport report = database_examples::report(1, 0, kParameters);
  SessionDatabase(path(), identity()).addCycle(report, kDate);
  database_examples::change(path(), kWithoutDoubts);
  report.doubts.clear();
  report.degrees_of_freedom = 0;
  database_examples::change(path(), "DROP TABLE motion_windows; PRAGMA user_version = 4");
  SessionDatabase database(path(), identity());
  EXPECT_TRUE(database_examples::isSame(*database.lastCycle(), report));
  database.addMotion({database_examples::window(1, 24)}, kDate);
  EXPECT_EQ(database.motion().size(), 1U);
}

TEST_F(PlaceTest, ADatabaseOfTheFifthFormatKeepsDoubts) {
  CycleReport report = database_examples::report(1, 0, 73);
  SessionDatabase(path(), identity()).addCycle(report, kDate);
  database_examples::change(path(), kWithoutDoubts);
  database_examples::change(path(), "PRAGMA user_version = 5");
  SessionDatabase database(path(), identity());
  report.success = false;
  report.contradicted = true;
  database.addCycle(report, kDate);
  ASSERT_EQ(database.cyclesOfRevision(0).size(), 1U) << "nobody knows when the first one was run";
  EXPECT_TRUE(database_examples::isSame(database.cyclesOfRevision(0)[0], report));
}

TEST_F(PlaceTest, ADatabaseOfTheSixthFormatTakesWhatMotionsTold) {
  CycleReport report = database_examples::report(1, 0, 73);
  SessionDatabase(path(), identity()).addCycle(report, kDate);
  database_examples::change(path(),
                            "DROP TABLE cycle_motions; DROP TABLE cycle_windows_left_out;"
                            "DROP TABLE cycle_windows_held_out; DROP TABLE cycle_window_residuals; "
                            "DROP TABLE planned_patterns; DROP TABLE planned_poses;"
                            "ALTER TABLE cycles DROP COLUMN registration;"
                            "ALTER TABLE cycles DROP COLUMN error_unit;"
                            "PRAGMA user_version = 6");
  SessionDatabase database(path(), identity());
  EXPECT_TRUE(database_examples::isSame(*database.lastCycle(), report));
  EXPECT_FALSE(database.lastCycle()->motion);
  report.cycle = Cycle::kMotion;
  report.motion = database_examples::summary();
  database.addCycle(report, kDate);
  EXPECT_TRUE(database_examples::isSame(*database.lastCycle()->motion, *report.motion));
}

TEST_F(PlaceTest, APlanOfTheSeventhFormatIsToCalibrateBy) {
  PosesToMeasure plan{{Eigen::Vector3d(0.1, -0.2, 0.3), {{{0, 1}}}, true}};
  SessionDatabase(path(), identity()).setPlan(plan);
  database_examples::change(path(),
                            "ALTER TABLE planned_poses DROP COLUMN validation;"
                            "ALTER TABLE cycles DROP COLUMN error_unit;"
                            "ALTER TABLE cycles DROP COLUMN registration; PRAGMA user_version = 7");
  SessionDatabase database(path(), identity());
  plan[0].validation = false;
  EXPECT_EQ(database.plan(), plan);
  plan[0].validation = true;
  database.setPlan(plan);
  EXPECT_EQ(database.plan(), plan);
}

TEST_F(PlaceTest, ADatabaseOfTheNinthFormatIsToldTheUnitsOfItsErrors) {
  CycleReport report = database_examples::report(1, 0, 73);
  const auto units = [&] {
    return database_examples::query(path(), "SELECT group_concat(error_unit, ' ') FROM cycles");
  };
  for (const ErrorMeasure measure :
       {ErrorMeasure::kOrientation, ErrorMeasure::kTorque, ErrorMeasure::kStandardized}) {
    report.error_measure = measure;
    SessionDatabase(path(), identity()).addCycle(report, kDate);
  }
  EXPECT_EQ(units(), "rad N·m 1");
  database_examples::change(path(),
                            "ALTER TABLE cycles DROP COLUMN error_unit; PRAGMA user_version = 9");
  EXPECT_TRUE(database_examples::isSame(*SessionDatabase(path(), identity()).lastCycle(), report));
  EXPECT_EQ(units(), "rad N·m 1");
}

}  // namespace
}  // namespace sac
