#include "spherical_actuator_calibration/motion/live_motion.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>

#include <gtest/gtest.h>

#include "spherical_actuator_calibration/estimation/calibration_state.hpp"
#include "spherical_actuator_calibration/motion/motion_estimator.hpp"
#include "support/motion_slices.hpp"
#include "support/moving_rotor.hpp"
#include "support/resident_memory.hpp"

namespace sac {
namespace {

class LiveMotionTest : public ::testing::Test {
 protected:
  LiveMotionTest() {
    scenarios::Generator generator(3);
    moving_.truth = scenarios::perturbed(scenarios::paperNominal(), 0.02, 0.02, generator);
    moving_.rotor.inertia(0, 0) *= 1.1;
    moving_.rotor.unbalance = Eigen::Vector3d(1e-3, -5e-4, 2e-3);
    moving_.current_delay = 3e-3;
    moving_.tracker_delay = 5e-3;
    moving_.duration = 15.0;
    free_.resize(static_cast<std::size_t>(model_.space().size()));
    std::iota(free_.begin(), free_.end(), 0);
  }
  LiveMotion live(const LiveMotionOptions& options = {}) const {
    return LiveMotion(
        model_, nominalState(model_.space(), {}).belief, free_, EstimationOptions(), {}, options);
  }
  /// Takes a whole recording, window by window, which are added to `taken`.
  void follow(const MotionRecording& recording, LiveMotion& live, MotionRecording& taken) const {
    for (const MotionStreams& streams : recording.spans) {
      for (MotionSlice& slice : slicesOf(streams)) {
        taken.spans.push_back(slice.streams);
        taken.windows.push_back(slice.window);
        live.add(std::move(slice));
      }
    }
  }
  Estimate batch(const MotionRecording& recording) const {
    MotionProblem problem;
    problem.model = &model_;
    problem.recording = &recording;
    problem.prior = nominalState(model_.space(), {}).belief;
    problem.free = free_;
    return estimateMotion(problem, {}, {}).estimate;
  }

