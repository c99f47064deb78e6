#include "spherical_actuator_calibration/calibration/session_guidance.hpp"

#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "spherical_actuator_calibration/calibration/calibration_session.hpp"
#include "support/scenarios.hpp"

namespace sac {
namespace {

SessionProgress progressOf(const CalibrationSession& session) {
  return progressOf(
      session.model(), session.samples(), session.state(), session.config().estimation);
}

std::string nextStep(const CalibrationSession& session, const SessionProgress& progress) {
  return nextStep(session.model(), progress);
}

std::string nextStep(const CalibrationSession& session) {
  return nextStep(session, progressOf(session));
}

CalibrationSession paperSession() {
  scenarios::Generator generator(1);
  const Actuator truth = scenarios::paperTruth();
  return {{scenarios::paperNominal()},
          scenarios::paperSession(truth, scenarios::Tracker::kFirstTenPoses, generator),
          {}};
}

TEST(SessionGuidance, LeadsThroughTheWholeCalibration) {
  CalibrationSession session = paperSession();
  EXPECT_EQ(nextStep(session), "Call calibrate_joint: 10 samples have an orientation.");
  ASSERT_TRUE(session.run({Cycle::kJoint}).success);
  EXPECT_EQ(nextStep(session),
            "Call calibrate_poles with coil 1: 30 samples have a torque of this coil alone.");
  ASSERT_TRUE(session.run({Cycle::kPoles, 0}).success);
  for (std::size_t coil = 1; coil < 24; ++coil) {
    EXPECT_EQ(nextStep(session),
              "Call calibrate_coil with coil " + std::to_string(coil + 1) +
                  ": 4 samples have a torque of this coil alone.");
    const CycleReport report = session.run({Cycle::kCoil, coil});
    ASSERT_TRUE(report.success) << report.message;
  }
  EXPECT_EQ(nextStep(session).substr(0, 12), "Call refine:");
  SessionProgress progress = progressOf(session);
  progress.refined = true;
  EXPECT_NE(nextStep(session, progress).find("validation"), std::string::npos);
  progress.validation_samples = 3;
  progress.judged = true;
  progress.good = true;
  EXPECT_EQ(nextStep(session, progress), "Call save: what was held out agrees.");
  progress.saved = true;
  EXPECT_NE(nextStep(session, progress).find("Nothing is left to do"), std::string::npos);
  progress.validation_samples = 0;
  progress.judged = false;
  EXPECT_NE(nextStep(session, progress).find("nothing judges it"), std::string::npos);
}

TEST(SessionGuidance, OnlyWhatIsGoodIsDone) {
  CalibrationSession session = paperSession();
  for (const CycleRequest& request : progressOf(session).next_cycles) {
    ASSERT_TRUE(session.run(request).success);
  }
  SessionProgress progress = progressOf(session);
  progress.refined = true;
  progress.validation_samples = 1;
  for (const bool saved : {false, true}) {
    progress.saved = saved;
    progress.judged = false;
    EXPECT_NE(nextStep(session, progress).find("do not judge"), std::string::npos);
    progress.judged = true;
    EXPECT_NE(nextStep(session, progress).find("not good for"), std::string::npos);
    EXPECT_EQ(nextStep(session, progress).find("Nothing is left"), std::string::npos);
  }
}

TEST(SessionGuidance, ParametersThatRestOnRemovedSamplesAreNotDone) {
  CalibrationSession session = paperSession();
  ASSERT_TRUE(session.run({Cycle::kJoint}).success);
  ASSERT_TRUE(session.run({Cycle::kRefine}).success);
  SessionProgress progress = progressOf(session);
  progress.refined = progress.judged = progress.good = progress.saved = true;
  progress.removed = 1;
  EXPECT_EQ(nextStep(session, progress),
            "Call refine: 1 sample that the parameters rest on was removed.");
  progress.removed = 2;
  progress.next_cycles.clear();
  EXPECT_EQ(nextStep(session, progress),
            "Capture at new poses, then call refine: 2 samples that the parameters rest on were "
            "removed.");
}

TEST(SessionGuidance, WhatIsContradictedIsNeverDone) {
  CalibrationSession session = paperSession();
  for (const CycleRequest& request : progressOf(session).next_cycles) {
    ASSERT_TRUE(session.run(request).success);
  }
  SessionProgress progress = progressOf(session);
  progress.refined = true;
  progress.contradicted = true;
  for (const bool saved : {false, true}) {
    progress.saved = saved;
    EXPECT_EQ(nextStep(session, progress).rfind("Do not use the parameters", 0), 0U);
  }
}

// A calibrated unit that has drifted, as two poses and their held-out ones have shown: a refinement
// by them alone would identify less than is in force.
TEST(SessionGuidance, WhatIsContradictedIsNotRefinedByTheFewSamplesThatTellSo) {
  CalibrationSession session = paperSession();
  for (const CycleRequest& request : progressOf(session).next_cycles) {
    ASSERT_TRUE(session.run(request).success);
  }
  const std::vector<Sample> few(session.samples().begin(), session.samples().begin() + 3);
  SessionProgress progress =
      progressOf(session.model(), few, session.state(), session.config().estimation);
  ASSERT_TRUE(progress.isAllIdentified());
  progress.contradicted = true;
  const std::string step = nextStep(session, progress);
  EXPECT_EQ(step.rfind("Do not use the parameters", 0), 0U) << step;
  EXPECT_EQ(step.find("Call refine"), std::string::npos) << step;
}

TEST(SessionGuidance, ARefusedCycleIsNotToBeRepeatedAsItIs) {
  CalibrationSession session = paperSession();
  SessionProgress progress = progressOf(session);
  const std::string before = nextStep(session, progress);
  progress.refused = true;
  EXPECT_NE(nextStep(session, progress).find("was refused"), std::string::npos);
  progress.samples = 0;
  progress.refused = false;
  const std::string without = nextStep(session, progress);
  EXPECT_EQ(before, without);
  progress.refused = true;
  EXPECT_EQ(nextStep(session, progress), without);
}

TEST(SessionGuidance, WithoutSamplesWhatWasSavedStays) {
  const CalibrationSession session({scenarios::paperNominal()}, {}, {});
  SessionProgress progress = progressOf(session);
  progress.saved = true;
  EXPECT_NE(nextStep(session, progress).find("no sample is in use"), std::string::npos);
  progress.saved = false;
  EXPECT_EQ(nextStep(session, progress).rfind("Move the rotor", 0), 0U);
}

TEST(SessionGuidance, WithoutSamplesThereIsNothingToRefine) {
  CalibrationSession session = paperSession();
  ASSERT_TRUE(session.run({Cycle::kRefine}).success);
  SessionProgress progress = progressOf(session);
  // As after a motion.
  progress.samples = 0;
  progress.joint_samples = 0;
  progress.refined = false;
  progress.judged = true;
  progress.good = true;
  ASSERT_TRUE(progress.isAllIdentified());
  EXPECT_EQ(nextStep(session, progress), "Call save: what was held out agrees.");
}

TEST(SessionGuidance, APlanGoesFirst) {
  const CalibrationSession session = paperSession();
  SessionProgress progress = progressOf(session);
  progress.plan_step = "Go on with the plan.";
  EXPECT_EQ(nextStep(session, progress), "Go on with the plan.");
  progress.contradicted = true;
  EXPECT_EQ(nextStep(session, progress),
            "Do not use the parameters in force, which are contradicted. Go on with the plan.");
}

TEST(SessionGuidance, SamplesOfAPlanAreRefinedAtOnce) {
  scenarios::Generator generator(1);
  std::vector<Sample> samples = scenarios::paperSession(
      scenarios::paperTruth(), scenarios::Tracker::kFirstTenPoses, generator);
  // 12 torques of coil 1 alone, where its own cycle wants 24, and all those of the other coils.
  samples.erase(samples.begin() + 22, samples.begin() + 40);
  CalibrationSession session({scenarios::paperNominal()}, samples, {});
  ASSERT_TRUE(session.run({Cycle::kJoint}).success);
  EXPECT_EQ(nextStep(session).substr(0, 12), "Call refine:") << nextStep(session);
}

TEST(SessionGuidance, CountsWhatIsMissing) {
  CalibrationSession session({scenarios::paperNominal()}, {}, {});
  EXPECT_NE(nextStep(session).find("0 of 10 are held"), std::string::npos);
  scenarios::Generator generator(1);
  const Actuator truth = scenarios::paperTruth();
  std::vector<Sample> samples =
      scenarios::paperSession(truth, scenarios::Tracker::kFirstTenPoses, generator);
  samples.resize(22);
  session = CalibrationSession({scenarios::paperNominal()}, samples, {});
  session.run({Cycle::kJoint});
  EXPECT_NE(nextStep(session).find("Excite coil 1 alone"), std::string::npos);
  EXPECT_NE(nextStep(session).find("12 of 24 are held"), std::string::npos);
}

TEST(SessionGuidance, OnePoseTellsNothingMoreHoweverOftenItIsMeasured) {
  Sample sample;
  sample.has_orientation = true;
  const CalibrationSession session(
      {scenarios::paperNominal()}, std::vector<Sample>(12, sample), {});
  const SessionProgress progress = progressOf(session);
  EXPECT_EQ(progress.joint.samples, 3U);
  EXPECT_FALSE(progress.joint.isSeenWell());
  EXPECT_EQ(progress.orientation_samples, 12U);
  EXPECT_TRUE(progress.next_cycles.empty());
  EXPECT_NE(nextStep(session).find("3 of 10 are held"), std::string::npos) << nextStep(session);
}

TEST(SessionGuidance, HeldOutSamplesDoNotServeACycle) {
  scenarios::Generator generator(1);
  const Actuator truth = scenarios::paperTruth();
  std::vector<Sample> samples =
      scenarios::paperSession(truth, scenarios::Tracker::kFirstTenPoses, generator);
  samples[0].validation = true;
  const CalibrationSession session({scenarios::paperNominal()}, samples, {});
  EXPECT_NE(nextStep(session).find("9 of 10 are held"), std::string::npos);
  EXPECT_EQ(progressOf(session).validation_samples, 1U);
  EXPECT_EQ(progressOf(session).orientation_samples, 10U);
}

TEST(SessionGuidance, CountsTorquesPerCoil) {
  const SessionProgress progress = progressOf(paperSession());
  ASSERT_EQ(progress.torque_samples.size(), 24U);
  EXPECT_EQ(progress.torque_samples[0], 30U);
  EXPECT_EQ(progress.torque_samples[23], 4U);
  EXPECT_FALSE(progress.joint_done);
  EXPECT_FALSE(progress.poles_done);
  EXPECT_FALSE(progress.coil_done[0]);
}

TEST(SessionGuidance, TellsHowWellEachPoleAndCoilIsSeen) {
  CalibrationSession session = paperSession();
  const SessionProgress before = progressOf(session);
  EXPECT_EQ(before.joint.samples, 10U);
  EXPECT_TRUE(before.joint.isSeenWell());
  EXPECT_FALSE(before.joint.identified);
  ASSERT_EQ(before.poles.size(), 8U);
  ASSERT_EQ(before.coils.size(), 24U);
  EXPECT_EQ(before.coils[0].samples, 30U);
  EXPECT_TRUE(before.coils[23].isSeenWell());
  session.run({Cycle::kJoint});
  session.run({Cycle::kPoles, 0});
  const SessionProgress after = progressOf(session);
  EXPECT_TRUE(after.joint.identified);
  EXPECT_TRUE(after.poles[4].identified);
  EXPECT_EQ(after.torque_samples[0], 30U);
  EXPECT_TRUE(after.coils[0].identified);
  EXPECT_FALSE(after.coils[1].identified);
}

TEST(SessionGuidance, HeldOutSamplesCoverNothing) {
  scenarios::Generator generator(1);
  std::vector<Sample> samples = scenarios::paperSession(
      scenarios::paperTruth(), scenarios::Tracker::kFirstTenPoses, generator);
  for (Sample& sample : samples) {
    sample.validation = true;
  }
  const SessionProgress progress =
      progressOf(CalibrationSession({scenarios::paperNominal()}, samples, {}));
  EXPECT_EQ(progress.joint.samples, 0U);
  EXPECT_EQ(progress.poles[0].samples, 0U);
  EXPECT_FALSE(progress.coils[0].isSeenWell());
  EXPECT_TRUE(progress.next_cycles.empty());
}

TEST(SessionGuidance, AJointAloneIsDoneAfterItsCycle) {
  Actuator joint_only = scenarios::paperNominal();
  joint_only.poles.clear();
  joint_only.coils.clear();
  joint_only.torque_curve.reset();
  scenarios::Generator generator(2);
  const std::vector<Sample> samples = scenarios::orientationSamples(
      joint_only, scenarios::randomPoses(12, 0.3, generator), 1e-3, 1e-3, generator);
  CalibrationSession session({joint_only}, samples, {});
  EXPECT_EQ(nextStep(session), "Call calibrate_joint: 12 samples have an orientation.");
  ASSERT_TRUE(session.run({Cycle::kJoint}).success);
  EXPECT_NE(nextStep(session).find("validate"), std::string::npos);
}

}  // namespace
}  // namespace sac
