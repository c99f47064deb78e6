#include "spherical_actuator_calibration/storage/live_session.hpp"

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "spherical_actuator_calibration/assessment/report_file.hpp"
#include "spherical_actuator_calibration/base/error.hpp"
#include "spherical_actuator_calibration/calibration/cycle_selection.hpp"
#include "storage/database_examples.hpp"
#include "support/error_message.hpp"
#include "support/scenarios.hpp"
#include "support/temporary_folder.hpp"

namespace sac {
namespace {

using database_examples::kDate;

class LiveSessionTest : public ::testing::Test {
 protected:
  LiveSession open() const {
    return LiveSession({scenarios::paperNominal()}, {}, folder_.path("session.db"), "0.1.0");
  }

  /// Ten orientations and thirty torques of coil 1.
  static std::vector<Sample> samples() {
    scenarios::Generator generator(3);
    std::vector<Sample> samples = scenarios::paperSession(
        scenarios::paperTruth(), scenarios::Tracker::kFirstTenPoses, generator);
    samples.resize(40);
    for (Sample& sample : samples) {
      sample.id = 0;
    }
    return samples;
  }

  static void addAll(LiveSession& session) {
    for (const Sample& sample : samples()) {
      session.addSample(sample, kDate);
    }
  }

  /// Orientations as they would be the other way round, of a later time. Returns their ids.
  static std::vector<std::uint32_t> addInverted(LiveSession& session) {
    std::vector<std::uint32_t> ids;
    for (Sample sample : samples()) {
      if (sample.has_orientation) {
        sample.R_stator_rotor.transposeInPlace();
        sample.stamp += 100'000'000'000;
        ids.push_back(session.addSample(sample, kDate).id);
      }
    }
    return ids;
  }

