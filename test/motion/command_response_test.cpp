#include "command_response.hpp"

#include <cmath>
#include <functional>
#include <random>

#include <gtest/gtest.h>

#include "current_steps.hpp"
#include "motion/stepping_currents.hpp"
#include "spherical_actuator_calibration/base/pi.hpp"
#include "spherical_actuator_calibration/motion/motion_recording.hpp"

namespace sac {
namespace {

constexpr double kLate = 1.5e-3;          // [s] of a setpoint behind its command
constexpr double kFirstFrequency = 11.0;  // [rad/s] of the first coil

Stamp stampOf(double time) {
  return static_cast<Stamp>(std::llround((time + 100.0) * 1e9));
}

Eigen::Vector3d wish(double time) {
  return {0.3 * std::sin(kFirstFrequency * time),
          0.2 * std::sin(14.0 * time + 1.0),
          0.2 * std::cos(6.0 * time)};
}

/// Tells a visitor the currents of three coils that follow sums of sines in steps, with a lag.
void follow(double begin,
            double interval,
            const std::function<void(double, const Eigen::Vector3d&)>& visit) {
  Eigen::Vector3d setpoint = wish(0.0);
  Eigen::Vector3d before = setpoint;
  long step = 0;
  for (double time = begin; time < kDuration; time += interval) {
    for (; static_cast<double>(step + 1) * kHold <= time + 1e-9; ++step) {
      before = setpoint + (before - setpoint) * std::exp(-kHold / kLag);
      setpoint = wish(static_cast<double>(step + 1) * kHold);
    }
    const double share = std::exp(-(time - static_cast<double>(step) * kHold) / kLag);
    visit(time, setpoint + share * (before - setpoint));
  }
}

CommandStream commanded() {
  CommandStream commands;
  const auto count = static_cast<Eigen::Index>(std::lround(kDuration / kHold));
  commands.currents = StreamCurrents(count, 3);
  for (Eigen::Index n = 0; n < count; ++n) {
    const double time = static_cast<double>(n) * kHold;
    commands.stamps.push_back(stampOf(time - kLate));
    commands.currents.row(n) = wish(time).transpose().cast<float>();
  }
  return commands;
}

MotionStreams sampled(double interval, double phase) {
  std::mt19937 generator(1);
  std::normal_distribution<double> noise(0.0, 1e-3);
  MotionStreams streams;
  std::vector<Eigen::Vector3d> currents;
  follow(phase, interval, [&](double time, const Eigen::Vector3d& current) {
    streams.current_stamps.push_back(stampOf(time));
    currents.push_back(current +
                       Eigen::Vector3d(noise(generator), noise(generator), noise(generator)));
  });
  streams.currents = StreamCurrents(static_cast<Eigen::Index>(currents.size()), 3);
  for (std::size_t n = 0; n < currents.size(); ++n) {
    streams.currents.row(static_cast<Eigen::Index>(n)) = currents[n].transpose().cast<float>();
  }
  return streams;
}

/// Ends at zero as test functions do; its phase is that which tells a delay best.
double weight(double time) {
  return std::pow(std::sin(kPi * time / kDuration), 2) * std::cos(kFirstFrequency * time);
}

/// By how much the first coil is late where its sum over samples stands for its integral [s].
double lateness(const MotionStreams& streams, double interval) {
  constexpr double kFine = 1e-5;  // [s]
  double exact = 0.0;
  double slope = 0.0;
  follow(0.5 * kFine, kFine, [&](double time, const Eigen::Vector3d& current) {
    exact += kFine * weight(time) * current[0];
    slope += 0.5 * (weight(time + kFine) - weight(time - kFine)) * current[0];
  });
  double sum = 0.0;
  for (std::size_t n = 0; n < streams.current_stamps.size(); ++n) {
    const double time = secondsBetween(stampOf(0.0), streams.current_stamps[n]);
    sum += interval * weight(time) *
           static_cast<double>(streams.currents(static_cast<Eigen::Index>(n), 0));
  }
  return (sum - exact) / slope;
}

TEST(CommandResponse, MakesSamplesTellWhatStepsBetweenThemDo) {
  for (const double interval : {1e-3, 2e-3}) {
    for (const double phase : {0.0, 0.5}) {
      MotionStreams streams = sampled(interval, phase * interval);
      streams.response = takeMeans(commanded(), streams);
      ASSERT_TRUE(streams.response) << interval << " " << phase;
      EXPECT_NEAR(streams.response->delay, kLate, 2e-5);
      EXPECT_NEAR(streams.response->lag, kLag, 4e-5);
      EXPECT_LT(std::abs(lateness(streams, interval)), 1.5e-5) << interval << " " << phase;
      CurrentSteps steps;
      steps.add(streams);
      EXPECT_DOUBLE_EQ(steps.delayStddev(1e-3), streams.response->lateness_stddev);
      EXPECT_LT(streams.response->lateness_stddev, 3e-5);
    }
  }
  EXPECT_GT(std::abs(lateness(sampled(1e-3, 0.0), 1e-3)), 3e-5);
}

TEST(CommandResponse, IsLessKnownWhereAllSamplesAreAtOnePlaceBetweenCommands) {
  MotionStreams streams = sampled(kHold, 1e-3);
  streams.response = takeMeans(commanded(), streams);
  ASSERT_TRUE(streams.response);
  EXPECT_LT(std::abs(lateness(streams, kHold)), 1e-4);
  EXPECT_GT(streams.response->lateness_stddev, 3e-4);
}

TEST(CommandResponse, IsNoneWhereCurrentsDoSomethingElse) {
  const MotionStreams measured = sampled(1e-3, 0.0);
  const auto is_told = [&](const CommandStream& commands) {
    MotionStreams streams = measured;
    const std::optional<CommandResponse> response = takeMeans(commands, streams);
    EXPECT_EQ(response.has_value(), streams.currents != measured.currents);
    return response.has_value();
  };
  EXPECT_TRUE(is_told(commanded()));
  CommandStream commands = commanded();
  commands.currents.matrix().col(1) *= -1.0F;  // one coil the other way round
  EXPECT_FALSE(is_told(commands));
  commands = commanded();
  commands.currents.matrix().col(0).setZero();
  EXPECT_FALSE(is_told(commands));
  commands = commanded();
  commands.currents = StreamCurrents(commands.currents.matrix().colwise().reverse());
  EXPECT_FALSE(is_told(commands));
  commands = commanded();
  for (std::size_t n = 2000; n < commands.stamps.size(); ++n) {
    commands.stamps[n] += 3'000'000'000;  // those of three seconds are missing
  }
  EXPECT_FALSE(is_told(commands));
  commands = commanded();
  const std::size_t half = commands.stamps.size() / 2;  // recorded until then
  commands.stamps.truncate(half);
  commands.currents =
      StreamCurrents(commands.currents.matrix().topRows(static_cast<Eigen::Index>(half)));
  EXPECT_FALSE(is_told(commands));
  commands = commanded();  // recorded from then on
  commands.stamps = {commands.stamps.begin() + half, commands.stamps.end()};
  commands.currents = StreamCurrents(
      commands.currents.matrix().bottomRows(static_cast<Eigen::Index>(commands.stamps.size())));
  EXPECT_FALSE(is_told(commands));
  EXPECT_FALSE(is_told({}));
}

TEST(CommandResponse, LeavesWhatIsBesideAHole) {
  MotionStreams streams = sampled(1e-3, 0.0);
  for (std::size_t n = 10000; n < streams.current_stamps.size(); ++n) {
    streams.current_stamps[n] += 1'000'000'000;
  }
  CommandStream commands = commanded();
  for (std::size_t n = 2000; n < commands.stamps.size(); ++n) {
    commands.stamps[n] += 1'000'000'000;
  }
  const MotionStreams before = streams;
  ASSERT_TRUE(takeMeans(commands, streams));
  EXPECT_EQ(streams.currents.matrix().middleRows(9999, 2),
            before.currents.matrix().middleRows(9999, 2));
  EXPECT_LT((streams.currents.matrix() - before.currents.matrix()).cwiseAbs().maxCoeff(), 0.02F);
}

/// What a recorder makes of them.
MotionRecording recorded(const MotionStreams& measured, const CommandStream& commands) {
  MotionRecorder recorder(3);
  recorder.add(JointMeasurement{measured.current_stamps.front(), Eigen::Vector3d::Zero()});
  for (std::size_t n = 0; n < commands.stamps.size(); ++n) {
    const Eigen::VectorXd current =
        commands.currents.row(static_cast<Eigen::Index>(n)).transpose().cast<double>();
    recorder.add(CurrentCommand{commands.stamps[n], current});
    recorder.add(CurrentCommand{commands.stamps[n], 2.0 * current});  // is not later
    recorder.add(CurrentCommand{commands.stamps[n] + 1, Eigen::VectorXd::Constant(2, 9.0)});
  }
  for (std::size_t n = 0; n < measured.current_stamps.size(); ++n) {
    const auto row = static_cast<Eigen::Index>(n);
    recorder.add(CurrentMeasurement{measured.current_stamps[n],
                                    measured.currents.row(row).transpose().cast<double>()});
  }
  return recorder.take();
}

TEST(MotionRecorder, KeepsBothWhereCommandsTellStepsNotWell) {
  const MotionStreams measured = sampled(kHold, 1e-3);
  const MotionRecording recording = recorded(measured, commanded());
  ASSERT_EQ(recording.spans.size(), 1U);
  const MotionStreams& streams = recording.spans[0];
  EXPECT_FALSE(streams.response);
  EXPECT_EQ(streams.currents, measured.currents);
  ASSERT_TRUE(streams.commanded);
  EXPECT_GT(streams.commanded->response.lateness_stddev, 3e-4);
  EXPECT_EQ(streams.commanded->currents.rows(), measured.currents.rows());
  EXPECT_NE(streams.commanded->currents, measured.currents);
}

TEST(MotionRecorder, TakesWhatWasCommandedIntoTheCurrents) {
  const MotionRecording recording = recorded(sampled(1e-3, 0.0), commanded());
  ASSERT_EQ(recording.spans.size(), 1U);
  EXPECT_EQ(recording.dropped, 0U);
  ASSERT_TRUE(recording.spans[0].response);
  EXPECT_NEAR(recording.spans[0].response->delay, kLate, 2e-5);
  EXPECT_FALSE(recording.spans[0].commanded);
}

}  // namespace
}  // namespace sac
