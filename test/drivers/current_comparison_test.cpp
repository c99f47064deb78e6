#include "spherical_actuator_calibration/drivers/current_comparison.hpp"

#include <algorithm>
#include <cmath>
#include <deque>
#include <functional>
#include <limits>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "drivers/current_course.hpp"
#include "drivers/shipped_coil_driver.hpp"
#include "spherical_actuator_calibration/base/pi.hpp"

namespace sac {
namespace {

constexpr double kSlew = 100.0;       // [A/s] of the shipped configuration
constexpr double kCommandRate = 100;  // [Hz]
constexpr double kNever = std::numeric_limits<double>::infinity();

/// An amplifier's current [A] by what is set, at a time [s].
using Plant = std::function<double(double setpoint, double time)>;

Course sine(double amplitude, double frequency, double mean = 0.0) {
  return [=](double time) { return mean + amplitude * std::sin(2.0 * kPi * frequency * time); };
}

Course steps(double amplitude, double duration) {
  return [=](double time) {
    return std::fmod(time, 2.0 * duration) < duration ? amplitude : -amplitude;
  };
}

/// There for `on`, then gone for `off` [s].
Course blinking(double current, double on, double off) {
  return [=](double time) { return std::fmod(time, on + off) < on ? current : 0.0; };
}

/// Another one at random with every command.
Course noise(double amplitude, double rate) {
  return [=](double time) {
    std::minstd_rand random(static_cast<unsigned>(1.0 + rate * time));
    random.discard(3);
    return std::uniform_real_distribution<double>(-amplitude, amplitude)(random);
  };
}

Course zero() {
  return [](double) { return 0.0; };
}

/// Does what it is told after a delay, with a time constant [s].
Plant lagging(double delay, double time_constant) {
  std::deque<std::pair<double, double>> orders{{-1.0, 0.0}};
  double current = 0.0;
  return [=](double setpoint, double time) mutable {
    constexpr int kParts = 5;
    orders.emplace_back(time, setpoint);
    for (int part = 1; part <= kParts; ++part) {
      const double moment = time - delay - kBeat * (kParts - part) / kParts;
      while (orders.size() > 1 && orders[1].first <= moment) {
        orders.pop_front();
      }
      const double wanted = orders.front().second;
      current += (wanted - current) *
                 (time_constant > 0.0 ? -std::expm1(-kBeat / kParts / time_constant) : 1.0);
    }
    return current;
  };
}

/// Has this current whatever is set.
Plant deaf(Course current) {
  return [current = std::move(current)](double, double time) { return current(time); };
}

/// When the second of two coils is told to deviate [s]. The loop is late at times by `jitter` [s].
double deviationToldAt(const Course& commanded, Plant plant, double end, double jitter = 0.0) {
  CurrentComparison comparison(2, kTolerance, kBeats, kBeat);
  std::minstd_rand random(1);
  std::exponential_distribution<double> late(1.0);
  // What flows at the beginning may have been set before.
  for (const double time : {999.0, 1000.0 - kBeat}) {
    EXPECT_FALSE(comparison.observe(Eigen::Vector2d::Zero(), time, time));
  }
  double setpoint = 0.0;
  double elapsed = 0.0;
  for (double time = 0.0; time < end; time += elapsed) {
    const double step = kSlew * elapsed;
    const double command = commanded(std::floor(time * kCommandRate) / kCommandRate);
    setpoint += std::max(-step, std::min(step, command - setpoint));
    comparison.setting(Eigen::Vector2d(0.0, setpoint));
    if (const auto coil = comparison.observe(
            Eigen::Vector2d(0.0, plant(setpoint, time)), 1000.0 + time, 1000.0 + time)) {
      EXPECT_EQ(*coil, 1U);
      return time;
    }
    elapsed = kBeat + jitter * late(random);
  }
  return kNever;
}

const std::vector<std::pair<std::string, Course>>& commands() {
  static const std::vector<std::pair<std::string, Course>> all{
      {"zero", zero()},
      {"1 Hz", sine(2.0, 1.0)},
      {"2.5 Hz", sine(2.0, 2.5)},
      {"8 Hz", sine(2.0, 8.0)},
      {"20 Hz", sine(2.0, 20.0)},
      {"steps of 0.25 s", steps(2.0, 0.25)},
      {"steps of 0.1 s", steps(2.0, 0.1)},
      {"steps of 0.03 s", steps(2.0, 0.03)},
      {"noise of 20 Hz", noise(2.0, 20.0)},
      {"noise of 100 Hz", noise(2.0, 100.0)},
  };
  return all;
}

TEST(CurrentComparison, AnHonestAmplifierNeverDeviatesHoweverItLags) {
  for (const double delay : {0.0, 0.004, 0.013, 0.05, 0.1, 0.15}) {
    for (const double time_constant : {0.0, 0.005, 0.01, 0.02, 0.025, 0.03}) {
      for (const auto& [name, course] : commands()) {
        EXPECT_EQ(deviationToldAt(course, lagging(delay, time_constant), 2.0), kNever)
            << name << ", delay " << delay << ", time constant " << time_constant;
      }
    }
  }
}

TEST(CurrentComparison, ALateLoopIsNoDeviation) {
  for (const double jitter : {0.003, 0.03}) {
    for (const double delay : {0.0, 0.1}) {
      for (const auto& [name, course] : commands()) {
        EXPECT_EQ(deviationToldAt(course, lagging(delay, 0.0), 10.0, jitter), kNever)
            << name << ", late by " << jitter << ", delay " << delay;
      }
    }
  }
}

struct Lie {
  std::string what;
  Course commanded;
  Plant plant;
};

std::vector<Lie> lies() {
  std::vector<Lie> all;
  for (const double frequency : {1.0, 2.6, 5.0, 12.0, 40.0}) {
    all.push_back({"oscillates while zero is set", zero(), deaf(sine(2.0, frequency))});
  }
  all.push_back({"oscillates about 1 A", zero(), deaf(sine(1.2, 5.0, 1.0))});
  all.push_back({"is zero once in 30 beats", zero(), deaf(blinking(2.0, 0.145, 0.005))});
  all.push_back({"blinks", zero(), deaf(blinking(2.0, 0.1, 0.1))});
  all.push_back({"blinks slowly", zero(), deaf(blinking(2.0, 0.2, 0.2))});
  for (const double frequency : {1.0, 2.5, 4.0, 8.0}) {
    all.push_back({"stuck", sine(2.0, frequency), deaf([](double) { return 2.0; })});
  }
  for (const double frequency : {1.0, 2.5, 4.0}) {
    all.push_back({"open wire", sine(1.0, frequency), deaf(zero())});
  }
  all.push_back({"stuck in noise", noise(2.0, 20.0), deaf([](double) { return 2.0; })});
  return all;
}

TEST(CurrentComparison, WhatNoLagExplainsIsToldWithinHalfASecond) {
  for (const Lie& lie : lies()) {
    const double told = deviationToldAt(lie.commanded, lie.plant, 4.0);
    EXPECT_LE(told, 0.5) << lie.what << ", commanded after 0.05 s: " << lie.commanded(0.05);
  }
  // The faster, the more of them are alike.
  EXPECT_LE(deviationToldAt(sine(2.0, 8.0), deaf(zero()), 4.0), 0.6);
}

TEST(CurrentComparison, ShortCurrentsAddUp) {
  EXPECT_LE(deviationToldAt(zero(), deaf(blinking(2.0, 0.05, 0.1)), 4.0), 1.0);
  EXPECT_LE(deviationToldAt(zero(), deaf(blinking(2.0, 0.02, 0.08)), 9.0), 4.0);
  // A spike now and then is noise.
  EXPECT_EQ(deviationToldAt(zero(), deaf(blinking(2.0, 0.005, 0.145)), 60.0), kNever);
}

TEST(CurrentComparison, CountsAnewWhenItIsForgiven) {
  CurrentComparison comparison(1, kTolerance, kBeats, kBeat);
  const Eigen::VectorXd two = Eigen::VectorXd::Constant(1, 2.0);
  double time = 0.0;
  for (const double before : {-1.0, time}) {
    ASSERT_FALSE(comparison.observe(Eigen::VectorXd::Zero(1), before, before));
  }
  const auto beats_until_told = [&] {
    int beats = 1;
    for (time += kBeat; !comparison.observe(two, time, time); time += kBeat) {
      ++beats;
    }
    return beats;
  };
  EXPECT_EQ(beats_until_told(), kBeats);
  time += kBeat;
  EXPECT_TRUE(comparison.observe(two, time, time));
  comparison.forgive();
  EXPECT_EQ(beats_until_told(), kBeats);
}

/// Answers slowly: what it does of a request may be done at the begin of its answer, or at its end.
class SlowAmplifier {
 public:
  SlowAmplifier(double delay, double time_constant)
      : delay_(delay), time_constant_(time_constant) {}

