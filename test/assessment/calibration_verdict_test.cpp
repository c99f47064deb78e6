#include "calibration_verdict.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "spherical_actuator_calibration/base/rotations.hpp"
#include "support/scenarios.hpp"

namespace sac {
namespace {

CalibrationSession sessionWith(const std::vector<Sample>& samples,
                               const std::vector<CycleRequest>& requests) {
  CalibrationConfig config;
  stateRegistration(config, {0.0, 0.0, 0.0});
  CalibrationSession session({scenarios::paperNominal()}, samples, config);
  for (const CycleRequest& request : requests) {
    session.run(request);
  }
  return session;
}

std::string stepsOf(const CalibrationVerdict& verdict) {
  std::string text;
  for (const std::string& step : verdict.next_steps) {
    text += step;
    text += "\n";
  }
  return text;
}

CalibrationVerdict verdictOf(const CalibrationSession& session) {
  return judgeCalibration(session, {}, {});
}

TEST(CalibrationVerdict, NothingWorksWithoutASuccessfulCycle) {
  EXPECT_EQ(verdictOf(sessionWith({}, {})).graded.grade, Grade::kFailed);
  const CalibrationVerdict verdict = verdictOf(sessionWith({}, {{Cycle::kJoint}}));
  EXPECT_EQ(verdict.graded.grade, Grade::kFailed);
  EXPECT_NE(stepsOf(verdict).find("capture at least 3 poses"), std::string::npos)
      << stepsOf(verdict);
}

TEST(CalibrationVerdict, GoodWhenAllIsIdentifiedAndHeldOutSamplesAgree) {
  const std::vector<Sample> samples = scenarios::heldOutSession();
  const CalibrationVerdict verdict =
      verdictOf(sessionWith(samples, {{Cycle::kJoint}, {Cycle::kRefine}}));
  EXPECT_EQ(verdict.graded.grade, Grade::kGood);
  EXPECT_NE(verdict.graded.reason.find("held-out samples agree"), std::string::npos)
      << verdict.graded.reason;
  EXPECT_NE(verdict.graded.reason.find("orientation 0."), std::string::npos)
      << verdict.graded.reason;
  ASSERT_EQ(verdict.next_steps.size(), 1U) << stepsOf(verdict);
  EXPECT_EQ(verdict.next_steps[0].find("Nothing needs to be done."), 0U);
}

TEST(CalibrationVerdict, HeldOutSamplesCanContradict) {
  std::vector<Sample> samples = scenarios::heldOutSession();
  for (Sample& sample : samples) {
    if (sample.validation) {
      sample.R_stator_rotor = rotationExp({0.01, 0.0, 0.0}) * sample.R_stator_rotor;
    }
  }
  const CalibrationVerdict verdict =
      verdictOf(sessionWith(samples, {{Cycle::kJoint}, {Cycle::kRefine}}));
  EXPECT_EQ(verdict.graded.grade, Grade::kContradicted);
  EXPECT_EQ(verdict.graded.reason.find("Do not use this calibration yet"), 0U);
  EXPECT_EQ(verdict.next_steps[0].find("Find out why what was held out differs"), 0U);
}

TEST(CalibrationVerdict, SaysWhichPoseWouldShowAPoleThatNoSampleSees) {
  scenarios::Generator generator(2);
  std::vector<Sample> samples = scenarios::heldOutSession();
  std::vector<Eigen::Vector3d> poses;
  for (int n = 0; n < 40; ++n) {
    const Eigen::Vector3d pose = scenarios::randomPose(0.2, generator);
    if (scenarios::polesSeen(scenarios::paperTruth(), 0, {pose})[4] == false) {
      poses.push_back(pose);
    }
  }
  samples.resize(10);
  for (Sample sample :
       scenarios::torqueSamples(scenarios::paperTruth(), poses, 0, 2.0, 5e-4, 3e-4, generator)) {
    sample.id = static_cast<std::uint32_t>(samples.size() + 1);
    samples.push_back(sample);
  }
  const CalibrationVerdict verdict =
      verdictOf(sessionWith(samples, {{Cycle::kJoint}, {Cycle::kPoles, 0}}));
  // Only orientations are held out: nothing judges the poles.
  EXPECT_EQ(verdict.graded.grade, Grade::kNotValidated);
  EXPECT_NE(verdict.graded.reason.find("2 that were asked for are not"), std::string::npos)
      << verdict.graded.reason;
  EXPECT_NE(stepsOf(verdict).find("Pole 5 is seen by no sample: excite coil 1"), std::string::npos)
      << stepsOf(verdict);
}

TEST(CalibrationVerdict, AsksForWhatWasNotTried) {
  std::vector<Sample> samples = scenarios::heldOutSession();
  for (Sample& sample : samples) {
    sample.validation = false;
  }
  const CalibrationVerdict verdict = verdictOf(sessionWith(samples, {{Cycle::kJoint}}));
  EXPECT_EQ(verdict.graded.grade, Grade::kNotValidated);
  EXPECT_NE(verdict.graded.reason.find("9 of 73 parameters"), std::string::npos)
      << verdict.graded.reason;
  EXPECT_NE(stepsOf(verdict).find("Call calibrate_poles with coil 1"), std::string::npos)
      << stepsOf(verdict);
}

TEST(CalibrationVerdict, NamesRejectedAndIrreplaceableSamples) {
  std::vector<Sample> samples = scenarios::heldOutSession();
  samples[20].R_stator_rotor = rotationExp({0.1, 0.0, 0.0}) * samples[20].R_stator_rotor;
  const CalibrationSession session = sessionWith(samples, {{Cycle::kJoint}, {Cycle::kRefine}});
  SampleInfluence influence;
  influence.id = 12;
  influence.irreplaceable = true;
  const std::string steps = stepsOf(judgeCalibration(session, {influence}, {}));
  EXPECT_NE(steps.find("rejected samples (21)"), std::string::npos) << steps;
  EXPECT_NE(steps.find("Sample 12 is checked by no other: an error in it would show"),
            std::string::npos)
      << steps;
}

TEST(CalibrationVerdict, PrefersTheEffectsThatExplainBest) {
  ModelFit all;
  all.effects = "all";
  all.converged = true;
  all.bic = 110.0;
  ModelFit fewer = all;
  fewer.effects = "without torque_bias";
  fewer.bic = 100.0;
  const CalibrationSession session = sessionWith(scenarios::heldOutSession(), {{Cycle::kJoint}});
  EXPECT_NE(stepsOf(judgeCalibration(session, {}, {all, fewer})).find("\"without torque_bias\""),
            std::string::npos);
  EXPECT_EQ(stepsOf(judgeCalibration(session, {}, {all})).find("effects"), std::string::npos);
}

}  // namespace
}  // namespace sac
