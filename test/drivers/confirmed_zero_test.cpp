/// When zero is known to be measured, as the supervisor of currents judges it.

#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "drivers/supervised_coils.hpp"
#include "spherical_actuator_calibration/drivers/current_supervisor.hpp"

namespace sac {
namespace {

/// What is set in the first coil and measured in the second one for some beats, of so many seconds
/// each, and whether it confirms zero.
struct Ending {
  const char* what;
  std::vector<Flow> flows;
  bool confirms;
  double beat = 0.005;
};

TEST(ConfirmedZero, NeedsMeasurementsInARowAfterwards) {
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
        supervisor.observe(amperes(0.0, flow.measured), now, now);
      }
    }
    EXPECT_EQ(supervisor.isZeroConfirmed(), ending.confirms) << ending.what;
    EXPECT_EQ(supervisor.unconfirmedReason().empty(), ending.confirms) << ending.what;
  }
}

// No honest amplifier lags so much; the heartbeat has not kept it, so that its watchdog may have.
TEST(ConfirmedZero, IsNoLateOneForADriverThatEnds) {
  for (const bool ends : {false, true}) {
    for (const double flows : {0.27, 0.3}) {
      CurrentSupervisor supervisor(limits(), 2);
      beginAtZero(supervisor, 10.0);
      supervisor.setting(amperes(2.0));
      supervisor.observe(amperes(2.0), 10.005, 10.005);
      supervisor.setting(amperes(0.0));
      if (ends) {
        supervisor.close();
      }
      for (double time = 0.0; time < 1.0; time += 0.005) {
        supervisor.observe(amperes(time < flows ? 2.0 : 0.0), 11.0 + time, 11.0 + time);
      }
      const bool is_late = ends && flows > 0.28;
      EXPECT_EQ(supervisor.isZeroConfirmed(), !is_late) << flows;
      const std::string reason = supervisor.unconfirmedReason();
      EXPECT_EQ(reason.find("flowed on") != std::string::npos, is_late) << reason;
    }
  }
}

TEST(ConfirmedZero, OneMeasurementThatStraysAtTheEndIsNoise) {
  CurrentSupervisor supervisor(limits(), 2);
  beginAtZero(supervisor, 10.0);
  supervisor.close();
  for (int beat = 0; beat < 200; ++beat) {
    const double time = 11.0 + 0.005 * beat;
    supervisor.observe(amperes(beat == 20 ? 0.2 : 0.0), time, time);
  }
  EXPECT_TRUE(supervisor.isZeroConfirmed()) << supervisor.unconfirmedReason();
}

TEST(ConfirmedZero, TellsTheCurrentThatKeepsItFromBeingConfirmed) {
  CurrentSupervisor supervisor(limits(), 2);
  EXPECT_NE(supervisor.unconfirmedReason(), "");
  supervisor.observe(amperes(0.0, -0.2), 10.0, 10.0);
  EXPECT_NE(supervisor.unconfirmedReason().find("0.20 A"), std::string::npos);
}

}  // namespace
}  // namespace sac
