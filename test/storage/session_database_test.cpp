#include "spherical_actuator_calibration/storage/session_database.hpp"

#include <cmath>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "spherical_actuator_calibration/base/error.hpp"
#include "spherical_actuator_calibration/calibration/calibration_session.hpp"
#include "spherical_actuator_calibration/measurement/pose_to_measure.hpp"
#include "storage/database_examples.hpp"
#include "support/error_message.hpp"
#include "support/temporary_folder.hpp"

namespace sac {
namespace {

using database_examples::identity;
using database_examples::isSame;
using database_examples::kCoils;
using database_examples::kDate;
using database_examples::kParameters;

class SessionDatabaseTest : public ::testing::Test {
 protected:
  SessionDatabase open() const { return SessionDatabase(path(), identity()); }
  std::string path() const { return folder_.path("session.db"); }

  static void addSamples(SessionDatabase& database, std::uint32_t count) {
    for (std::uint32_t id = 1; id <= count; ++id) {
      database.addSample(database_examples::sample(id, kCoils), kDate);
    }
  }
  static std::vector<std::uint32_t> idsInUse(const SessionDatabase& database) {
    std::vector<std::uint32_t> ids;
    for (const Sample& sample : database.samplesInUse()) {
      ids.push_back(sample.id);
    }
    return ids;
  }

