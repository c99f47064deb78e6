#include "spherical_actuator_calibration/measurement/motion_plan.hpp"

#include <cmath>
#include <functional>

#include <gtest/gtest.h>

#include "spherical_actuator_calibration/base/error.hpp"
#include "spherical_actuator_calibration/measurement/motion_plan_file.hpp"
#include "support/error_message.hpp"
#include "support/scenarios.hpp"

namespace sac {
namespace {

constexpr double kDuration = 10.0;
constexpr double kRamp = 2.0;

MotionPlan examplePlan() {
  MotionPlan plan;
  plan.actuator = scenarios::paperNominal().name;
  plan.duration = kDuration;
  plan.ramp = kRamp;
  plan.joints[0] = {0.05, {{0.31, 0.2, 0.1}, {0.73, 0.1, 1.0 / 3.0}}};
  plan.joints[1] = {-0.05, {{0.37, 0.2, 0.7}}};
  plan.joints[2] = {0.0, {{0.06, 3.3, -1.5}, {0.5, 0.4, 2.0}}};
  plan.coils.assign(24, {{0.9, 0.2, 0.3}, {2.1, 0.1, -2.0}});
  return plan;
}

TEST(MotionTime, BeginsAndEndsAtRestAndRunsAsTimeBetween) {
  const MotionTime time(kDuration, kRamp);
  EXPECT_EQ(time.at(-1.0), 0.0);
  EXPECT_EQ(time.rateAt(0.0), 0.0);
  EXPECT_EQ(time.rateAt(5.0), 1.0);
  EXPECT_NEAR(time.at(6.0) - time.at(5.0), 1.0, 1e-12);
  EXPECT_NEAR(time.rateAt(kDuration), 0.0, 1e-12);
  EXPECT_NEAR(time.at(kDuration), kDuration - kRamp, 1e-12);
  EXPECT_EQ(time.at(20.0), time.at(kDuration));
  for (double t = 0.0; t < kDuration + 0.5; t += 0.01) {
    EXPECT_NEAR((time.at(t + 1e-5) - time.at(t - 1e-5)) / 2e-5, time.rateAt(t), 1e-4) << t;
  }
}

TEST(MotionTime, EndsWithinItsRampWheneverItIsEnded) {
  for (const double moment : {0.0, 0.7, 1.9, 5.0, 7.9}) {
    MotionTime time(kDuration, kRamp);
    const double rate = time.rateAt(moment);
    time.endAt(moment);
    EXPECT_NEAR(time.end(), moment + kRamp, 1e-12);
    EXPECT_NEAR(time.rateAt(moment + 1e-9), rate, 1e-6);
    EXPECT_NEAR(time.rateAt(time.end()), 0.0, 1e-12);
    for (double t = 0.0; t < time.end() + 0.5; t += 0.01) {
      if (std::abs(t - moment) > 1e-4) {
        EXPECT_NEAR((time.at(t + 1e-5) - time.at(t - 1e-5)) / 2e-5, time.rateAt(t), 1e-4) << t;
      }
    }
    // Once is enough.
    time.endAt(moment + 0.5 * kRamp);
    EXPECT_NEAR(time.end(), moment + kRamp, 1e-12);
  }
  MotionTime late(kDuration, kRamp);
  late.endAt(9.0);
  EXPECT_EQ(late.end(), kDuration);
}

TEST(MotionPlan, SumsOfSinesStayWithinWhatIsSaidOfThem) {
  const std::vector<Sine> sines = examplePlan().joints[2].sines;
  double largest_value = 0.0;
  double largest_rate = 0.0;
  for (double t = 0.0; t < 60.0; t += 0.01) {
    const double rate = (valueOf(sines, t + 1e-5) - valueOf(sines, t - 1e-5)) / 2e-5;
    largest_value = std::max(largest_value, std::abs(valueOf(sines, t)));
    largest_rate = std::max(largest_rate, std::abs(rate));
  }
  EXPECT_LE(largest_value, largestValueOf(sines));
  EXPECT_GT(largest_value, 0.8 * largestValueOf(sines));
  EXPECT_LE(largest_rate, largestRateOf(sines));
  EXPECT_GT(largest_rate, 0.8 * largestRateOf(sines));
}

TEST(MotionPlan, TheFileGivesBackEverything) {
  MotionPlanRecord record;
  record.software = "1.2.3";
  record.plan = examplePlan();
  record.plan.serial = "unit-001";
  record.plan.limits = {0.41, 3.9, 0.11, 2.4, 7.9, 6.1};
  record.plan.coils[7].clear();
  record.expected = {{"joint_1/offset", 1.0 / 3.0}, {"coil_24/azimuth", 2e-5}};
  const std::string text = renderMotionPlan(record);
  const MotionPlanRecord again = parseMotionPlan(text, "plan.yaml");
  EXPECT_EQ(renderMotionPlan(again), text);
  EXPECT_EQ(again.plan.joints[0].sines[1].phase, 1.0 / 3.0);
  EXPECT_EQ(again.plan.limits.error, 0.11);
  EXPECT_EQ(again.plan.coils.size(), 24U);
  EXPECT_EQ(again.expected[0].stddev, 1.0 / 3.0);
}

TEST(MotionPlan, TheFileNamesWhatIsWrongInIt) {
  const std::string text = renderMotionPlan({"1.2.3", examplePlan(), {}});
  const auto message_for = [&](const std::string& from, const std::string& to) {
    std::string changed = text;
    const std::size_t place = changed.find(from);
    EXPECT_NE(place, std::string::npos) << from;
    changed.replace(place, from.size(), to);
    return errorMessage<ConfigError>([&] { parseMotionPlan(changed, "plan.yaml"); });
  };
  EXPECT_NE(message_for("duration", "dauer").find("duration"), std::string::npos);
  EXPECT_NE(message_for("  ramp: 2.0", "  ramp: 2.0\n  speed: 1").find("speed"), std::string::npos);
  EXPECT_NE(message_for("centre: 0.05", "centre: .nan").find("joints[0].centre"),
            std::string::npos);
  EXPECT_NE(message_for("frequencies: [0.31, 0.73]", "frequencies: [0.31]").find("amplitudes"),
            std::string::npos);
  EXPECT_NE(message_for("frequencies: [0.31,", "frequencies: [-0.31,").find("frequencies"),
            std::string::npos);
}

TEST(MotionPlan, IsRefusedWhereItLeavesItsLimits) {
  const Actuator actuator = scenarios::paperNominal();
  EXPECT_NO_THROW(validate(examplePlan(), actuator));
  const auto refusal = [&](const std::function<void(MotionPlan&)>& change) {
    MotionPlan plan = examplePlan();
    change(plan);
    return errorMessage<ConfigError>([&] { validate(plan, actuator); });
  };
  const auto names = [](const std::string& message, const std::string& word) {
    return message.find(word) != std::string::npos;
  };
  EXPECT_TRUE(names(refusal([](MotionPlan& p) { p.joints[0].centre = 0.2; }), "joint 1 tilt"));
  EXPECT_TRUE(
      names(refusal([](MotionPlan& p) { p.joints[1].sines[0].amplitude = 0.41; }), "joint 2 tilt"));
  EXPECT_TRUE(
      names(refusal([](MotionPlan& p) { p.joints[2].sines[1].frequency = 5.0; }), "joint 3 rate"));
  EXPECT_TRUE(
      names(refusal([](MotionPlan& p) { p.coils[23][0].amplitude = 2.5; }), "coil 24 excitation"));
  EXPECT_TRUE(names(refusal([](MotionPlan& p) { p.limits.tilt = 0.55; }), "tilt and error"));
  EXPECT_TRUE(names(refusal([](MotionPlan& p) { p.coils.pop_back(); }), "23 coils"));
  EXPECT_TRUE(names(refusal([](MotionPlan& p) { p.actuator = "other"; }), "other"));
  EXPECT_TRUE(names(refusal([](MotionPlan& p) { p.ramp = 5.1; }), "ramp"));
  EXPECT_TRUE(names(refusal([](MotionPlan& p) { p.coils[0][0].phase = std::nan(""); }), "phase"));
}

}  // namespace
}  // namespace sac
