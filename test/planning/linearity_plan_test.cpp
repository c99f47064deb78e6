#include "spherical_actuator_calibration/planning/linearity_plan.hpp"

#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "planning/current_threshold.hpp"

namespace sac {
namespace {

constexpr double kFull = 2.0;  // [A]
constexpr Stamp kLinearityRest = 100;

Eigen::Vector3d linearityPlace() {
  return {0.1, 0.0, 0.0};
}

/// Coils 3 and 5 in turn.
PoseToMeasure singlyExcited() {
  return {linearityPlace(), {{{2, 1}}, {{4, 1}}}, false};
}

Sample excitedSample(const CoilPattern& pattern,
                     double torque,
                     double current = kFull,
                     Stamp rest = kLinearityRest,
                     const Eigen::Vector3d& where = linearityPlace()) {
  Sample sample;
  sample.joint_position = where;
  sample.dwell = rest;
  sample.current = Eigen::VectorXd::Zero(6);
  for (const SignedCoil& coil : pattern) {
    // What is measured is not quite what was commanded.
    sample.current[static_cast<Eigen::Index>(coil.coil)] = 1.03 * coil.sign * current;
  }
  sample.has_torque = true;
  sample.torque.x() = torque;
  return sample;
}

std::vector<Sample> measuredSingly() {
  return {excitedSample({}, 0.0), excitedSample({{2, 1}}, 0.2), excitedSample({{4, 1}}, 0.4)};
}

/// What is missing, in words.
std::vector<std::string> missingInWords(const std::vector<Sample>& held,
                                        const PoseToMeasure& pose) {
  std::vector<std::string> texts;
  for (const PlannedCapture& capture : linearityPlan(held, pose, kFull, kThreshold).missing) {
    texts.push_back(patternText(capture.pattern) + " at " + std::to_string(capture.current));
  }
  return texts;
}

using CaptureTexts = std::vector<std::string>;

TEST(LinearityPlan, IsOfTheCoilThatMakesMostTorque) {
  EXPECT_EQ(linearityPlan(measuredSingly(), singlyExcited(), kFull, kThreshold).captures, 2U);
  EXPECT_EQ(missingInWords(measuredSingly(), singlyExcited()),
            (CaptureTexts{"+5 at 1.000000", "-5 at 2.000000"}));
}

TEST(LinearityPlan, LacksNothingWhereTheLastRestHasAllThree) {
  std::vector<Sample> held = measuredSingly();
  held.push_back(excitedSample({{4, 1}}, 0.2, 0.5 * kFull));
  held.push_back(excitedSample({{4, -1}}, 0.39));
  EXPECT_TRUE(missingInWords(held, singlyExcited()).empty());
  // A new rest has to have all of them.
  held.push_back(excitedSample({}, 0.0, kFull, kLinearityRest + 1));
  EXPECT_EQ(missingInWords(held, singlyExcited()),
            (CaptureTexts{"+5 at 2.000000", "+5 at 1.000000", "-5 at 2.000000"}));
}

TEST(LinearityPlan, MeasuresOneCoilAloneWherePatternsAreOfSeveral) {
  const PoseToMeasure pose = {linearityPlace(), {{{2, 1}, {4, -1}}, {{3, 1}, {5, 1}}}, false};
  const std::vector<Sample> held = {excitedSample({}, 0.0),
                                    excitedSample({{2, 1}, {4, -1}}, 0.2),
                                    excitedSample({{3, 1}, {5, 1}}, 0.3)};
  EXPECT_EQ(linearityPlan(held, pose, kFull, kThreshold).captures, 3U);
  EXPECT_EQ(missingInWords(held, pose),
            (CaptureTexts{"+4 at 2.000000", "+4 at 1.000000", "-4 at 2.000000"}));
  // One that is alone goes before several that make more.
  std::vector<Sample> with_one = held;
  with_one.push_back(excitedSample({{0, -1}}, 0.1));
  EXPECT_EQ(missingInWords(with_one, pose), (CaptureTexts{"+1 at 2.000000", "+1 at 1.000000"}));
}

TEST(LinearityPlan, IsNotDoneWhereItCannotBe) {
  const auto captures = [](const PoseToMeasure& pose, double current) {
    return linearityPlan(measuredSingly(), pose, current, kThreshold).captures;
  };
  EXPECT_EQ(captures({linearityPlace(), {}, false}, kFull), 0U);
  EXPECT_EQ(captures({linearityPlace(), singlyExcited().patterns, true}, kFull), 0U);
  EXPECT_EQ(captures(singlyExcited(), 3.5 * kThreshold), 0U);  // half of it is as good as none
  EXPECT_EQ(captures(singlyExcited(), 3.7 * kThreshold), 2U);
}

TEST(LinearityPlan, HeedsNoSampleElsewhereAndNoneThatJudges) {
  Sample elsewhere =
      excitedSample({{0, 1}}, 0.9, kFull, kLinearityRest, Eigen::Vector3d(0.3, 0.0, 0.0));
  Sample judging = excitedSample({{1, 1}}, 0.9);
  judging.validation = true;
  std::vector<Sample> held = measuredSingly();
  Sample without_currents;  // of the joint alone, in the same rest
  without_currents.joint_position = linearityPlace();
  without_currents.dwell = kLinearityRest;
  held.insert(held.begin(), {elsewhere, judging, without_currents});
  EXPECT_EQ(missingInWords(held, singlyExcited()),
            (CaptureTexts{"+5 at 1.000000", "-5 at 2.000000"}));
  EXPECT_TRUE(missingInWords({elsewhere, judging}, singlyExcited()).empty());
}

}  // namespace
}  // namespace sac
