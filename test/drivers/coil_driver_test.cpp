#include "spherical_actuator_calibration/drivers/coil_driver.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "drivers/coil_driver_case.hpp"

namespace sac {
namespace {

TEST_F(CoilDriverTest, FollowsACommandAndMeasures) {
  bus_.set(kUnit, RegisterTable::kInput, 3, {1490});
  follow(pattern(3, 1.5));
  EXPECT_NEAR(setpoint(3), 1.5, 1e-12);
  EXPECT_TRUE(enabled());
  follow(pattern(3, 0.0));
  EXPECT_TRUE(allZero());
  EXPECT_TRUE(enabled());  // a commanded zero is a command
  const CoilDriver::Beat measured = beat();
  ASSERT_TRUE(measured.measured);
  EXPECT_NEAR((*measured.measured)[3], 1.49, 1e-12);
}

TEST_F(CoilDriverTest, BeginsWithZero) {
  EXPECT_EQ(beat().zero_reason, "no command has come");
  ASSERT_FALSE(bus_.writes().empty());
  EXPECT_EQ(bus_.writes()[0].address, 100);
  EXPECT_EQ(bus_.writes()[0].words[0], 0);
  EXPECT_TRUE(allZero());
}

TEST_F(CoilDriverTest, GoesToZeroWithoutAFreshCommand) {
  follow(pattern(3, 1.5));
  now_ += 0.2;
  EXPECT_EQ(beat().zero_reason, "");
  now_ += 0.1;
  const CoilDriver::Beat silent = beat();
  EXPECT_EQ(silent.zero_reason, "no fresh command");
  EXPECT_FALSE(silent.fault);
  EXPECT_TRUE(allZero());
  EXPECT_FALSE(enabled());
}

// Its setpoints stay until the next beat writes others: they must not outlive the command by one.
TEST_F(CoilDriverTest, SlowAnswersDoNotAddToTheTimeOfACommand) {
  follow(pattern(3, 1.5));
  now_ += shippedOptions().supervision.watchdog - 0.04;
  EXPECT_EQ(beat().zero_reason, "");
  bus_.setSlow(0, 0.06);
  EXPECT_EQ(beat().zero_reason, "");
  EXPECT_EQ(beat().zero_reason, "no fresh command");
  EXPECT_TRUE(allZero());
}

TEST_F(CoilDriverTest, ARefusedCommandLetsTheOneBeforeRunOut) {
  follow(pattern(3, 1.5));
  EXPECT_NE(offer(Eigen::VectorXd::Zero(3)), "");
  EXPECT_NE(offer(pattern(3, std::nan(""))), "");
  EXPECT_NEAR(setpoint(3), 1.5, 1e-12);
  now_ += 0.26;
  beat();
  EXPECT_TRUE(allZero());
}

TEST_F(CoilDriverTest, StaysWithinTheLimitsWhateverIsCommanded) {
  follow(Eigen::VectorXd::Constant(kCoils, 50.0));
  double sum = 0.0;
  for (int coil = 0; coil < static_cast<int>(kCoils); ++coil) {
    sum += std::abs(setpoint(coil));
    EXPECT_LE(std::abs(setpoint(coil)), 2.5);
  }
  EXPECT_LE(sum, 8.0 + 0.5e-3 * kCoils);
}

TEST_F(CoilDriverTest, TellsALostLinkOnceThoughItIsTriedAgain) {
  follow(pattern(3, 1.5));
  bus_.setReachable(false);
  beat();  // told by the request that failed; from now on by the attempts to open it
  now_ += 0.2;
  const std::string reason = beat().zero_reason;
  EXPECT_EQ(reason.rfind("the link is lost: ", 0), 0U) << reason;
  for (int n = 0; n < 100; ++n) {
    now_ += 0.05;
    EXPECT_EQ(beat().zero_reason, reason);
  }
}

TEST_F(CoilDriverTest, ALostLinkMeansZeroFirstAndAFreshCommandAfterwards) {
  follow(pattern(3, 1.5));
  bus_.setReachable(false);
  EXPECT_NE(beat().zero_reason, "");
  EXPECT_FALSE(driver_.link().isUp());
  // Commands go on during the loss; one from then must not act when the link is back.
  now_ += 0.005;
  EXPECT_EQ(offer(pattern(3, 1.5)), "");
  bus_.setReachable(true);
  const std::size_t before = bus_.writes().size();
  now_ += 5.0;
  beat();
  ASSERT_GT(bus_.writes().size(), before);
  EXPECT_EQ(bus_.writes()[before].address, 100);
  EXPECT_EQ(bus_.writes()[before].words[0], 0);
  EXPECT_TRUE(allZero());
  EXPECT_EQ(driver_.link().reconnects(), 1U);
  follow(pattern(3, 1.0));
  EXPECT_NEAR(setpoint(3), 1.0, 1e-12);
}

TEST_F(CoilDriverTest, DoesNotBesiegeALostDevice) {
  beat();
  bus_.setReachable(false);
  beat();
  const std::uint64_t failures = driver_.link().failures();
  for (int n = 0; n < 10; ++n) {
    beat();
  }
  EXPECT_LE(driver_.link().failures(), failures + 1);
}

TEST_F(CoilDriverTest, EveryKindOfFailureEndsInZero) {
  for (const TransportFailure failure : {TransportFailure::kTimeout,
                                         TransportFailure::kGarbled,
                                         TransportFailure::kRefused,
                                         TransportFailure::kUnreachable}) {
    // Of the trip register, of the setpoints, of the heartbeat, of the measured currents.
    for (int request = 0; request < 4; ++request) {
      now_ += 5.0;
      follow(pattern(3, 1.5));
      bus_.failNext(std::nullopt, request);
      bus_.failNext(failure);
      EXPECT_NE(beat().zero_reason, "") << request;
      EXPECT_TRUE(allZero()) << request;
      EXPECT_FALSE(enabled()) << request;
      now_ += 5.0;
      EXPECT_EQ(beat().zero_reason, "no command has come");
    }
  }
}

TEST_F(CoilDriverTest, SetsZeroByANewLinkWhereTheOldOneDied) {
  follow(pattern(3, 1.5));
  bus_.failNext(TransportFailure::kTimeout);
  bus_.failNext(std::nullopt);
  bus_.failNext(TransportFailure::kUnreachable);
  EXPECT_NE(beat().zero_reason, "");
  EXPECT_TRUE(allZero() && !enabled());
}

TEST_F(CoilDriverTest, ATripMeansZeroUntilAFreshCommandAfterIt) {
  follow(pattern(3, 1.5));
  bus_.set(kUnit, RegisterTable::kInput, 100, {1});
  const CoilDriver::Beat tripped = beat();
  EXPECT_EQ(tripped.zero_reason, "the amplifier has tripped");
  EXPECT_TRUE(tripped.fault);
  EXPECT_TRUE(allZero());
  EXPECT_FALSE(enabled());
  bus_.set(kUnit, RegisterTable::kInput, 100, {0});
  EXPECT_EQ(beat().zero_reason, "no command has come");
  EXPECT_TRUE(allZero());
}

TEST_F(CoilDriverTest, StopsForGood) {
  follow(pattern(3, 1.5));
  EXPECT_EQ(stop(), "");
  EXPECT_TRUE(allZero());
  EXPECT_FALSE(enabled());
  now_ += 0.005;
  EXPECT_NE(offer(pattern(3, 1.5)), "");
  beat();
  EXPECT_TRUE(allZero());
}

TEST_F(CoilDriverTest, HasNotStoppedBeforeZeroIsMeasured) {
  follow(pattern(3, 1.5));
  measures(3, 1.2);
  for (int n = 0; n < 20; ++n, now_ += 0.005) {
    const std::string reason = driver_.stop(now_);
    EXPECT_NE(reason.find("1.20 A"), std::string::npos) << reason;
  }
  EXPECT_FALSE(driver_.supervisor().isZeroConfirmed());
  measures(3, 0.0);
  EXPECT_EQ(stop(), "");
  EXPECT_TRUE(driver_.supervisor().isZeroConfirmed());
}

TEST_F(CoilDriverTest, TriesBothWaysToZeroWhenItStops) {
  // The switch of the output stages is not answered, the setpoints are: by a link of their own.
  follow(pattern(3, 1.5));
  bus_.failNext(TransportFailure::kTimeout);
  EXPECT_NE(driver_.stop(now_), "");
  EXPECT_TRUE(allZero());
  EXPECT_EQ(stop(), "");
  EXPECT_TRUE(driver_.supervisor().isZeroConfirmed());
}

TEST_F(CoilDriverTest, DoesNotTakeALostLinkForZero) {
  follow(pattern(3, 1.5));
  bus_.setReachable(false);
  EXPECT_NE(stop(), "");
  EXPECT_FALSE(driver_.supervisor().isZeroConfirmed());
}

TEST_F(CoilDriverTest, KnowsThatItWasZeroBeforeTheLinkWasLost) {
  follow(pattern(3, 1.5));
  now_ += 0.3;
  for (int n = 0; n < 65; ++n) {
    beat();
  }
  bus_.setReachable(false);
  EXPECT_NE(stop(), "");
  EXPECT_TRUE(driver_.supervisor().isZeroConfirmed());
}

TEST_F(CoilDriverTest, AllRequestsOfABeatHaveOneSpanOfTime) {
  beat();
  const int before = bus_.spans();
  beat();
  EXPECT_EQ(bus_.spans(), before + 1);
  EXPECT_EQ(bus_.span(), 0.1);
}

TEST_F(CoilDriverTest, AnAmplifierThatDoesNotApplyIsToldAndItsHeartbeatWithheld) {
  follow(pattern(3, 1.5));
  follow(pattern(3, 1.5));
  measures(3, 2.0);
  int beats = 0;
  CoilDriver::Beat result;
  while (!result.fault && beats < 100) {
    now_ += 0.005;
    offer(pattern(3, 1.5));
    result = driver_.beat(now_);
    ++beats;
  }
  // 40 beats beyond the tolerance, and one that acts on it.
  EXPECT_LE(beats, 41);
  EXPECT_NE(result.zero_reason.find("coil 4 carries 2.00 A where 1.50 A are set"),
            std::string::npos)
      << result.zero_reason;
  EXPECT_TRUE(allZero());
  EXPECT_FALSE(enabled());
  const std::uint16_t heartbeat = bus_.at(kUnit, RegisterTable::kHolding, 101);
  measures(3, 0.0);
  for (int n = 0; n < 100; ++n) {
    now_ += 0.005;
    offer(pattern(3, 1.5));
    EXPECT_TRUE(driver_.beat(now_).fault);
  }
  EXPECT_EQ(bus_.at(kUnit, RegisterTable::kHolding, 101), heartbeat);
  EXPECT_TRUE(allZero());
  // Zero is measured; once it is commanded, too, all is as before.
  now_ += 0.005;
  ASSERT_EQ(offer(pattern(3, 0.0)), "");
  beat();
  EXPECT_FALSE(beat().fault);
  EXPECT_NE(bus_.at(kUnit, RegisterTable::kHolding, 101), heartbeat);
  follow(pattern(3, 1.5));
  EXPECT_NEAR(setpoint(3), 1.5, 1e-12);
}

// Whatever is commanded: an amplifier that cannot tell its currents gets none, and no heartbeat.
TEST_F(CoilDriverTest, SetsNothingThatCannotBeMeasured) {
  CurrentAmplifierOptions options = shippedOptions();
  options.currents.type = RegisterType::kFloat32;
  CoilDriver driver(options, kCoils, bus_);
  const std::vector<std::uint16_t> right{0x44bb, 0x8000};  // 1500 mA
  bus_.set(kUnit, RegisterTable::kInput, 6, right);
  const auto run = [&](double seconds) {
    for (const double end = now_ + seconds; now_ < end;) {
      now_ += 0.005;
      offerTo(driver, pattern(3, 1.5));
      driver.beat(now_);
    }
  };
  run(0.1);
  ASSERT_NE(setpoint(3), 0.0);
  for (const unsigned high : {0x7fc0U, 0x7f80U, 0xff80U}) {  // NaN and both infinities
    bus_.set(kUnit, RegisterTable::kInput, 6, {static_cast<std::uint16_t>(high), 0});
    run(0.01);
    const std::size_t written = bus_.writes().size();
    const std::uint16_t heartbeat = bus_.at(kUnit, RegisterTable::kHolding, 101);
    run(10.0);
    for (std::size_t n = written; n < bus_.writes().size(); ++n) {
      const std::vector<std::uint16_t>& words = bus_.writes()[n].words;
      EXPECT_TRUE(std::all_of(words.begin(), words.end(), [](auto word) { return word == 0; }));
    }
    EXPECT_EQ(bus_.at(kUnit, RegisterTable::kHolding, 101), heartbeat);
    EXPECT_FALSE(driver.link().isUp());
    EXPECT_NE(driver.beat(now_).zero_reason.find("not finite"), std::string::npos);
    bus_.set(kUnit, RegisterTable::kInput, 6, right);
    run(3.0);
    EXPECT_NE(setpoint(3), 0.0);
  }
}

TEST_F(CoilDriverTest, AStalledLoopTakesNoLargeStep) {
  beat();
  now_ += 10.0;
  offer(pattern(3, 2.5));
  driver_.beat(now_);
  // 100 A/s for at most 50 ms would be 5 A: the coil's limit holds; at 20 A/s the step shows.
  CurrentAmplifierOptions slow = shippedOptions();
  slow.limits.slew = 20.0;
  CoilDriver driver(slow, kCoils, bus_);
  driver.beat(now_);
  now_ += 10.0;
  offerTo(driver, pattern(3, 2.5));
  driver.beat(now_);
  EXPECT_LE(setpoint(3), 1.0 + 1e-9);
}

TEST_F(CoilDriverTest, CountsTheHeartbeatUp) {
  follow(pattern(3, 1.5));
  const std::uint16_t before = bus_.at(kUnit, RegisterTable::kHolding, 101);
  beat();
  EXPECT_EQ(bus_.at(kUnit, RegisterTable::kHolding, 101), before + 1);
}

}  // namespace
}  // namespace sac