  TemporaryFolder folder_;
};

TEST_F(LiveSessionTest, GoesOnWhereItEnded) {
  Eigen::VectorXd x;
  {
    LiveSession session = open();
    addAll(session);
    ASSERT_TRUE(session.run({Cycle::kJoint}, kDate).success);
    ASSERT_TRUE(session.run({Cycle::kPoles, 0}, kDate).success);
    x = session.calibration().state().belief.x;
  }
  LiveSession session = open();
  EXPECT_EQ(session.revision().number, 2U);
  EXPECT_EQ(session.revision().source, "identified");
  EXPECT_EQ(session.calibration().state().belief.x, x);
  EXPECT_EQ(session.calibration().samples().size(), 40U);
  EXPECT_EQ(session.calibration().reports().size(), 2U);
  EXPECT_EQ(session.lastReport()->cycle, Cycle::kPoles);
  EXPECT_TRUE(session.progress().poles_done);
}

/// What is kept up to date against what all samples tell anew.
void expectUpToDate(const LiveSession& session, const char* after) {
  const CalibrationSession& calibration = session.calibration();
  const SessionProgress progress = session.progress();
  const SessionProgress anew = progressOf(calibration.model(),
                                          calibration.samples(),
                                          calibration.state(),
                                          calibration.config().estimation);
  const auto numbers = [](const SessionProgress& one) {
    std::vector<std::size_t> all = {one.samples,
                                    one.joint_samples,
                                    one.joint.samples,
                                    one.orientation_samples,
                                    one.validation_samples,
                                    one.next_cycles.size()};
    for (const auto& parts : {one.poles, one.coils}) {
      for (const Coverage& part : parts) {
        all.push_back(part.samples);
        all.push_back(part.identified ? 1 : 0);
      }
    }
    all.insert(all.end(), one.torque_samples.begin(), one.torque_samples.end());
    all.insert(all.end(), one.samples_per_coil.begin(), one.samples_per_coil.end());
    return all;
  };
  EXPECT_EQ(numbers(progress), numbers(anew)) << after;
  const GradedCalibration grade = gradeCalibration(calibration);
  EXPECT_EQ(session.grade().grade, grade.grade) << after;
  EXPECT_EQ(session.grade().reason, grade.reason) << after;
  EXPECT_EQ(progress.complete, anew.isAllIdentified() && calibration.isSettled()) << after;
  EXPECT_EQ(describe(session.linearity()),
            describe(torqueLinearity(calibration.samples(), calibration.config())))
      << after;
}

/// One coil at three currents in one rest.
std::vector<Sample> linearitySamples() {
  scenarios::Generator generator(4);
  std::vector<Sample> samples;
  for (const double current : {2.0, 1.0, -2.0}) {
    samples.push_back(
        scenarios::torqueSamples(
            scenarios::paperTruth(), {{0.1, 0.2, 0.3}}, 2, current, 1e-4, 1e-4, generator)
            .front());
    samples.back().dwell = 7;
    samples.back().torque_shared_stddev = 5e-5;
    samples.back().stamp = static_cast<Stamp>(samples.size());
  }
  return samples;
}

TEST_F(LiveSessionTest, ProgressAndGradeAreUpToDateAfterEachStep) {
  LiveSession session = open();
  expectUpToDate(session, "opening");
  for (const Sample& sample : samples()) {
    session.addSample(sample, kDate);
    expectUpToDate(session, "a sample");
  }
  std::uint32_t id = 0;
  for (const Sample& sample : linearitySamples()) {
    EXPECT_FALSE(session.linearity());
    id = session.addSample(sample, kDate).id;
    expectUpToDate(session, "a torque at another current");
  }
  EXPECT_TRUE(session.linearity());
  ASSERT_TRUE(session.run({Cycle::kJoint}, kDate).success);
  expectUpToDate(session, "the joint");
  ASSERT_TRUE(session.removeSample(id, kDate));
  EXPECT_FALSE(session.linearity());
  ASSERT_TRUE(session.run({Cycle::kPoles, 0}, kDate).success);
  expectUpToDate(session, "the poles");
  Sample held_out = samples().back();
  held_out.validation = true;
  held_out.stamp += 100'000'000'000;
  session.addSample(held_out, kDate);
  expectUpToDate(session, "a held-out sample");
  ASSERT_TRUE(session.removeSample(3, kDate));
  expectUpToDate(session, "a removal");
  session.reset(kDate);
  expectUpToDate(session, "reset");
  session.restore(2, kDate);
  expectUpToDate(session, "restore");
  session.clearSamples(kDate);
  expectUpToDate(session, "clearing");
}

TEST_F(LiveSessionTest, TellsOfARefusedCycleUntilItIsMended) {
  LiveSession session = open();
  addAll(session);
  EXPECT_FALSE(session.progress().refused);
  const std::vector<std::uint32_t> wrong = addInverted(session);
  ASSERT_TRUE(session.run({Cycle::kJoint}, kDate).contradicted);
  EXPECT_TRUE(session.progress().refused);
  for (const std::uint32_t id : wrong) {
    ASSERT_TRUE(session.removeSample(id, kDate));
  }
  ASSERT_TRUE(session.run({Cycle::kJoint}, kDate).success);
  EXPECT_FALSE(session.progress().refused);
}

TEST_F(LiveSessionTest, CountsWhatTheParametersRestOnAndWasRemoved) {
  LiveSession session = open();
  addAll(session);
  ASSERT_TRUE(session.run({Cycle::kRefine}, kDate).success);
  Sample held_out = samples().back();
  held_out.validation = true;
  held_out.stamp += 100'000'000'000;
  ASSERT_TRUE(session.removeSample(session.addSample(held_out, kDate).id, kDate));
  EXPECT_EQ(session.progress().removed, 0U);
  ASSERT_TRUE(session.removeSample(2, kDate));
  ASSERT_TRUE(session.removeSample(5, kDate));
  EXPECT_EQ(session.progress().removed, 2U);
  ASSERT_TRUE(session.run({Cycle::kRefine}, kDate).success);
  EXPECT_EQ(session.progress().removed, 0U);
}

std::string toldOf(const LiveSession& session) {
  return session.grade().reason + (session.progress().refused ? " refused" : "");
}

TEST_F(LiveSessionTest, TellsOfARefusedCycleAndOfDoubtsWhenItGoesOn) {
  const auto told_after = [this](const auto& act) {
    LiveSession session = open();
    act(session);
    return toldOf(session);
  };
  const std::string doubted = told_after([](LiveSession& session) {
    for (Sample sample : samples()) {
      sample.orientation_stddev *= 0.4;
      session.addSample(sample, kDate);
    }
    ASSERT_TRUE(session.run({Cycle::kJoint}, kDate).success);
  });
  ASSERT_NE(doubted.find("times their stated uncertainty"), std::string::npos) << doubted;
  EXPECT_EQ(toldOf(open()), doubted);
  const std::string refused = told_after([](LiveSession& session) {
    addInverted(session);
    ASSERT_TRUE(session.run({Cycle::kJoint}, kDate).contradicted);
  });
  ASSERT_EQ(refused.find("Do not use this calibration"), 0U) << refused;
  EXPECT_EQ(toldOf(open()), refused);
}

// A retry after an answer that was lost: another dwell of the same pose differs in its stamp.
TEST_F(LiveSessionTest, StoresTheSameCaptureOnce) {
  LiveSession session = open();
  EXPECT_EQ(session.addSample(samples()[0], kDate).id, 1U);
  EXPECT_EQ(session.addSample(samples()[0], kDate).id, 1U);
  Sample again = samples()[0];
  again.stamp += 1;
  EXPECT_EQ(session.addSample(again, kDate).id, 2U);
  EXPECT_EQ(session.database().samplesInUse().size(), 2U);
  // Taken out of use, it may be captured again.
  EXPECT_TRUE(session.removeSample(1, kDate));
  EXPECT_EQ(session.addSample(samples()[0], kDate).id, 3U);
}

// Neither one that was held out by its turn, nor one whose turn it is when it is asked for again.
TEST_F(LiveSessionTest, StoresTheSameCaptureOnceWhereEachSecondIsHeldOut) {
  CalibrationConfig config;
  config.hold_out_every = 2;
  LiveSession session({scenarios::paperNominal()}, config, folder_.path("session.db"), "0.1.0");
  for (std::size_t n = 0; n < 4; ++n) {
    for (int time = 0; time < 2; ++time) {
      const Sample stored = session.addSample(samples()[n], kDate);
      EXPECT_EQ(stored.id, n + 1);
      EXPECT_EQ(stored.validation, n % 2 == 1);
    }
  }
  EXPECT_EQ(session.database().samplesInUse().size(), 4U);
}

TEST_F(LiveSessionTest, SamplesThatAreNoneAreToldWithTheirFile) {
  {
    LiveSession session = open();
    addAll(session);
  }
  database_examples::change(folder_.path("session.db"), "UPDATE samples SET r11 = 7 WHERE id = 3");
  const std::string message = errorMessage<DataError>([this] { open(); });
  EXPECT_EQ(message, folder_.path("session.db") + ": Sample 3: orientation is not a rotation.");
}

TEST_F(LiveSessionTest, NumbersSamplesAnew) {
  LiveSession session = open();
  EXPECT_EQ(session.addSample(samples()[0], kDate).id, 1U);
  EXPECT_EQ(session.addSample(samples()[1], kDate).id, 2U);
  EXPECT_TRUE(session.removeSample(2, kDate));
  EXPECT_FALSE(session.removeSample(2, kDate));
  EXPECT_EQ(session.addSample(samples()[2], kDate).id, 3U);
  EXPECT_EQ(session.clearSamples(kDate), 2U);
  EXPECT_TRUE(session.calibration().samples().empty());
  EXPECT_EQ(session.addSample(samples()[3], kDate).id, 4U);
}

TEST_F(LiveSessionTest, ASampleThatCannotBeUsedIsNotStored) {
  LiveSession session = open();
  Sample sample = samples()[20];
  sample.current.resize(2);
  EXPECT_THROW(session.addSample(sample, kDate), DataError);
  EXPECT_TRUE(session.database().samplesInUse().empty());
}

TEST_F(LiveSessionTest, AFailedCycleIsStoredAndChangesNothing) {
  LiveSession session = open();
  addAll(session);
  EXPECT_FALSE(session.run({Cycle::kCoil, 4}, kDate).success);
  EXPECT_EQ(session.revision().number, 0U);
  EXPECT_TRUE(session.calibration().state().belief.x.isZero(0.0));
  EXPECT_EQ(session.lastReport()->cycle, Cycle::kCoil);
  EXPECT_FALSE(session.lastReport()->success);
}

// Of a motion, too, whose windows are no samples.
TEST_F(LiveSessionTest, KeepsTheReportOfEveryCycle) {
  LiveSession session = open();
  addAll(session);
  for (const CycleRequest& request : {CycleRequest{Cycle::kJoint},
                                      CycleRequest{Cycle::kPoles, 0},
                                      CycleRequest{Cycle::kCoil, 4},
                                      CycleRequest{Cycle::kRefine},
                                      CycleRequest{Cycle::kMotion}}) {
    const CycleReport report = session.run(request, kDate);
    ASSERT_TRUE(session.lastReport()) << cycleText(request);
    EXPECT_EQ(cycleText({session.lastReport()->cycle, session.lastReport()->coil}),
              cycleText(request));
    EXPECT_EQ(session.lastReport()->message, report.message);
  }
}

TEST_F(LiveSessionTest, ResetAndRestoreAreRevisionsThemselves) {
  LiveSession session = open();
  addAll(session);
  session.run({Cycle::kJoint}, kDate);
  const Eigen::VectorXd identified = session.calibration().state().belief.x;
  session.reset(kDate);
  EXPECT_EQ(session.revision().number, 2U);
  EXPECT_EQ(session.revision().source, "nominal");
  EXPECT_TRUE(session.calibration().state().belief.x.isZero(0.0));
  EXPECT_FALSE(session.progress().joint_done);
  session.restore(1, kDate);
  EXPECT_EQ(session.revision().number, 3U);
  EXPECT_EQ(session.revision().source, "restored");
  EXPECT_EQ(session.calibration().state().belief.x, identified);
  EXPECT_TRUE(session.progress().joint_done);
  ASSERT_EQ(session.calibration().reports().size(), 1U);
  const std::string message = errorMessage<DataError>([&] { session.restore(17, kDate); });
  EXPECT_NE(message.find("no revision 17"), std::string::npos) << message;
  EXPECT_EQ(session.revision().number, 3U);
}

TEST_F(LiveSessionTest, OnlyARefinementCountsAsRefined) {
  LiveSession session = open();
  addAll(session);
  session.run({Cycle::kJoint}, kDate);
  session.run({Cycle::kPoles, 0}, kDate);
  EXPECT_FALSE(session.progress().refined);
  ASSERT_TRUE(session.run({Cycle::kRefine}, kDate).success);
  EXPECT_TRUE(session.progress().refined);
  session.run({Cycle::kJoint}, kDate);
  EXPECT_FALSE(session.progress().refined);
}

// Of what was never asked for nothing is open, and nothing is known.
TEST_F(LiveSessionTest, IsCompleteOnceAllIsIdentifiedAndNothingContradicts) {
  LiveSession session = open();
  EXPECT_FALSE(session.progress().complete);
  scenarios::Generator generator(3);
  for (Sample sample : scenarios::paperSession(
           scenarios::paperTruth(), scenarios::Tracker::kFirstTenPoses, generator)) {
    sample.id = 0;
    session.addSample(sample, kDate);
  }
  ASSERT_TRUE(session.run({Cycle::kJoint}, kDate).success);
  EXPECT_FALSE(session.progress().complete);
  ASSERT_TRUE(session.run({Cycle::kRefine}, kDate).success);
  EXPECT_TRUE(session.progress().complete);
  // Nothing has moved: that takes nothing away, and no further pose would mend it.
  ASSERT_FALSE(session.run({Cycle::kMotion}, kDate).success);
  EXPECT_TRUE(session.progress().complete);
  addInverted(session);
  ASSERT_TRUE(session.run({Cycle::kJoint}, kDate).contradicted);
  EXPECT_FALSE(session.progress().complete);
}

TEST_F(LiveSessionTest, DescriptionCarriesItsRevision) {
  LiveSession session = open();
  addAll(session);
  session.run({Cycle::kJoint}, kDate);
  const CalibratedDescription description = session.description(kDate);
  EXPECT_EQ(description.calibration->revision, 1U);
  EXPECT_EQ(description.calibration->software, "0.1.0");
  EXPECT_EQ(description.calibration->cycles.size(), 1U);
  EXPECT_NE(description.actuator.joints[0].offset, 0.0);
}

TEST_F(LiveSessionTest, ReportIsOfTheRevisionInForceAndTheSamplesInUse) {
  const auto holds = [](const LiveSession& session, const std::string& part) {
    return renderReport(session.calibration(), session.origin(kDate), {}).find(part) !=
           std::string::npos;
  };
  {
    LiveSession session = open();
    addAll(session);
    session.run({Cycle::kJoint}, kDate);
    EXPECT_TRUE(holds(session, "  revision: 1\n"));
    EXPECT_TRUE(holds(session, "    - {id: 40, joint_position"));
    session.removeSample(40, kDate);
    EXPECT_FALSE(holds(session, "    - {id: 40, joint_position"));
  }
  LiveSession session = open();
  EXPECT_TRUE(holds(session, "    - cycle: joint\n"));
  session.clearSamples(kDate);
  EXPECT_TRUE(holds(session, "  samples: []\n"));
  EXPECT_TRUE(holds(session, "  influences: []\n"));
}

}  // namespace
}  // namespace sac
