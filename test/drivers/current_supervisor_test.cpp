#include "spherical_actuator_calibration/drivers/current_supervisor.hpp"

#include <limits>
#include <optional>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "spherical_actuator_calibration/base/error.hpp"
#include "support/error_message.hpp"

namespace sac {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kWall = 1.7e9;             // [s] wall clock when the steady clock shows 0
constexpr double kSimulated = 978307200.0;  // [s] 2001, as a simulator or a recording may say

const SupervisorLimits& limits() {
  static const SupervisorLimits values{0.25, 0.1, 0.15, 4, 0.005};
  return values;
}

Eigen::VectorXd amperes(double first, double second = 0.0) {
  return Eigen::Vector2d(first, second);
}

/// A moment by two clocks that agree.
Instant at(double steady) {
  return {steady, kWall + steady};
}

/// Given by `caller` at a time of the steady clock.
CoilCommand given(const std::string& caller, double steady, double current = 1.0) {
  return {caller, kWall + steady, amperes(current)};
}

/// One command to a supervisor that follows /owner since 10 s.
struct Case {
  const char* what;
  CoilCommand command;
  Instant now;
  const char* refusal;  ///< part of the sentence; nullptr: it is accepted
};

std::vector<Case> cases() {
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
  for (const Case& one : cases()) {
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

/// What is set and measured in the first coil [A].
struct Flow {
  double set = 0.0;
  double measured = 0.0;
  int beats = 1;
};

std::string faultAfter(const std::vector<Flow>& flows, const SupervisorLimits& with = limits()) {
  CurrentSupervisor supervisor(with, 2);
  double now = 10.0;
  for (const Flow& flow : flows) {
    for (int n = 0; n < flow.beats; ++n) {
      now += 0.005;
      supervisor.setting(amperes(flow.set));
      supervisor.observe(amperes(flow.measured), now);
    }
  }
  return supervisor.fault();
}

TEST(CurrentSupervisor, WhatFlowsAgainstWhatWasSetIsAnErrorAfterSomeBeats) {
  EXPECT_EQ(faultAfter({{1.0, 1.1, 100}}), "");
  EXPECT_EQ(faultAfter({{0.0, 2.0, 3}}), "");
  // A zero between them takes nothing back that counts.
  EXPECT_NE(faultAfter({{0.0, 2.0, 3}, {0.0, 0.0}, {0.0, 2.0, 3}}), "");
  EXPECT_EQ(faultAfter({{0.0, 2.0, 3}, {0.0, 0.0, 24}, {0.0, 2.0, 3}}), "");
  for (const Flow& flow : {Flow{0.0, 2.0, 4}, Flow{1.0, 0.0, 40}, Flow{1.0, -1.0, 4}}) {
    EXPECT_NE(faultAfter({flow}), "") << flow.set << ' ' << flow.measured;
  }
  const std::string fault = faultAfter({{0.0, 2.0, 4}, {0.0, 0.0, 100}});
  EXPECT_NE(fault.find("coil 1 carries 2.00 A where 0.00 A are set"), std::string::npos) << fault;
  EXPECT_NE(fault.find("Switch it off"), std::string::npos) << fault;
}

// 0.15 s of 1.5 s: less than what agreeing beats take back of the comparison's count.
TEST(CurrentSupervisor, CurrentThatComesRarelyIsAnErrorToo) {
  SupervisorLimits shipped = limits();
  shipped.deviating_beats = 40;
  std::vector<Flow> flows{{0.0, 0.0, 270}, {0.0, 2.0, 30}};
  EXPECT_EQ(faultAfter(flows, shipped), "");
  flows.insert(flows.end(), {{0.0, 0.0, 270}, {0.0, 2.0, 30}});
  EXPECT_NE(faultAfter(flows, shipped), "");
  // An honest amplifier's lag is none, however often.
  flows.clear();
  for (int n = 0; n < 100; ++n) {
    flows.insert(flows.end(), {{2.0, 0.0, 20}, {0.0, 0.0, 13}, {0.0, 2.0, 20}, {0.0, 0.0, 100}});
  }
  EXPECT_EQ(faultAfter(flows, shipped), "");
}

// In 2 s 0.16 s of 2 A, in a coil that nobody commands, while another one has its current.
TEST(CurrentSupervisor, CurrentThatComesRarelyBesideACommandedCoilIsAnErrorToo) {
  SupervisorLimits shipped = limits();
  shipped.deviating_beats = 40;
  CurrentSupervisor supervisor(shipped, 2);
  double told = 0.0;
  for (int beat = 0; beat < 1000 && told == 0.0; ++beat) {
    supervisor.setting(amperes(1.0));
    supervisor.observe(amperes(1.0, beat % 50 < 4 ? 2.0 : 0.0), 0.005 * beat);
    told = supervisor.fault().empty() ? 0.0 : 0.005 * beat;
  }
  EXPECT_GT(told, 1.0);
  EXPECT_LT(told, 4.0);
  EXPECT_NE(supervisor.fault().find("coil 2 carries 2.00 A where 0.00 A are set"),
            std::string::npos)
      << supervisor.fault();
}

TEST(CurrentSupervisor, TheHeartbeatIsWithheldBeforeADeviationIsSure) {
  SupervisorLimits shipped = limits();
  shipped.deviating_beats = 40;
  CurrentSupervisor supervisor(shipped, 2);
  double time = 0.0;
  const auto beats = [&](int count, double measured) {
    for (int beat = 0; beat < count; ++beat, time += 0.005) {
      supervisor.setting(amperes(1.0));
      supervisor.observe(amperes(measured), time);
    }
  };
  beats(100, 1.0);
  EXPECT_TRUE(supervisor.mayBeat());
  // Half of what is an error; no lag explains it, as nothing else was set before.
  beats(21, 3.0);
  EXPECT_FALSE(supervisor.mayBeat());
  EXPECT_EQ(supervisor.fault(), "");
  beats(200, 1.0);
  EXPECT_TRUE(supervisor.mayBeat());
}

TEST(CurrentSupervisor, ADriverThatStartsGivesNoHeartbeatWhileCurrentFlows) {
  CurrentSupervisor supervisor(limits(), 2);
  EXPECT_FALSE(supervisor.mayBeat());
  supervisor.setting(amperes(0.0));
  supervisor.observe(amperes(0.0, 1.0), 0.0);
  EXPECT_FALSE(supervisor.mayBeat());
  supervisor.observe(amperes(0.0, 0.1), 0.005);
  EXPECT_TRUE(supervisor.mayBeat());
}

// Of a loop that is held up: each beat finds that the command has run out, or one again.
TEST(CurrentSupervisor, WhatWasSetBeforeMayStillFlowWhenItIsMeasured) {
  std::vector<Flow> late;
  for (int n = 0; n < 20; ++n) {
    late.push_back({2.0, 0.0});
    late.push_back({0.0, 2.0});
  }
  EXPECT_EQ(faultAfter(late), "");
  // On the way from one to the other.
  EXPECT_EQ(faultAfter({{0.0, 0.0}, {2.0, 1.0}, {0.0, 1.0}, {2.0, 1.0}, {0.0, 1.0}, {2.0, 1.0}}),
            "");
  // Beyond both, and what was set once does not excuse what flows for long.
  EXPECT_NE(faultAfter({{2.0, 0.0}, {0.0, 2.3}, {2.0, -0.3}, {0.0, 2.3}, {2.0, 2.3}}), "");
  EXPECT_NE(faultAfter({{2.0, 2.0}, {0.0, 2.0, 40}}), "");
}

/// A supervisor in a fault, by a current in the second coil.
class FaultOfCurrents : public ::testing::Test {
 protected:
  FaultOfCurrents() { deviate(); }

  void deviate() { observe(4, 2.0); }
  void observe(int beats, double measured) {
    for (int n = 0; n < beats; ++n) {
      supervisor_.setting(amperes(0.0));
      beat_ += 0.005;
      supervisor_.observe(amperes(0.0, measured), beat_);
    }
  }
  /// What follows happens a moment later.
  void command(double current) {
    now_ += 0.1;
    ASSERT_EQ(supervisor_.offer(given("/owner", now_, current), at(now_)), "");
  }
  bool isFollowed() const { return supervisor_.command(now_).has_value(); }

  CurrentSupervisor supervisor_{limits(), 2};
  double now_ = 10.0;
  double beat_ = 10.0;
};

TEST_F(FaultOfCurrents, EndsWhenZeroWasMeasuredForAsLongAndIsCommanded) {
  ASSERT_NE(supervisor_.fault(), "");
  observe(3, 0.0);
  command(0.0);
  EXPECT_FALSE(isFollowed());
  observe(1, 0.1);
  EXPECT_EQ(supervisor_.fault(), "");
  EXPECT_EQ(supervisor_.faults(), 1);
  EXPECT_TRUE(isFollowed());
  command(1.0);
  EXPECT_EQ((*supervisor_.command(now_))[0], 1.0);
}

TEST_F(FaultOfCurrents, StaysWhileAnythingButZeroIsCommanded) {
  observe(100, 0.0);
  EXPECT_NE(supervisor_.fault(), "") << "nothing was commanded";
  command(1.0);
  observe(100, 0.0);
  EXPECT_NE(supervisor_.fault(), "") << "the commander goes on blindly";
  command(0.0);
  command(1.0);
  observe(100, 0.0);
  EXPECT_NE(supervisor_.fault(), "") << "it wants current again";
  EXPECT_FALSE(isFollowed());
  command(0.0);
  observe(1, 0.0);
  EXPECT_EQ(supervisor_.fault(), "");
}

TEST_F(FaultOfCurrents, StaysWhileMoreThanZeroIsMeasured) {
  command(0.0);
  for (int n = 0; n < 5; ++n) {
    observe(3, 0.0);
    observe(1, 0.2);
    EXPECT_NE(supervisor_.fault(), "");
  }
  observe(4, 0.0);
  EXPECT_EQ(supervisor_.fault(), "");
}

// Its own watchdog made it zero, as the heartbeat was withheld: with the next heartbeat the current
// that it does not let go of would be back.
TEST_F(FaultOfCurrents, StaysWhereTheAmplifierDidNotObeyByItself) {
  command(0.0);
  observe(50, 2.0);
  observe(1000, 0.0);
  EXPECT_NE(supervisor_.fault(), "");
  EXPECT_FALSE(isFollowed());
}

TEST_F(FaultOfCurrents, AZeroOfBeforeDoesNotCount) {
  CurrentSupervisor supervisor(limits(), 2);
  ASSERT_EQ(supervisor.offer(given("/owner", 10.0, 0.0), at(10.0)), "");
  for (const double now : {10.0, 10.1}) {
    for (int n = 0; n < 4; ++n) {
      supervisor.observe(amperes(now < 10.1 ? 2.0 : 0.0), now + 0.005 * n);
    }
  }
  EXPECT_NE(supervisor.fault(), "");
}

TEST_F(FaultOfCurrents, StaysTheThirdTime) {
  for (int fault = 1; fault < 3; ++fault) {
    EXPECT_EQ(supervisor_.faults(), fault);
    command(0.0);
    observe(4, 0.0);
    ASSERT_EQ(supervisor_.fault(), "");
    deviate();
  }
  EXPECT_NE(supervisor_.fault().find("start the driver anew"), std::string::npos);
  command(0.0);
  observe(100, 0.0);
  EXPECT_NE(supervisor_.fault(), "");
}

TEST(CurrentSupervisor, DuringSuchAnErrorNoCommandIsFollowed) {
  CurrentSupervisor supervisor(limits(), 2);
  for (int n = 0; n < 4; ++n) {
    supervisor.observe(amperes(0.0, 2.0), 0.005 * n);
  }
  ASSERT_EQ(supervisor.offer(given("/owner", 10.0), at(10.0)), "");
  EXPECT_FALSE(supervisor.command(10.0));
  EXPECT_NE(supervisor.zeroReason(10.0).find("coil 2"), std::string::npos);
}

/// What is set and measured for some beats, of so many seconds each, and whether it confirms zero.
struct Ending {
  const char* what;
  std::vector<Flow> flows;
  bool confirms;
  double beat = 0.005;
};

TEST(CurrentSupervisor, ZeroIsConfirmedOnlyByMeasurementsInARowAfterwards) {
  const std::vector<Ending> endings{
      {"nothing was measured", {}, false},
      {"one zero", {{0.0, 0.0}}, false},
      {"zeros for 0.29 s", {{0.0, 0.0, 59}}, false},
      {"zeros for 0.31 s", {{0.0, 0.01, 63}}, true},
      {"two zeros far from each other", {{0.0, 0.0, 2}}, false, 0.4},
      {"five of a fast loop", {{0.0, 0.0, 5}}, false, 0.001},
      {"many of a fast loop", {{0.0, 0.0, 302}}, true, 0.001},
      {"another current is set", {{0.0, 0.0, 70}, {1.0, 0.0, 70}}, false},
      {"and zero again", {{1.0, 0.0, 70}, {0.0, 0.0, 40}}, false},
      {"a pulse still under way", {{2.0, 0.0, 30}, {0.0, 0.0, 30}, {0.0, 2.0, 30}}, false},
      {"a current shows once", {{0.0, 0.0, 70}, {0.0, -0.2}, {0.0, 0.0, 40}}, false},
      {"and then no more", {{0.0, 0.0, 70}, {0.0, -0.2}, {0.0, 0.0, 63}}, true},
      {"each second one is zero", {{0.0, 2.0}, {0.0, 0.0}, {0.0, 2.0}, {0.0, 0.0}}, false},
  };
  for (const Ending& ending : endings) {
    CurrentSupervisor supervisor(limits(), 2);
    double now = 10.0;
    for (const Flow& flow : ending.flows) {
      for (int n = 0; n < flow.beats; ++n) {
        now += ending.beat;
        supervisor.setting(amperes(flow.set));
        supervisor.observe(amperes(0.0, flow.measured), now);
      }
    }
    EXPECT_EQ(supervisor.isZeroConfirmed(), ending.confirms) << ending.what;
    EXPECT_EQ(supervisor.unconfirmedReason().empty(), ending.confirms) << ending.what;
  }
}

TEST(CurrentSupervisor, TellsTheCurrentThatKeepsZeroFromBeingConfirmed) {
  CurrentSupervisor supervisor(limits(), 2);
  EXPECT_NE(supervisor.unconfirmedReason(), "");
  supervisor.observe(amperes(0.0, -0.2), 10.0);
  EXPECT_NE(supervisor.unconfirmedReason().find("0.20 A"), std::string::npos);
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
