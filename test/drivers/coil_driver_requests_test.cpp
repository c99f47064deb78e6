#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "drivers/shipped_coil_driver.hpp"
#include "spherical_actuator_calibration/drivers/coil_driver.hpp"
#include "support/scripted_transport.hpp"

namespace sac {
namespace {

/// An amplifier whose registers allow fewer requests than the shipped ones.
struct Registers {
  RegisterTable table = RegisterTable::kInput;  ///< of `currents` and `tripped`
  int currents = 0;
  bool one_request = false;

  int tripped() const { return currents + static_cast<int>(kCoils); }
};

class CoilDriverRequests : public ::testing::TestWithParam<Registers> {
 protected:
  static CurrentAmplifierOptions options() {
    CurrentAmplifierOptions options = shippedOptions();
    options.heartbeat_address = static_cast<int>(kCoils);
    options.currents.table = options.tripped->table = GetParam().table;
    options.currents.address = GetParam().currents;
    options.tripped->address = GetParam().tripped();
    options.one_request = GetParam().one_request;
    return options;
  }

  std::uint16_t holding(int address) const {
    return bus_.at(kUnit, RegisterTable::kHolding, address);
  }
  void setTripped(bool tripped) {
    bus_.set(kUnit, GetParam().table, GetParam().tripped(), {std::uint16_t{tripped}});
  }

  CoilDriver::Beat beat(double current) {
    now_ += kBeat;
    Eigen::VectorXd command = Eigen::VectorXd::Zero(kCoils);
    command[3] = current;
    EXPECT_EQ(driver_.offer({"/operator", now_, command}, {now_, now_}), "");
    return driver_.beat(now_);
  }
  /// Beats until the current is set.
  void follow(double current) {
    driver_.beat(now_);
    for (int n = 0; n < 10; ++n) {
      ASSERT_EQ(beat(current).zero_reason, "");
    }
    ASSERT_EQ(holding(3), static_cast<int>(1000.0 * current));
  }

  ScriptedTransport bus_;
  CoilDriver driver_{options(), kCoils, bus_};
  double now_ = 100.0;
};

TEST_P(CoilDriverRequests, ABeatTakesFew) {
  follow(1.0);
  const auto requests = [&] { return static_cast<int>(bus_.writes().size()) + bus_.reads(); };
  const int before = requests();
  const std::uint16_t heartbeat = holding(kCoils);
  beat(1.0);
  EXPECT_EQ(requests() - before, GetParam().one_request ? 1 : 2);
  EXPECT_EQ(holding(kCoils), heartbeat + 1);
}

TEST_P(CoilDriverRequests, BeginsWithZeroByARequestThatOnlyWrites) {
  bus_.set(kUnit, RegisterTable::kHolding, 3, {1500});
  driver_.beat(now_);
  ASSERT_GE(bus_.writes().size(), 2U);
  EXPECT_EQ(bus_.writes()[0].address, 100);
  EXPECT_EQ(bus_.writes()[0].words, std::vector<std::uint16_t>{0});
  EXPECT_EQ(bus_.writes()[1].address, 0);
  EXPECT_EQ(bus_.writes()[1].words, std::vector<std::uint16_t>(kCoils, 0));
}

// It is seen in the answer that has the currents, and acted on in the same beat.
TEST_P(CoilDriverRequests, ATripMeansZeroInTheBeatThatSeesIt) {
  follow(1.0);
  setTripped(true);
  const CoilDriver::Beat tripped = beat(1.0);
  EXPECT_EQ(tripped.zero_reason, "the amplifier has tripped");
  EXPECT_TRUE(tripped.fault);
  EXPECT_TRUE(tripped.measured);
  EXPECT_EQ(holding(3), 0);
  EXPECT_EQ(holding(100), 0);
}

TEST_P(CoilDriverRequests, ATripWithholdsTheOutputStages) {
  driver_.beat(now_);
  setTripped(true);
  const std::uint16_t heartbeat = holding(kCoils);
  for (int n = 0; n < 5; ++n) {
    const std::size_t writes = bus_.writes().size();
    EXPECT_EQ(beat(1.0).zero_reason, "the amplifier has tripped");
    for (std::size_t k = writes; k < bus_.writes().size(); ++k) {
      const ScriptedTransport::Write& write = bus_.writes()[k];
      EXPECT_EQ(write.words, std::vector<std::uint16_t>(write.words.size(), 0)) << write.address;
    }
  }
  EXPECT_EQ(holding(kCoils), heartbeat);
  setTripped(false);
  for (int n = 0; n < 10; ++n) {
    beat(1.0);
  }
  EXPECT_EQ(holding(3), 1000);
  EXPECT_EQ(holding(100), 1);
}

TEST_P(CoilDriverRequests, TellsTheAgeOfACommandOnceWhenItIsSet) {
  follow(0.0);
  now_ += kBeat;
  ASSERT_EQ(driver_.offer({"/operator", now_, Eigen::VectorXd::Zero(kCoils)}, {now_, now_}), "");
  const CoilDriver::Beat first = driver_.beat(now_ + 0.003);
  ASSERT_TRUE(first.command_age);
  EXPECT_NEAR(*first.command_age, 0.003, 0.002);
  EXPECT_GE(*first.command_age, 0.003);
  EXPECT_FALSE(driver_.beat(now_ + 0.008).command_age);
}

INSTANTIATE_TEST_SUITE_P(Amplifiers,
                         CoilDriverRequests,
                         ::testing::Values(Registers{RegisterTable::kInput, 0, false},
                                           Registers{RegisterTable::kHolding, 110, false},
                                           Registers{RegisterTable::kHolding, 110, true}));

}  // namespace
}  // namespace sac
