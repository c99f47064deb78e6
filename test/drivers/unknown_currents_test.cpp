#include <cmath>
#include <deque>
#include <optional>
#include <utility>

#include <gtest/gtest.h>

#include "drivers/shipped_coil_driver.hpp"
#include "spherical_actuator_calibration/drivers/current_comparison.hpp"
#include "spherical_actuator_calibration/drivers/stray_currents.hpp"

namespace sac {
namespace {

/// Whatever was set before its driver began, it had that.
class Amplifier {
 public:
  Amplifier(double delay, double time_constant, double before = 0.0)
      : delay_(delay), time_constant_(time_constant), current_(before), orders_{{-1e3, before}} {}

  /// [A], a beat after the last one. Output stages that are off cut it at once.
  double beat(double time, double setpoint, bool stages_on) {
    orders_.emplace_back(time, setpoint);
    while (orders_.size() > 1 && orders_[1].first <= time - delay_) {
      orders_.pop_front();
    }
    const double share = time_constant_ > 0.0 ? -std::expm1(-kBeat / time_constant_) : 1.0;
    current_ += share * (orders_.front().second - current_);
    current_ = stages_on ? current_ : 0.0;
    return current_;
  }

 private:
  double delay_;
  double time_constant_;
  double current_;
  std::deque<std::pair<double, double>> orders_;
};

/// When a coil that is commanded and pauses in turn [s] is told to deviate, if it is. A current
/// that stands still takes the place of the amplifier's after half a second, if there is one.
std::optional<double> toldWithPauses(double on,
                                     double off,
                                     Amplifier amplifier,
                                     std::optional<double> stuck = std::nullopt) {
  CurrentComparison comparison(1, kTolerance, kBeats, kBeat);
  for (int beat = 0; beat < 2000; ++beat) {
    const double time = kBeat * beat;
    const bool is_on = std::fmod(time, on + off) < on;
    comparison.setting(Eigen::VectorXd::Constant(1, is_on ? 2.0 : 0.0), is_on);
    const double current = amplifier.beat(time, is_on ? 2.0 : 0.0, is_on);
    const bool is_stuck = stuck && time > 0.5;
    const Eigen::VectorXd measured = Eigen::VectorXd::Constant(1, is_stuck ? *stuck : current);
    if (comparison.observe(measured, 100.0 + time, 100.0 + time)) {
      return time;
    }
  }
  return std::nullopt;
}

TEST(UnknownCurrents, OutputStagesMayCutAtOnceWhereSetpointsAreDelayed) {
  for (const double delay : {0.0, 0.03, 0.1, 0.15, 0.165}) {
    for (const double time_constant : {0.0, 0.01, 0.03}) {
      for (const double on : {0.05, 0.25, 0.4}) {
        for (const double off : {0.01, 0.05, 0.15, 0.3}) {
          EXPECT_FALSE(toldWithPauses(on, off, {delay, time_constant}))
              << "delay " << delay << ", time constant " << time_constant << ", on " << on
              << ", off " << off;
        }
      }
    }
  }
}

TEST(UnknownCurrents, WhatStandsStillThroughPausesIsTold) {
  for (const double off : {0.15, 0.3}) {
    const std::optional<double> told = toldWithPauses(0.25, off, {0.0, 0.0}, 2.5);
    ASSERT_TRUE(told);
    EXPECT_LT(*told, 0.5 + 0.5);
  }
}

TEST(UnknownCurrents, ACoilThatNeverHasCurrentIsToldSoonAfterTheStagesAreOn) {
  CurrentComparison comparison(1, kTolerance, kBeats, kBeat);
  const Eigen::VectorXd none = Eigen::VectorXd::Zero(1);
  double time = 0.0;
  for (; time < 1.0; time += kBeat) {
    comparison.setting(none, false);
    ASSERT_FALSE(comparison.observe(none, time, time));
  }
  const double begin = time;
  bool is_told = false;
  for (; !is_told && time < begin + 1.0; time += kBeat) {
    comparison.setting(Eigen::VectorXd::Constant(1, 2.0), true);
    is_told = comparison.observe(none, time, time).has_value();
  }
  EXPECT_LT(time - begin, 0.5);
}

TEST(UnknownCurrents, WhatFlowsWhenTheDriverBeginsMayGoByItsLag) {
  for (const double delay : {0.0, 0.1, 0.165}) {
    for (const double time_constant : {0.0, 0.015, 0.03}) {
      for (const double before : {-2.5, 1.0, 2.5}) {
        Amplifier amplifier(delay, time_constant, before);
        CurrentComparison comparison(1, kTolerance, kBeats, kBeat);
        for (double time = 0.0; time < 1.0; time += kBeat) {
          comparison.setting(Eigen::VectorXd::Zero(1), false);
          const Eigen::VectorXd measured =
              Eigen::VectorXd::Constant(1, amplifier.beat(time, 0.0, true));
          EXPECT_FALSE(comparison.observe(measured, time, time))
              << "delay " << delay << ", time constant " << time_constant << ", " << before << " A";
        }
      }
    }
  }
}

// Its stages are off when the driver begins, for another coil they are soon on again: what was set
// before, for so long before, is still on its way.
TEST(UnknownCurrents, WhatWasSetBeforeTheDriverBeganMayComeWhenTheStagesAreOn) {
  for (const double delay : {0.05, 0.14, 0.165}) {
    for (const double time_constant : {0.0, 0.015, 0.03}) {
      for (const int beats_off : {1, 4, 20}) {
        Amplifier amplifier(delay, time_constant, 2.0);
        CurrentComparison comparison(1, kTolerance, kBeats, kBeat);
        StrayCurrents strays(1, kTolerance);
        for (int beat = 0; beat < 200; ++beat) {
          const double time = kBeat * beat;
          const bool is_on = beat >= beats_off;
          comparison.setting(Eigen::VectorXd::Zero(1), is_on);
          strays.setting(Eigen::VectorXd::Zero(1));
          const Eigen::VectorXd measured =
              Eigen::VectorXd::Constant(1, amplifier.beat(time, 0.0, is_on));
          EXPECT_FALSE(comparison.observe(measured, time, time) || comparison.isSuspicious())
              << "delay " << delay << ", time constant " << time_constant << ", off for "
              << beats_off;
          EXPECT_FALSE(strays.observe(measured, time));
        }
      }
    }
  }
}

// It may have been set before the driver began, but flows on.
TEST(UnknownCurrents, WhatComesWhenTheDriverHasBegunAndStaysIsTold) {
  for (const double comes : {0.0, 0.05, 0.165}) {
    CurrentComparison comparison(1, kTolerance, kBeats, kBeat);
    double time = 0.0;
    bool is_told = false;
    for (; !is_told && time < 2.0; time += kBeat) {
      comparison.setting(Eigen::VectorXd::Zero(1), true);
      const double current = time < comes ? 0.0 : 2.0;
      is_told = comparison.observe(Eigen::VectorXd::Constant(1, current), time, time).has_value();
    }
    EXPECT_LT(time, 0.55) << comes;
  }
}

TEST(UnknownCurrents, WhatStaysWhenTheDriverBeginsIsTold) {
  CurrentComparison comparison(1, kTolerance, kBeats, kBeat);
  double time = 0.0;
  bool is_told = false;
  for (; !is_told && time < 2.0; time += kBeat) {
    comparison.setting(Eigen::VectorXd::Zero(1), false);
    is_told = comparison.observe(Eigen::VectorXd::Constant(1, 2.0), time, time).has_value();
  }
  EXPECT_LT(time, 0.55);
}

}  // namespace
}  // namespace sac
