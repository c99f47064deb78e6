#include "spherical_actuator_calibration/motion/better_currents.hpp"

#include <cmath>
#include <memory>
#include <numeric>

#include <gtest/gtest.h>

#include "spherical_actuator_calibration/estimation/calibration_state.hpp"
#include "support/moving_rotor.hpp"

namespace sac {
namespace {

constexpr float kWrong = 1.2F;  // as much as the current is
constexpr float kLittleWrong = 1.003F;

/// A motion with two tellings of its currents, one of which is that of a machine that is stronger
/// in one coil.
class BetterCurrents : public ::testing::Test {
 protected:
  BetterCurrents() {
    problem_.model = &model_;
    problem_.recording = &recording_;
    problem_.prior = nominalState(model_.space(), {}).belief;
    problem_.free.resize(static_cast<std::size_t>(model_.space().size()));
    std::iota(problem_.free.begin(), problem_.free.end(), 0);
  }

  /// The shares by which one coil's current is told, by samples and by commands.
  MotionEstimate estimated(float sampled, float commanded) {
    MotionStreams& streams = recording_.spans.front();
    CommandedCurrents by_commands{streams.currents, {1e-3, 2e-3, 4e-4}};
    by_commands.currents.matrix().col(0) *= commanded;
    streams.currents.matrix().col(0) *= sampled;
    streams.commanded = std::make_shared<CommandedCurrents>(by_commands);
    commanded_ = byCommands(recording_);
    return estimateByBetterCurrents(commanded_, {}, problem_);
  }

  MotionRecording recording_ = noisy(MovingRotor{}.record());
  std::optional<MotionRecording> commanded_;
  CalibrationModel model_{ParameterSpace(scenarios::paperNominal(), withMotionEffects({}))};
  MotionProblem problem_;
};

TEST_F(BetterCurrents, AreThoseOfCommandsWhereTheyFitAsWell) {
  const MotionEstimate same = estimated(1.0F, 1.0F);
  EXPECT_EQ(problem_.recording, &*commanded_);
  EXPECT_TRUE(same.summary.response);
  problem_.recording = &recording_;
  const MotionEstimate found = estimated(kWrong, 1.0F);
  EXPECT_EQ(problem_.recording, &*commanded_);
  EXPECT_TRUE(found.summary.response);
  EXPECT_LT(found.summary.window_chi_square, 1.3);
  problem_.recording = &recording_;
  EXPECT_GT(estimateMotion(problem_, {}, {}).summary.window_chi_square, 1.5);
}

TEST_F(BetterCurrents, AreThoseThatWereSampledWhereCommandsFitWorse) {
  const MotionEstimate found = estimated(1.0F, kLittleWrong);
  EXPECT_EQ(problem_.recording, &recording_);
  EXPECT_FALSE(found.summary.response);
  EXPECT_LT(found.summary.window_chi_square, 1.3);
}

// A driver that writes at a beat of its own makes its steps anywhere between two samples.
TEST_F(BetterCurrents, TellADelayNoBetterThanToTheTimeBetweenSamples) {
  MotionStreams& streams = recording_.spans.front();
  const double interval = secondsBetween(streams.current_stamps[0], streams.current_stamps[1]);
  const auto told = [&](double lateness_stddev) {
    streams.commanded = std::make_shared<CommandedCurrents>(
        CommandedCurrents{streams.currents, {1e-3, 2e-3, lateness_stddev}});
    return byCommands(recording_)->spans.front().response->lateness_stddev;
  };
  EXPECT_NEAR(told(1e-5), interval / std::sqrt(12.0), 0.01 * interval);
  EXPECT_EQ(told(interval), interval);
}

TEST_F(BetterCurrents, AreThoseThatThereAre) {
  EXPECT_FALSE(byCommands(recording_));
  const MotionEstimate found = estimateByBetterCurrents(byCommands(recording_), {}, problem_);
  EXPECT_EQ(problem_.recording, &recording_);
  EXPECT_EQ(found.estimate.termination, Termination::kConverged);
}

}  // namespace
}  // namespace sac
