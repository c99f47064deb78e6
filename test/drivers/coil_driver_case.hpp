#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

#include <gtest/gtest.h>

#include "drivers/shipped_coil_driver.hpp"
#include "spherical_actuator_calibration/drivers/coil_driver.hpp"
#include "support/scripted_transport.hpp"

namespace sac {

/// The shipped driver at an amplifier whose answers are scripted.
class CoilDriverTest : public ::testing::Test {
 protected:
  static Eigen::VectorXd pattern(std::size_t coil, double current) {
    Eigen::VectorXd command = Eigen::VectorXd::Zero(kCoils);
    command[static_cast<Eigen::Index>(coil)] = current;
    return command;
  }

  /// What the amplifier is told for a coil, from 0 [A].
  double setpoint(int coil) const {
    return 1e-3 * static_cast<std::int16_t>(bus_.at(kUnit, RegisterTable::kHolding, coil));
  }
  bool allZero() const {
    for (int coil = 0; coil < static_cast<int>(kCoils); ++coil) {
      if (setpoint(coil) != 0.0) {
        return false;
      }
    }
    return true;
  }
  bool enabled() const { return bus_.at(kUnit, RegisterTable::kHolding, 100) == 1; }

  /// A command that is given at this moment.
  std::string offer(const Eigen::VectorXd& currents) { return offerTo(driver_, currents); }
  std::string offerTo(CoilDriver& driver, const Eigen::VectorXd& currents) const {
    return driver.offer({"/operator", now_, currents}, {now_, now_});
  }

  /// What the amplifier measures in a coil, from 0 [A].
  void measures(int coil, double current) {
    const auto word = static_cast<std::int16_t>(current / 1e-3);
    bus_.set(kUnit, RegisterTable::kInput, coil, {static_cast<std::uint16_t>(word)});
  }

  /// Beats until the command is reached.
  void follow(const Eigen::VectorXd& command) {
    // A command before the link is up would be forgotten.
    beat();
    for (int n = 0; n < 20; ++n) {
      now_ += 0.005;
      ASSERT_EQ(offer(command), "");
      ASSERT_EQ(driver_.beat(now_).zero_reason, "");
    }
  }
  CoilDriver::Beat beat() {
    now_ += 0.005;
    return driver_.beat(now_);
  }
  /// As often as zero needs to be confirmed. Returns what the last call says.
  std::string stop() {
    std::string reason;
    for (int n = 0; n < 65; ++n) {
      now_ += 0.005;
      reason = driver_.stop(now_);
    }
    return reason;
  }

  ScriptedTransport bus_;
  CoilDriver driver_{shippedOptions(), kCoils, bus_};
  double now_ = 100.0;
};

}  // namespace sac