  TemporaryFolder folder_;
};

using Ids = std::vector<std::uint32_t>;

TEST_F(SessionDatabaseTest, KeepsEveryBitOfSamples) {
  open().addSample(database_examples::sample(7, kCoils), kDate);
  const std::vector<Sample> samples = open().samplesInUse();
  ASSERT_EQ(samples.size(), 1U);
  EXPECT_TRUE(isSame(samples[0], database_examples::sample(7, kCoils)));
}

TEST_F(SessionDatabaseTest, KeepsSamplesWithoutCurrents) {
  Sample sample = database_examples::sample(1, 0);
  sample.has_torque = false;
  sample.has_orientation = false;
  open().addSample(sample, kDate);
  EXPECT_TRUE(isSame(open().samplesInUse().at(0), sample));
}

TEST_F(SessionDatabaseTest, RefusesASampleTwiceAndSamplesThatAreNoNumbers) {
  SessionDatabase database = open();
  addSamples(database, 1);
  EXPECT_NE(errorMessage<DataError>([&] {
              database.addSample(database_examples::sample(1, kCoils), kDate);
            }).find("sample 1 was not stored"),
            std::string::npos);
  Sample sample = database_examples::sample(2, kCoils);
  sample.current[5] = std::nan("");
  EXPECT_THROW(database.addSample(sample, kDate), DataError);
  EXPECT_EQ(idsInUse(database), Ids{1});  // nor half of the second
  EXPECT_EQ(database.nextSampleId(), 2U);
}

TEST_F(SessionDatabaseTest, KeepsEveryBitOfAMotion) {
  open().addMotion({database_examples::window(1, kCoils), database_examples::window(2, kCoils)},
                   kDate);
  open().addMotion({database_examples::window(3, kCoils)}, kDate);
  const std::vector<MotionSlice> windows = open().motion();
  ASSERT_EQ(windows.size(), 3U);
  for (unsigned n = 0; n < 3; ++n) {
    EXPECT_TRUE(isSame(windows[n], database_examples::window(n + 1, kCoils)));
  }
  open().forgetMotion();
  EXPECT_TRUE(open().motion().empty());
}

TEST_F(SessionDatabaseTest, KeepsAPlanUntilItIsDone) {
  const PosesToMeasure plan{{Eigen::Vector3d(0.1, -0.2, 0.3), {{{0, 1}}, {{2, -1}, {23, 1}}}},
                            {Eigen::Vector3d(0.4, 0.5, -0.0), {}, true}};
  open().setPlan({{Eigen::Vector3d::Zero(), {{{7, 1}}}}});
  open().setPlan(plan);
  EXPECT_EQ(open().plan(), plan);
  CycleReport report = database_examples::report(1, 0, kParameters);
  const CalibrationState state = database_examples::state(1, kParameters);
  open().addCycle(report, state, false, kDate);
  EXPECT_EQ(open().plan(), plan);
  open().addCycle(report, state, true, kDate);
  EXPECT_TRUE(open().plan().empty());
  open().setPlan(plan);
  open().clearSamples(kDate);
  EXPECT_TRUE(open().plan().empty());
}

TEST_F(SessionDatabaseTest, TellsOfAPlanThatIsNone) {
  open().setPlan({{Eigen::Vector3d::Zero(), {{{7, 1}}}}});
  for (const char* coils : {"", "8", "+0", "+8 coils", "+99999999999999999999"}) {
    database_examples::change(path(),
                              std::string("UPDATE planned_patterns SET coils = '") + coils + "'");
    EXPECT_THROW(open().plan(), DataError) << coils;
  }
  open().setPlan({{Eigen::Vector3d::Zero(), {}}});
  database_examples::change(path(), "UPDATE planned_poses SET joint_1 = 'east'");
  EXPECT_THROW(open().plan(), DataError);
}

TEST_F(SessionDatabaseTest, KeepsTheNewestWindowsInAFileThatDoesNotGrow) {
  constexpr unsigned kWindows = 600;
  constexpr std::uintmax_t kMost = 22'000'000;
  SessionDatabase database = open();
  for (unsigned n = 0; n < kWindows; n += 20) {
    std::vector<MotionSlice> windows;
    for (unsigned m = n; m < n + 20; ++m) {
      windows.push_back(database_examples::window(m, kCoils));
    }
    database.addMotion(windows, kDate);
  }
  const std::vector<MotionSlice> windows = database.motion();
  EXPECT_GT(windows.size(), 300U);
  EXPECT_LT(windows.size(), 450U);
  EXPECT_TRUE(isSame(windows.back(), database_examples::window(kWindows - 1, kCoils)));
  EXPECT_LT(std::filesystem::file_size(path()), kMost);
}

TEST_F(SessionDatabaseTest, MarksSamplesAndNeverUsesAnIdAgain) {
  SessionDatabase database = open();
  EXPECT_EQ(database.nextSampleId(), 1U);
  addSamples(database, 4);
  EXPECT_TRUE(database.removeSample(4, "2024-06-01T00:00:00Z"));
  EXPECT_FALSE(database.removeSample(4, kDate));
  EXPECT_FALSE(database.removeSample(9, kDate));
  EXPECT_EQ(idsInUse(database), (Ids{1, 2, 3}));
  EXPECT_EQ(database.clearSamples("2024-06-02T00:00:00Z"), 3U);
  EXPECT_EQ(database.clearSamples(kDate), 0U);
  EXPECT_TRUE(database.samplesInUse().empty());
  EXPECT_EQ(database.nextSampleId(), 5U);
  EXPECT_EQ(database_examples::query(
                path(), "SELECT id || ' ' || removal || ' ' || removal_date FROM samples"),
            "1 cleared 2024-06-02T00:00:00Z\n2 cleared 2024-06-02T00:00:00Z\n"
            "3 cleared 2024-06-02T00:00:00Z\n4 removed 2024-06-01T00:00:00Z");
}

TEST_F(SessionDatabaseTest, ANewDatabaseHoldsTheParametersAtTheStart) {
  const SessionDatabase database = open();
  const Revision revision = database.current();
  EXPECT_EQ(revision.number, 0U);
  EXPECT_EQ(revision.source, "nominal");
  EXPECT_EQ(revision.origin, "start");
  EXPECT_EQ(revision.software, "0.1.0");
  EXPECT_EQ(revision.date.size(), std::string(kDate).size());
  EXPECT_FALSE(revision.refined);
  const CalibrationSession session(identity().start, {}, {});
  EXPECT_TRUE(isSame(revision.state, session.startState()));
  EXPECT_FALSE(database.lastCycle());
  EXPECT_TRUE(database.cyclesOfRevision(0).empty());
}

TEST_F(SessionDatabaseTest, TheStartOfACalibratedDescriptionIsIdentified) {
  SessionIdentity calibrated = identity();
  calibrated.start =
      CalibrationSession(calibrated.start, {}, {}).description({kDate, {}, "0.1.0", 3});
  calibrated.start.stddevs.joints[0].offset = 1e-3;
  calibrated.start.calibration->unidentified.erase(
      calibrated.start.calibration->unidentified.begin());
  const SessionDatabase database(path(), calibrated);
  EXPECT_EQ(database.current().source, "identified");
  EXPECT_TRUE(database.current().state.identified[0]);
  EXPECT_FALSE(database.current().state.identified[1]);
  EXPECT_EQ(database.current().state.belief.covariance(0, 0), 1e-6);
}

TEST_F(SessionDatabaseTest, KeepsEveryBitOfCyclesAndRevisions) {
  const CycleReport report = database_examples::report(1, 5, kParameters);
  const CalibrationState state = database_examples::state(1, kParameters);
  {
    SessionDatabase database = open();
    addSamples(database, 5);
    const Revision revision = database.addCycle(report, state, true, kDate);
    EXPECT_EQ(revision.number, 1U);
    EXPECT_EQ(revision.origin, "coil:3");
  }
  const SessionDatabase database = open();
  const Revision revision = database.current();
  EXPECT_EQ(revision.number, 1U);
  EXPECT_EQ(revision.date, kDate);
  EXPECT_EQ(revision.software, "0.1.0");
  EXPECT_EQ(revision.source, "identified");
  EXPECT_EQ(revision.origin, "coil:3");
  EXPECT_TRUE(revision.refined);
  EXPECT_TRUE(isSame(revision.state, state));
  ASSERT_TRUE(database.lastCycle());
  EXPECT_TRUE(isSame(*database.lastCycle(), report));
  ASSERT_EQ(database.cyclesOfRevision(1).size(), 1U);
  EXPECT_TRUE(isSame(database.cyclesOfRevision(1)[0], report));
}

TEST_F(SessionDatabaseTest, NumbersThatAreNoneComeBackAsSuch) {
  SessionDatabase database = open();
  CycleReport report = database_examples::report(1, 0, 1);
  report.success = false;
  report.cycle = Cycle::kRefine;
  report.error_measure = ErrorMeasure::kStandardized;
  report.error_history.clear();
  report.reduced_chi_square = std::numeric_limits<double>::quiet_NaN();
  database.addCycle(report, kDate);
  const CycleReport stored = database.lastCycle().value();
  EXPECT_TRUE(std::isnan(stored.reduced_chi_square));
  EXPECT_TRUE(stored.error_history.empty());
  EXPECT_EQ(stored.cycle, Cycle::kRefine);
  EXPECT_EQ(stored.error_measure, ErrorMeasure::kStandardized);
}

TEST_F(SessionDatabaseTest, FailedCyclesMakeNoRevision) {
  SessionDatabase database = open();
  CycleReport report = database_examples::report(1, 0, 1);
  report.success = false;
  report.contradicted = true;
  database.addCycle(report, kDate);
  EXPECT_EQ(database.current().number, 0U);
  EXPECT_TRUE(isSame(*database.lastCycle(), report));
  ASSERT_EQ(database.cyclesOfRevision(0).size(), 1U);
  EXPECT_TRUE(isSame(database.cyclesOfRevision(0)[0], report));
}

TEST_F(SessionDatabaseTest, ACycleWithAnUnknownSampleLeavesNothingBehind) {
  SessionDatabase database = open();
  const CycleReport report = database_examples::report(1, 1, 1);
  EXPECT_THROW(database.addCycle(report, database_examples::state(1, kParameters), false, kDate),
               DataError);
  EXPECT_FALSE(database.lastCycle());
  EXPECT_EQ(database.current().number, 0U);
}

TEST_F(SessionDatabaseTest, KnowsWhichCyclesLedToARevision) {
  SessionDatabase database = open();
  const auto add_cycle = [&](unsigned seed) {
    return database
        .addCycle(database_examples::report(seed, 0, 1),
                  database_examples::state(seed, kParameters),
                  false,
                  kDate)
        .number;
  };
  // samples_rejected tells the reports apart.
  const auto cycles_of = [&](std::uint32_t number) {
    std::vector<std::uint32_t> seeds;
    for (const CycleReport& report : database.cyclesOfRevision(number)) {
      seeds.push_back(report.samples_rejected);
    }
    return seeds;
  };
  add_cycle(1);
  const std::uint32_t second = add_cycle(2);
  add_cycle(3);
  const CalibrationState start = database.revision(0)->state;
  const std::uint32_t reset = database.addRevision(start, "nominal", "reset", false, kDate).number;
  EXPECT_TRUE(cycles_of(reset).empty());
  add_cycle(4);
  const std::uint32_t restored =
      database
          .addRevision(
              database.revision(second)->state, "restored", "revision 2", false, kDate, second)
          .number;
  EXPECT_EQ(cycles_of(restored), (Ids{1, 2}));
  const std::uint32_t newest = add_cycle(5);
  EXPECT_EQ(cycles_of(newest), (Ids{1, 2, 5}));
  EXPECT_EQ(cycles_of(reset + 1), (Ids{4}));

  EXPECT_TRUE(isSame(database.revision(restored)->state, database_examples::state(2, kParameters)));
  EXPECT_FALSE(database.revision(newest + 1));
  std::vector<std::string> origins;
  for (const RevisionSummary& revision : database.revisions()) {
    origins.push_back(std::to_string(revision.number) + " " + revision.source + " " +
                      revision.origin);
  }
  EXPECT_EQ(origins,
            (std::vector<std::string>{"0 nominal start",
                                      "1 identified coil:3",
                                      "2 identified coil:3",
                                      "3 identified coil:3",
                                      "4 nominal reset",
                                      "5 identified coil:3",
                                      "6 restored revision 2",
                                      "7 identified coil:3"}));
}

TEST_F(SessionDatabaseTest, KnowsWhichCyclesFailedMeanwhile) {
  SessionDatabase database = open();
  const CalibrationState state = database_examples::state(1, kParameters);
  // samples_rejected tells the reports apart.
  const auto run = [&](unsigned seed, bool success) {
    CycleReport report = database_examples::report(seed, 0, 1);
    report.success = success;
    if (success) {
      database.addCycle(report, state, false, kDate);
    } else {
      database.addCycle(report, kDate);
    }
  };
  const auto cycles_of = [&](std::uint32_t number) {
    std::vector<std::uint32_t> seeds;
    for (const CycleReport& report : database.cyclesOfRevision(number)) {
      seeds.push_back(report.samples_rejected);
    }
    return seeds;
  };
  run(1, false);
  run(2, true);
  run(3, false);
  run(4, true);
  run(5, false);
  EXPECT_EQ(cycles_of(2), (Ids{1, 2, 3, 4, 5}));
  database.addRevision(state, "restored", "revision 1", false, kDate, 1);
  EXPECT_EQ(cycles_of(3), (Ids{1, 2})) << "what failed after revision 1 is not of its parameters";
  run(6, false);
  EXPECT_EQ(cycles_of(3), (Ids{1, 2, 6}));
  database.addRevision(state, "nominal", "reset", false, kDate);
  EXPECT_TRUE(cycles_of(4).empty());
}

TEST_F(SessionDatabaseTest, OtherProgramsReadWhileItIsOpen) {
  SessionDatabase database = open();
  addSamples(database, 2);
  EXPECT_EQ(database_examples::query(path(), "SELECT count(*) FROM sample_currents"), "48");
}

}  // namespace
}  // namespace sac