  void set(double setpoint, double time) { orders_.emplace_back(time, setpoint); }
  double currentAt(double time) {
    constexpr double kPart = 0.001;  // [s]
    while (time_ < time) {
      const double part = std::min(kPart, time - time_);
      time_ += part;
      while (orders_.size() > 1 && orders_[1].first <= time_ - delay_) {
        orders_.pop_front();
      }
      const double wanted = orders_.front().second;
      current_ +=
          (wanted - current_) * (time_constant_ > 0.0 ? -std::expm1(-part / time_constant_) : 1.0);
    }
    return current_;
  }

 private:
  double delay_;
  double time_constant_;
  std::deque<std::pair<double, double>> orders_{{-1.0, 0.0}};
  double time_ = 0.0;
  double current_ = 0.0;
};

/// A loop of three requests: of the trip, of the setpoints, of the currents.
struct SlowLoop {
  double answer = 0.0;    ///< takes so long [s]
  double applied = 0.0;   ///< at this share of it
  double measured = 0.0;  ///< likewise
};

/// When the coil is told to deviate [s]; what the amplifier measures is replaced by `lie`, if
/// given.
double deviationToldAt(const Course& commanded,
                       SlowAmplifier amplifier,
                       const SlowLoop& loop,
                       double end,
                       const Course& lie = {}) {
  CurrentComparison comparison(1, kTolerance, kBeats, kBeat);
  double setpoint = 0.0;
  for (double time = 0.0; time < end;) {
    const double step = kSlew * std::min(3.0 * loop.answer, 0.05);
    time += loop.answer;
    setpoint += std::max(-step, std::min(step, commanded(time) - setpoint));
    comparison.setting(Eigen::VectorXd::Constant(1, setpoint));
    amplifier.set(setpoint, time + loop.applied * loop.answer);
    time += loop.answer;
    const double moment = time + loop.measured * loop.answer;
    const double current = lie ? lie(moment) : amplifier.currentAt(moment);
    const double begin = time;
    time += loop.answer;
    if (comparison.observe(Eigen::VectorXd::Constant(1, current), begin, time)) {
      return time;
    }
  }
  return kNever;
}

TEST(CurrentComparison, SlowAnswersOfAnHonestAmplifierAreNoDeviation) {
  for (const double answer : {0.003, 0.007, 0.01, 0.03}) {
    for (const double delay : {0.0, 0.05, 0.16}) {
      for (const double time_constant : {0.0, 0.02, 0.03}) {
        for (const double applied : {0.0, 1.0}) {
          for (const double measured : {0.0, 1.0}) {
            for (const auto& [name, course] : commands()) {
              EXPECT_EQ(deviationToldAt(course,
                                        SlowAmplifier(delay, time_constant),
                                        {answer, applied, measured},
                                        4.0),
                        kNever)
                  << name << ", answers of " << answer << " s, delay " << delay
                  << ", time constant " << time_constant << ", applied at " << applied
                  << ", measured at " << measured;
            }
          }
        }
      }
    }
  }
}

// The time until it is told must hardly grow: three measurements decide at least.
TEST(CurrentComparison, ASlowLoopTellsInHardlyMoreTime) {
  struct Limit {
    double answer = 0.0;   ///< takes so long [s]
    double longest = 0.0;  ///< until it is told [s]
  };
  for (const auto& [answer, longest] : {Limit{0.001, 0.42},
                                        Limit{0.003, 0.42},
                                        Limit{0.01, 0.42},
                                        Limit{0.02, 0.42},
                                        Limit{0.023, 0.48},
                                        Limit{0.028, 0.57},
                                        Limit{0.033, 0.57}}) {
    for (double off = 1.0; off < 1.1; off += 0.003) {
      const Course commanded = [off](double time) { return time < off ? 2.0 : 0.0; };
      const Course stuck = [](double time) { return time < 0.1 ? 0.0 : 2.0; };
      const double told =
          deviationToldAt(commanded, SlowAmplifier(0.0, 0.0), {answer, 0.0, 0.0}, 4.0, stuck) - off;
      EXPECT_GT(told, 0.29) << answer;
      EXPECT_LT(told, longest) << answer;
    }
  }
}

// Commands make the beats short; the time in which an honest one may lag must not shrink.
TEST(CurrentComparison, AFastLoopTellsInTheSameTime) {
  for (const double beat : {0.0025, 0.004, 0.005}) {
    CurrentComparison comparison(1, kTolerance, kBeats, kBeat);
    const Eigen::VectorXd two = Eigen::VectorXd::Constant(1, 2.0);
    const Eigen::VectorXd none = Eigen::VectorXd::Zero(1);
    double time = 0.0;
    for (; time < 1.0; time += beat) {
      comparison.setting(two);
      ASSERT_FALSE(comparison.observe(two, time, time)) << beat;
    }
    const double begin = time;
    bool is_told = false;
    for (; !is_told && time < begin + 2.0; time += beat) {
      comparison.setting(none);
      is_told = comparison.observe(two, time, time).has_value();
    }
    EXPECT_GT(time - begin, 0.3) << beat;
    EXPECT_LT(time - begin, 0.48) << beat;
  }
}

}  // namespace
}  // namespace sac