  CalibrationModel model_{ParameterSpace(scenarios::paperNominal(), withMotionEffects({}))};
  MovingRotor moving_;
  std::vector<Eigen::Index> free_;
};

/// How far an estimate is from another one, in standard deviations of that.
struct Distance {
  Distance(const ParameterBelief& one, const ParameterBelief& other) {
    const Eigen::ArrayXd stddevs = other.covariance.diagonal().array().sqrt();
    const Eigen::ArrayXd apart = (one.x - other.x).array() / stddevs;
    const Eigen::ArrayXd ratios = one.covariance.diagonal().array().sqrt() / stddevs;
    worst = apart.abs().maxCoeff();
    rms = std::sqrt(apart.square().mean());
    least_ratio = ratios.minCoeff();
    largest_ratio = ratios.maxCoeff();
  }
  double worst;
  double rms;
  double least_ratio;  ///< of standard deviations
  double largest_ratio;
};

TEST_F(LiveMotionTest, AgreesWithTheEstimateOfAllWindowsAtOnce) {
  LiveMotion live = this->live();
  MotionRecording taken;
  follow(noisy(moving_.record()), live, taken);
  const LiveEstimate& found = live.estimate();
  ASSERT_TRUE(found.is_told);
  EXPECT_GE(found.windows, 56U);
  EXPECT_EQ(found.left_out, 0U);
  EXPECT_NEAR(found.chi_square, 1.0, 0.15);
  const Distance distance(found.belief, batch(taken).belief);
  EXPECT_LT(distance.worst, 0.1);
  EXPECT_LT(distance.rms, 0.02);
  EXPECT_GT(distance.least_ratio, 0.97);
  EXPECT_LT(distance.largest_ratio, 1.03);
}

TEST_F(LiveMotionTest, ToldTheSameWithoutOldWindows) {
  LiveMotionOptions options;
  options.kept_windows = 30;
  LiveMotion live = this->live(options);
  MotionRecording taken;
  follow(noisy(moving_.record()), live, taken);
  const Distance distance(live.estimate().belief, batch(taken).belief);
  EXPECT_LT(distance.worst, 0.3);
  EXPECT_GT(distance.least_ratio, 0.95);
  EXPECT_LT(distance.largest_ratio, 1.05);
}

TEST_F(LiveMotionTest, LeavesOutWindowsInWhichAHandTouchesTheRotor) {
  const MotionRecording pushed = [&] {
    MovingRotor moving = moving_;
    moving.duration = 10.0;
    moving.push = 3e-3;
    return noisy(moving.record());
  }();
  LiveMotionOptions options;
  // The hand comes before the first estimate, and after it.
  for (const std::size_t first : {24U, 7U}) {
    options.first_windows = first;
    LiveMotion live = this->live(options);
    MotionRecording taken;
    follow(pushed, live, taken);
    const LiveEstimate& found = live.estimate();
    ASSERT_TRUE(found.is_told);
    EXPECT_GE(found.left_out, 1U);
    EXPECT_LE(found.left_out, 3U);
    const Eigen::Index geometry = model_.space().effect();
    const Eigen::VectorXd truth = model_.space().coordinatesOf(moving_.truth);
    const Eigen::ArrayXd apart = (found.belief.x - truth).head(geometry).array() /
                                 found.belief.covariance.diagonal().head(geometry).array().sqrt();
    EXPECT_LT(std::sqrt(apart.square().mean()), 1.6);
  }
}

TEST_F(LiveMotionTest, BeginsAfterAFixtureHasTurnedTheRotor) {
  LiveMotion live = this->live();
  std::size_t driven = 0;
  for (const MotionStreams& streams : noisy(moving_.record()).spans) {
    for (MotionSlice& slice : slicesOf(streams)) {
      // Not by these currents was it turned.
      constexpr std::size_t kDriven = 20;
      if (driven < kDriven) {
        ++driven;
        StreamCurrents& currents = slice.streams.currents;
        currents = StreamCurrents(currents.matrix().colwise().reverse());
        live.add(std::move(slice));
        EXPECT_FALSE(live.estimate().is_told);
      } else {
        live.add(std::move(slice));
      }
    }
  }
  const LiveEstimate& found = live.estimate();
  ASSERT_TRUE(found.is_told);
  EXPECT_GE(found.left_out, driven / 2);
}

TEST_F(LiveMotionTest, HoldsACoilUntilCurrentFlowsInIt) {
  constexpr std::size_t kCoil = 4;
  moving_.coil_that_is_off = kCoil;
  moving_.off_until = 8.0;
  const MotionRecording recording = noisy(moving_.record());
  const MotionStreams& streams = recording.spans.front();
  const Stamp begin = streams.current_stamps.front();
  const ParameterSpace& space = model_.space();
  const std::vector<Eigen::Index> of_coil{space.coil(kCoil), space.coil(kCoil) + 1};
  const ParameterBelief prior = nominalState(space, {}).belief;
  LiveMotion live = this->live();
  std::size_t held = 0;
  for (MotionSlice& slice : slicesOf(streams)) {
    const double until = secondsBetween(begin, slice.streams.current_stamps.back());
    live.add(std::move(slice));
    const ParameterBelief& belief = live.estimate().belief;
    if (live.estimate().is_told && until < moving_.off_until) {
      ++held;
      for (const Eigen::Index p : of_coil) {
        EXPECT_EQ(belief.x[p], prior.x[p]);
        EXPECT_EQ(belief.covariance(p, p), prior.covariance(p, p));
      }
    }
  }
  EXPECT_GT(held, 3U);
  const ParameterBelief& belief = live.estimate().belief;
  EXPECT_LT(belief.covariance(of_coil[0], of_coil[0]),
            0.01 * prior.covariance(of_coil[0], of_coil[0]));
}

TEST_F(LiveMotionTest, TellsThePriorUntilThereIsEnough) {
  LiveMotion live = this->live();
  moving_.duration = 3.0;
  MotionRecording taken;
  follow(noisy(moving_.record()), live, taken);
  EXPECT_FALSE(live.estimate().is_told);
  EXPECT_EQ(live.estimate().windows, taken.spans.size());
  const ParameterBelief prior = nominalState(model_.space(), {}).belief;
  EXPECT_EQ(live.estimate().belief.x, prior.x);
  EXPECT_EQ(live.estimate().belief.covariance, prior.covariance);
}

// Of windows that come again and again: each counts by its own times.
TEST_F(LiveMotionTest, TakesNoMoreMemoryTheLongerItGoes) {
  moving_.duration = 9.0;
  MotionRecording taken;
  LiveMotion live = this->live();
  follow(noisy(moving_.record()), live, taken);
  std::size_t next = 0;
  const auto pass = [&](std::size_t windows) {
    for (std::size_t n = 0; n < windows; ++n, ++next) {
      const std::size_t place = next % taken.spans.size();
      live.add({taken.spans[place], taken.windows[place]});
    }
  };
  pass(400);
  // What a look at the noise takes for a while is the same for ever; 800 windows are 50 MB.
  EXPECT_LT(peakBeside([&] { pass(800); }), 12e6);
  EXPECT_EQ(live.estimate().windows, taken.spans.size() + 1200);
  EXPECT_GT(live.estimate().duration, 300.0);
}

}  // namespace
}  // namespace sac
