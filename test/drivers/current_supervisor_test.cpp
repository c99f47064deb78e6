#include "spherical_actuator_calibration/drivers/current_supervisor.hpp"

#include <limits>
#include <optional>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "drivers/supervised_coils.hpp"
#include "spherical_actuator_calibration/base/error.hpp"
#include "support/error_message.hpp"

namespace sac {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kSimulated = 978307200.0;  // [s] 2001, as a simulator or a recording may say

/// One command to a supervisor that follows /owner since 10 s.
struct OfferedCommand {
  const char* what;
  CoilCommand command;
  Instant now;
  const char* refusal;  ///< part of the sentence; nullptr: it is accepted
};

std::vector<OfferedCommand> offeredCommands() {
  const double inf = std::numeric_limits<double>::infinity();
  return {
      {"the next one", given("/owner", 10.05), at(10.05), nullptr},
      {"late, but not too late", given("/owner", 10.05), at(10.29), nullptr},
      {"a little ahead", given("/owner", 10.14), at(10.05), nullptr},
      {"after a silence", given("/owner", 60.0), at(60.0), nullptr},
      {"another one after a silence", given("/other", 60.0), at(60.0), nullptr},
      {"another one at once", given("/other", 10.05), at(10.05), "/owner commands the coils"},
      {"another one, just in time", given("/other", 10.24), at(10.24), "/other does not count"},
      {"without a stamp", {"/owner", std::nullopt, amperes(1.0)}, at(10.05), "has no stamp"},
      {"old", given("/owner", 10.05), at(10.4), "0.35 s old"},
      {"of yesterday", given("/owner", 10.05 - 86400.0), at(10.05), "86400.00 s old"},
      {"of a simulator", {"/owner", kSimulated, amperes(1.0)}, at(10.05), "simulated"},
      {"of the future", given("/owner", 10.3), at(10.05), "0.25 s ahead of the wall clock"},
      {"of the year 2106", {"/owner", 4.29e9, amperes(1.0)}, at(10.05), "ahead of the wall clock"},
      {"of no number", {"/owner", kNan, amperes(1.0)}, at(10.05), "old"},
      {"the same again", given("/owner", 10.0), at(10.05), "not newer"},
      {"before the last", given("/owner", 9.95), at(10.05), "not newer"},
      {"of three coils", {"/owner", kWall + 10.05, Eigen::Vector3d::Zero()}, at(10.05), "2 coils"},
      {"of no coils", {"/owner", kWall + 10.05, {}}, at(10.05), "0 currents"},
      {"of nobody", given("", 10.05), at(10.05), "without the name of its sender"},
      {"of nobody after a silence", given("", 60.0), at(60.0), "without the name of its sender"},
      {"NaN", given("/owner", 10.05, kNan), at(10.05), "coil 1 is not finite"},
      {"infinite", given("/owner", 10.05, -inf), at(10.05), "not finite. It came from /owner"},
  };
}

TEST(CurrentSupervisor, AcceptsWhatCountsAndRefusesTheRestByName) {
  for (const OfferedCommand& one : offeredCommands()) {
    CurrentSupervisor supervisor(limits(), 2);
    ASSERT_EQ(supervisor.offer(given("/owner", 10.0, 0.5), at(10.0)), "");
    const std::string refusal = supervisor.offer(one.command, one.now);
    const auto followed = supervisor.command(one.now.steady);
    if (one.refusal == nullptr) {
      EXPECT_EQ(refusal, "") << one.what;
      ASSERT_TRUE(followed) << one.what;
      EXPECT_EQ((*followed)[0], 1.0) << one.what;
      EXPECT_EQ(supervisor.owner(one.now.steady), one.command.caller) << one.what;
      continue;
    }
    EXPECT_NE(refusal.find(one.refusal), std::string::npos) << one.what << ": " << refusal;
    // The one before holds, and ends when it would have ended.
    EXPECT_EQ((*supervisor.command(10.24))[0], 0.5) << one.what;
    EXPECT_FALSE(supervisor.command(10.26)) << one.what;
    EXPECT_EQ(supervisor.zeroReason(10.26), "no fresh command") << one.what;
  }
}

TEST(CurrentSupervisor, ACommandHoldsFromItsStampOnHoweverLateItComes) {
  CurrentSupervisor supervisor(limits(), 2);
  ASSERT_EQ(supervisor.offer(given("/owner", 10.0), at(10.2)), "");
  EXPECT_TRUE(supervisor.command(10.24));
  EXPECT_FALSE(supervisor.command(10.26));
  // A stamp ahead of time gives no time beyond the watchdog's.
  ASSERT_EQ(supervisor.offer(given("/owner", 20.09), at(20.0)), "");
  EXPECT_TRUE(supervisor.command(20.24));
  EXPECT_FALSE(supervisor.command(20.26));
}

TEST(CurrentSupervisor, TheWallClockMayBeSetAndTheDeadmanDoesNotMind) {
  for (const double jump : {-3600.0, 3600.0}) {
    CurrentSupervisor supervisor(limits(), 2);
    ASSERT_EQ(supervisor.offer(given("/owner", 10.0), at(10.0)), "");
    // The commander's clock jumped, too: it is followed.
    const Instant later{10.1, kWall + 10.1 + jump};
    EXPECT_EQ(supervisor.offer({"/owner", later.wall, amperes(1.0)}, later), "") << jump;
    EXPECT_TRUE(supervisor.command(10.34)) << jump;
    EXPECT_FALSE(supervisor.command(10.36)) << jump;
    // It did not jump: what it says is of another time.
    EXPECT_NE(supervisor.offer(given("/owner", 10.2), {10.2, later.wall + 0.1}), "") << jump;
  }
}

TEST(CurrentSupervisor, OnlyTheOwnerCommandsUntilItWasSilent) {
  CurrentSupervisor supervisor(limits(), 2);
  double now = 10.0;
  for (; now < 13.0; now += 0.02) {
    EXPECT_EQ(supervisor.offer(given("/owner", now, 1.0), at(now)), "");
    EXPECT_NE(supervisor.offer(given("/other", now + 0.01, -1.0), at(now + 0.01)), "");
    EXPECT_EQ((*supervisor.command(now + 0.015))[0], 1.0);
  }
  double taken_over = 0.0;
  const double last = now - 0.02;
  EXPECT_EQ(supervisor.offer(given("/patient", last + 0.3), at(last + 0.3)), "");
  now = last + 0.4;
  for (; taken_over == 0.0 && now < 20.0; now += 0.01) {
    taken_over = supervisor.offer(given("/other", now, -1.0), at(now)).empty() ? now : 0.0;
  }
  EXPECT_NEAR(taken_over - last, 5.3, 0.02);
  EXPECT_NE(supervisor.offer(given("/owner", taken_over + 0.01), at(taken_over + 0.01)), "");
}

TEST(CurrentSupervisor, TwoOfOneNameAreToldApart) {
  const int links[2] = {};
  const auto from = [&](int which, double time, double current) {
    CoilCommand command = given("/owner", time, current);
    command.connection = &links[which];
    return command;
  };
  CurrentSupervisor supervisor(limits(), 2);
  double now = 10.0;
  std::string refusal;
  for (; now < 13.0; now += 0.02) {
    EXPECT_EQ(supervisor.offer(from(0, now, 1.0), at(now)), "");
    refusal = supervisor.offer(from(1, now + 0.01, -1.0), at(now + 0.01));
    EXPECT_NE(refusal.find("another /owner commands the coils"), std::string::npos) << refusal;
    EXPECT_EQ((*supervisor.command(now + 0.015))[0], 1.0);
  }
  // Its connection was lost, and it came back by a new one.
  const double last = now - 0.02;
  for (; !refusal.empty() && now < 20.0; now += 0.01) {
    refusal = supervisor.offer(from(1, now, 1.0), at(now));
  }
  EXPECT_NEAR(now - last, 0.25, 0.03);
}

// Behind a flood of another one its commands come, but too late to count.
TEST(CurrentSupervisor, AnOwnerWhoIsLateKeepsTheCoilsFromOthers) {
  CurrentSupervisor supervisor(limits(), 2);
  ASSERT_EQ(supervisor.offer(given("/owner", 10.0, 1.0), at(10.0)), "");
  double now = 10.01;
  for (; now < 13.0; now += 0.01) {
    EXPECT_NE(supervisor.offer(given("/owner", now - 0.3), at(now)), "");
    EXPECT_NE(supervisor.offer(given("/other", now, -1.0), at(now)), "");
  }
  EXPECT_FALSE(supervisor.command(now));
  EXPECT_EQ(supervisor.offer(given("/owner", now), at(now)), "");
}

TEST(CurrentSupervisor, ForgetsAndCloses) {
  CurrentSupervisor supervisor(limits(), 2);
  EXPECT_EQ(supervisor.zeroReason(10.0), "no command has come");
  ASSERT_EQ(supervisor.offer(given("/owner", 10.0), at(10.0)), "");
  supervisor.forget();
  EXPECT_FALSE(supervisor.command(10.01));
  EXPECT_EQ(supervisor.zeroReason(10.01), "no command has come");
  // A lost link hands the coils to nobody.
  EXPECT_NE(supervisor.offer(given("/other", 10.02), at(10.02)), "");
  ASSERT_EQ(supervisor.offer(given("/owner", 10.03), at(10.03)), "");
  EXPECT_TRUE(supervisor.command(10.03));
  supervisor.close();
  EXPECT_FALSE(supervisor.command(10.03));
  EXPECT_NE(supervisor.offer(given("/owner", 10.04), at(10.04)), "");
}

TEST(CurrentSupervisor, RefusesLimitsOutOfRangeByName) {
  const auto message = [](const SupervisorLimits& wrong) {
    return errorMessage<ConfigError>([&] { CurrentSupervisor(wrong, 2); });
  };
  EXPECT_NE(message({10.0, 0.1, 0.15, 4}).find("watchdog"), std::string::npos);
  EXPECT_NE(message({0.25, -1.0, 0.15, 4}).find("clock_skew"), std::string::npos);
  EXPECT_NE(message({0.25, 0.1, 0.0, 4}).find("deviation.tolerance"), std::string::npos);
  EXPECT_NE(message({0.25, 0.1, 0.15, 0}).find("deviation.beats"), std::string::npos);
}

}  // namespace
}  // namespace sac
