/// What flows against what is set, as the supervisor of currents judges it.

#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "drivers/supervised_coils.hpp"
#include "spherical_actuator_calibration/drivers/current_supervisor.hpp"

namespace sac {
namespace {

std::string faultAfter(const std::vector<Flow>& flows, const SupervisorLimits& with = limits()) {
  CurrentSupervisor supervisor(with, 2);
  double now = 10.0;
  beginAtZero(supervisor, now);
  for (const Flow& flow : flows) {
    for (int n = 0; n < flow.beats; ++n) {
      now += 0.005;
      supervisor.setting(amperes(flow.set));
      supervisor.observe(amperes(flow.measured), now, now);
    }
  }
  return supervisor.fault();
}

TEST(SupervisedCurrents, WhatFlowsAgainstWhatWasSetIsAnErrorAfterSomeBeats) {
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
TEST(SupervisedCurrents, CurrentThatComesRarelyIsAnErrorToo) {
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
TEST(SupervisedCurrents, CurrentThatComesRarelyBesideACommandedCoilIsAnErrorToo) {
  SupervisorLimits shipped = limits();
  shipped.deviating_beats = 40;
  CurrentSupervisor supervisor(shipped, 2);
  double told = 0.0;
  for (int beat = 0; beat < 1000 && told == 0.0; ++beat) {
    supervisor.setting(amperes(1.0));
    supervisor.observe(amperes(1.0, beat % 50 < 4 ? 2.0 : 0.0), 0.005 * beat, 0.005 * beat);
    told = supervisor.fault().empty() ? 0.0 : 0.005 * beat;
  }
  EXPECT_GT(told, 1.0);
  EXPECT_LT(told, 4.0);
  EXPECT_NE(supervisor.fault().find("coil 2 carries 2.00 A where 0.00 A are set"),
            std::string::npos)
      << supervisor.fault();
}

// The same where next to nothing is set; and what lags behind it is none.
TEST(SupervisedCurrents, CurrentThatComesRarelyWhereLittleIsSetIsAnErrorToo) {
  SupervisorLimits shipped = limits();
  shipped.deviating_beats = 40;
  std::vector<Flow> flows;
  for (int n = 0; n < 20; ++n) {
    flows.insert(flows.end(), {{0.001, 0.0, 36}, {0.001, 8.0, 4}});
  }
  EXPECT_NE(faultAfter(flows, shipped).find("coil 1 carries 8.00 A"), std::string::npos);
  flows.clear();
  for (int n = 0; n < 200; ++n) {
    flows.insert(flows.end(), {{0.14, -0.14, 10}, {0.14, 0.14, 90}, {-0.14, 0.14, 10}});
  }
  EXPECT_EQ(faultAfter(flows, shipped), "");
}

TEST(SupervisedCurrents, TheHeartbeatIsWithheldBeforeADeviationIsSure) {
  SupervisorLimits shipped = limits();
  shipped.deviating_beats = 40;
  CurrentSupervisor supervisor(shipped, 2);
  double time = 0.0;
  const auto beats = [&](int count, double measured) {
    for (int beat = 0; beat < count; ++beat, time += 0.005) {
      supervisor.setting(amperes(1.0));
      supervisor.observe(amperes(measured), time, time);
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

TEST(SupervisedCurrents, ADriverThatStartsGivesNoHeartbeatWhileCurrentFlows) {
  CurrentSupervisor supervisor(limits(), 2);
  EXPECT_FALSE(supervisor.mayBeat());
  supervisor.setting(amperes(0.0));
  supervisor.observe(amperes(0.0, 1.0), 0.0, 0.0);
  EXPECT_FALSE(supervisor.mayBeat());
  supervisor.observe(amperes(0.0, 0.1), 0.005, 0.005);
  EXPECT_TRUE(supervisor.mayBeat());
}

// Of a loop that is held up: each beat finds that the command has run out, or one again.
TEST(SupervisedCurrents, WhatWasSetBeforeMayStillFlowWhenItIsMeasured) {
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
  FaultOfCurrents() {
    beginAtZero(supervisor_, beat_);
    deviate();
  }

  void deviate() { observe(4, 2.0); }
  void observe(int beats, double measured) {
    for (int n = 0; n < beats; ++n) {
      supervisor_.setting(amperes(0.0));
      beat_ += 0.005;
      if (supervisor_.mayBeat()) {
        supervisor_.beating(beat_);
      }
      supervisor_.observe(amperes(0.0, measured), beat_, beat_);
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
  command(1.0);
  EXPECT_EQ((*supervisor_.command(now_))[0], 1.0);
}

TEST_F(FaultOfCurrents, EndsNoSoonerWhereCommandsMakeBeatsFaster) {
  command(0.0);
  const auto fast = [&](int beats) {
    for (int n = 0; n < beats; ++n) {
      beat_ += 0.0025;
      supervisor_.observe(amperes(0.0), beat_, beat_);
    }
    return supervisor_.fault();
  };
  EXPECT_NE(fast(5), "");
  EXPECT_EQ(fast(2), "");
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
  beginAtZero(supervisor, 9.995);
  for (const double now : {10.0, 10.1}) {
    for (int n = 0; n < 4; ++n) {
      supervisor.observe(amperes(now < 10.1 ? 2.0 : 0.0), now + 0.005 * n, now + 0.005 * n);
    }
  }
  EXPECT_NE(supervisor.fault(), "");
}

TEST_F(FaultOfCurrents, StaysTheSecondTimeWithinAMinuteAndTheThirdTime) {
  // Each ends but the last one, so long after the one before [s].
  const std::vector<std::vector<double>> cases{{0.5}, {59.0}, {61.0, 0.5}, {61.0, 61.0}};
  for (const std::vector<double>& pauses : cases) {
    CurrentSupervisor supervisor(limits(), 2);
    double now = 10.0;
    const auto observe = [&](int beats, double measured) {
      for (int n = 0; n < beats; ++n, now += 0.005) {
        supervisor.setting(amperes(0.0));
        supervisor.beating(now);
        supervisor.observe(amperes(0.0, measured), now, now);
      }
    };
    beginAtZero(supervisor, now - 0.005);
    observe(4, 2.0);
    ASSERT_NE(supervisor.fault(), "");
    for (const double pause : pauses) {
      ASSERT_EQ(supervisor.offer(given("/owner", now, 0.0), at(now)), "");
      observe(4, 0.0);
      ASSERT_EQ(supervisor.fault(), "") << pause;
      now += pause;
      observe(5, 2.0);
      ASSERT_NE(supervisor.fault(), "") << pause;
    }
    EXPECT_NE(supervisor.fault().find("start the driver anew"), std::string::npos);
    ASSERT_EQ(supervisor.offer(given("/owner", now, 0.0), at(now)), "");
    observe(100, 0.0);
    EXPECT_NE(supervisor.fault(), "") << pauses.size() << ' ' << pauses.front();
  }
}

// Setpoints that are stuck: the output stages are all that keeps their current away.
TEST_F(FaultOfCurrents, LeavesTheStagesOffUntilCurrentIsCommanded) {
  command(0.0);
  observe(4, 0.0);
  ASSERT_EQ(supervisor_.fault(), "");
  for (int n = 0; n < 3; ++n) {
    EXPECT_FALSE(isFollowed());
    EXPECT_NE(supervisor_.zeroReason(now_).find("nothing but zero was commanded"),
              std::string::npos);
    command(0.0);
  }
  command(0.3);
  EXPECT_TRUE(isFollowed());
  command(0.0);
  EXPECT_TRUE(isFollowed());
  EXPECT_EQ(supervisor_.zeroReason(now_), "");
}

// The heartbeat is withheld before the error: a watchdog of 0.25 s acts 0.15 s after it.
TEST(SupervisedCurrents, AZeroByTheWatchdogEndsNoError) {
  SupervisorLimits shipped = limits();
  shipped.deviating_beats = 40;
  CurrentSupervisor supervisor(shipped, 2);
  double now = 10.0;
  double fed = 0.0;
  const auto beats = [&](double until, double measured) {
    for (; now < until; now += 0.005) {
      if (supervisor.mayBeat()) {
        fed = now;
        supervisor.beating(now);
      }
      supervisor.setting(amperes(0.0));
      supervisor.observe(amperes(measured), now, now);
    }
  };
  beats(10.5, 0.0);
  beats(10.65, 2.0);
  EXPECT_EQ(supervisor.fault(), "");
  EXPECT_LT(fed, 10.62);
  beats(fed + 0.25, 2.0);
  EXPECT_NE(supervisor.fault(), "");
  ASSERT_EQ(supervisor.offer(given("/owner", now, 0.0), at(now)), "");
  beats(now + 5.0, 0.0);
  EXPECT_NE(supervisor.fault(), "");
}

TEST(SupervisedCurrents, ALinkThatIsLostAgainWithCurrentIsAnError) {
  CurrentSupervisor supervisor(limits(), 2);
  const auto lost = [&](double set, double now) {
    supervisor.setting(amperes(set));
    supervisor.lose(now);
    supervisor.setting(amperes(0.0));
    return supervisor.fault();
  };
  EXPECT_EQ(lost(1.0, 10.0), "");
  EXPECT_EQ(lost(0.0, 10.5), "");
  EXPECT_EQ(lost(1.0, 13.5), "");
  const std::string fault = lost(1.0, 16.0);
  EXPECT_NE(fault.find("twice within 3.00 s"), std::string::npos) << fault;
  // It is over as soon as zero is measured and commanded, however late and often.
  double now = 30.0;
  const auto measured = [&](double current) {
    for (int beat = 0; beat < 4; ++beat, now += 0.005) {
      supervisor.observe(amperes(current), now, now);
    }
    return supervisor.fault();
  };
  EXPECT_NE(measured(0.0), "");
  EXPECT_TRUE(supervisor.mayBeat());
  ASSERT_EQ(supervisor.offer(given("/owner", now, 1.0), at(now)), "");
  EXPECT_FALSE(supervisor.command(now));
  EXPECT_NE(measured(0.0), "");
  ASSERT_EQ(supervisor.offer(given("/owner", now, 0.0), at(now)), "");
  EXPECT_EQ(measured(0.0), "");
}

TEST(SupervisedCurrents, CurrentDuringAnErrorOfTheLinkIsTheGraverOne) {
  CurrentSupervisor supervisor(limits(), 2);
  for (const double now : {10.0, 11.0}) {
    supervisor.setting(amperes(1.0));
    supervisor.lose(now);
    supervisor.setting(amperes(0.0));
  }
  ASSERT_NE(supervisor.fault(), "");
  for (double now = 12.0; now < 13.0; now += 0.005) {
    supervisor.observe(amperes(2.0), now, now);
  }
  EXPECT_EQ(supervisor.faults(), 1);
  EXPECT_NE(supervisor.fault().find("carries 2.00 A"), std::string::npos) << supervisor.fault();
  EXPECT_FALSE(supervisor.mayBeat());
}

TEST(SupervisedCurrents, DuringSuchAnErrorNoCommandIsFollowed) {
  CurrentSupervisor supervisor(limits(), 2);
  beginAtZero(supervisor, 0.0);
  for (int n = 1; n < 5; ++n) {
    supervisor.observe(amperes(0.0, 2.0), 0.005 * n, 0.005 * n);
  }
  ASSERT_EQ(supervisor.offer(given("/owner", 10.0), at(10.0)), "");
  EXPECT_FALSE(supervisor.command(10.0));
  EXPECT_NE(supervisor.zeroReason(10.0).find("coil 2"), std::string::npos);
}

}  // namespace
}  // namespace sac
