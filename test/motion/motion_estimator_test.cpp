#include "spherical_actuator_calibration/motion/motion_estimator.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "spherical_actuator_calibration/estimation/calibration_state.hpp"
#include "support/moving_rotor.hpp"

namespace sac {
namespace {

MotionEstimate estimated(const CalibrationModel& model,
                         const MotionRecording& recording,
                         const MotionOptions& options = {},
                         const EstimationOptions& estimation = {}) {
  MotionProblem problem;
  problem.model = &model;
  problem.recording = &recording;
  problem.prior = nominalState(model.space(), {}).belief;
  problem.free.resize(static_cast<std::size_t>(model.space().size()));
  std::iota(problem.free.begin(), problem.free.end(), 0);
  return estimateMotion(problem, estimation, options);
}

/// By short windows, of so many of which derivatives are kept.
MotionEstimate estimatedKeeping(std::size_t windows,
                                const CalibrationModel& model,
                                const MotionRecording& recording) {
  MotionOptions options;
  options.window = 0.1;
  options.most_kept_windows = windows;
  return estimated(model, recording, options);
}

CalibrationModel motionModel() {
  return CalibrationModel(ParameterSpace(scenarios::paperNominal(), withMotionEffects({})));
}

/// A unit with errors, and what else moves it.
MovingRotor madeRotor() {
  scenarios::Generator generator(3);
  MovingRotor moving;
  moving.truth = scenarios::perturbed(scenarios::paperNominal(), 0.02, 0.02, generator);
  moving.rotor.inertia(0, 0) *= 1.1;
  moving.rotor.inertia(0, 1) = moving.rotor.inertia(1, 0) = 2e-5;
  moving.rotor.unbalance = Eigen::Vector3d(1e-3, -5e-4, 2e-3);
  return moving;
}

double valueOf(const CalibrationModel& model, const MotionEstimate& found, const char* name) {
  const ParameterSpace& space = model.space();
  const Eigen::VectorXd values = space.reportedValues(found.estimate.belief.x);
  for (Eigen::Index p = 0; p < space.size(); ++p) {
    if (space.name(p) == name) {
      return values[p];
    }
  }
  ADD_FAILURE() << name;
  return 0.0;
}

/// Windows that serve, or are left out with a reason.
std::size_t accountedFor(const MotionSummary& summary) {
  std::size_t count = summary.used;
  for (const WindowsLeftOut& left_out : summary.left_out) {
    count += left_out.count;
  }
  return count;
}

// Delayed as it is, its misfit changes from one orientation to the next before the delay is known.
TEST(MotionEstimator, TellsTheNoiseOfASlowTracker) {
  constexpr std::size_t kEvery = 5;  // 50 Hz
  MovingRotor moving = madeRotor();
  moving.duration = 15.0;
  moving.tracker_delay = 40e-3;
  MotionRecording recording = noisy(moving.record());
  MotionStreams& streams = recording.spans.front();
  const LongSeries<Stamp> stamps = std::exchange(streams.orientation_stamps, {});
  const LongSeries<Eigen::Quaterniond> all = std::exchange(streams.orientations, {});
  for (std::size_t n = 0; n < stamps.size(); n += kEvery) {
    streams.orientation_stamps.push_back(stamps[n]);
    streams.orientations.push_back(all[n]);
  }
  const MotionEstimate found = estimated(motionModel(), recording);
  ASSERT_EQ(found.estimate.termination, Termination::kConverged);
  EXPECT_NEAR(found.summary.orientation_stddev, 5e-4, 1e-4);
  EXPECT_NEAR(found.summary.orientation_chi_square, 1.0, 0.4);
}

TEST(MotionEstimator, FindsTheUnitThatMoved) {
  MovingRotor moving = madeRotor();
  moving.current_delay = 0.03;
  moving.tracker_delay = -0.02;
  const CalibrationModel model = motionModel();
  const MotionEstimate found = estimated(model, moving.record());
  ASSERT_EQ(found.estimate.termination, Termination::kConverged);
  EXPECT_TRUE(found.estimate.unobservable.empty());
  const ParameterSpace& space = model.space();
  const Eigen::VectorXd truth = space.coordinatesOf(moving.truth);
  const Eigen::Index geometry = space.effect();
  EXPECT_LT((found.estimate.belief.x - truth).head(geometry).cwiseAbs().maxCoeff(), 1e-4);
  EXPECT_NEAR(valueOf(model, found, "rotor_inertia/xx"), moving.rotor.inertia(0, 0), 1e-6);
  EXPECT_NEAR(valueOf(model, found, "rotor_inertia/xy"), 2e-5, 1e-6);
  EXPECT_NEAR(valueOf(model, found, "rotor_unbalance/z"), 2e-3, 2e-5);
  EXPECT_NEAR(valueOf(model, found, "current_delay"), 0.0295, 2e-5);
  EXPECT_NEAR(valueOf(model, found, "tracker_delay"), -0.02, 2e-5);
}

TEST(MotionEstimator, LeavesOutWindowsInWhichAHandTouchesTheRotor) {
  MovingRotor moving = madeRotor();
  moving.push = 5e-3;
  const CalibrationModel model = motionModel();
  const MotionEstimate found = estimated(model, noisy(moving.record()));
  ASSERT_EQ(found.estimate.termination, Termination::kConverged);
  std::size_t rejected = 0;
  for (const WindowsLeftOut& left_out : found.summary.left_out) {
    rejected += left_out.reason.find("something else") != std::string::npos ? left_out.count : 0;
  }
  EXPECT_GE(rejected, 2U);
  EXPECT_LE(rejected, 3U);
  const ParameterSpace& space = model.space();
  const Eigen::VectorXd apart = found.estimate.belief.x - space.coordinatesOf(moving.truth);
  EXPECT_LT(apart.head(space.effect()).cwiseAbs().maxCoeff(), 5e-4);
}

std::size_t leftOutFor(const MotionSummary& summary, const char* reason) {
  std::size_t count = 0;
  for (const WindowsLeftOut& left_out : summary.left_out) {
    count += left_out.reason.find(reason) != std::string::npos ? left_out.count : 0;
  }
  return count;
}

// A torque that no window shows alone would go into the parameters.
TEST(MotionEstimator, LeavesOutWindowsInWhichAHandLeansOnTheRotor) {
  MovingRotor moving = madeRotor();
  moving.duration = 14.0;
  const CalibrationModel model = motionModel();
  const MotionEstimate free = estimated(model, noisy(moving.record()));
  EXPECT_EQ(free.summary.used, free.summary.windows);
  moving.push = 3e-4;
  moving.push_begin = 4.0;
  moving.push_end = 10.0;
  const MotionEstimate found = estimated(model, noisy(moving.record()));
  ASSERT_EQ(found.estimate.termination, Termination::kConverged);
  EXPECT_GT(leftOutFor(found.summary, "steadily"), 0U);
  EXPECT_GE(found.summary.windows - found.summary.used, 20U);
  EXPECT_LE(found.summary.windows - found.summary.used, 30U);
  EXPECT_EQ(accountedFor(found.summary), found.summary.windows);
  const ParameterSpace& space = model.space();
  const Eigen::ArrayXd apart = found.estimate.belief.x - space.coordinatesOf(moving.truth);
  const Eigen::ArrayXd stddevs = found.estimate.belief.covariance.diagonal().array().sqrt();
  EXPECT_LT((apart / stddevs).head(space.effect()).square().mean(), 2.0);
}

// Those that nothing held would be left out as well: what most windows say decides.
TEST(MotionEstimator, LeavesNothingOutWhereAHandLeansMostOfTheTime) {
  MovingRotor moving = madeRotor();
  moving.duration = 14.0;
  moving.push = 3e-4;
  moving.push_begin = 3.0;
  moving.push_end = 12.5;
  const MotionEstimate found = estimated(motionModel(), noisy(moving.record()));
  ASSERT_EQ(found.estimate.termination, Termination::kConverged);
  EXPECT_EQ(leftOutFor(found.summary, "steadily"), 0U);
  EXPECT_LT(found.summary.held_out.probability, 0.01);
}

TEST(MotionEstimator, LeavesThemOutOfALongRecordingToo) {
  MovingRotor moving = madeRotor();
  moving.duration = 14.0;
  moving.push = 3e-4;
  moving.push_begin = 4.0;
  moving.push_end = 10.0;
  const MotionRecording recording = noisy(moving.record());
  const CalibrationModel model = motionModel();
  const MotionEstimate all = estimatedKeeping(1000, model, recording);
  const MotionEstimate few = estimatedKeeping(100, model, recording);
  EXPECT_GT(leftOutFor(all.summary, "steadily"), 0U);
  EXPECT_EQ(leftOutFor(few.summary, "steadily"), leftOutFor(all.summary, "steadily"));
  EXPECT_EQ(few.summary.used, all.summary.used);
}

// Sums in place of derivatives, as of a long recording.
TEST(MotionEstimator, TellsTheSameWithFewDerivativesKept) {
  MovingRotor moving = madeRotor();
  moving.duration = 14.0;
  moving.push = 5e-3;
  const MotionRecording recording = noisy(moving.record());
  const CalibrationModel model = motionModel();
  const MotionEstimate all = estimatedKeeping(1000, model, recording);
  const MotionEstimate few = estimatedKeeping(100, model, recording);
  ASSERT_EQ(few.estimate.termination, Termination::kConverged);
  EXPECT_GT(all.summary.windows, 130U);
  const Eigen::ArrayXd stddevs = all.estimate.belief.covariance.diagonal().array().sqrt();
  const Eigen::ArrayXd apart = (few.estimate.belief.x - all.estimate.belief.x).array() / stddevs;
  EXPECT_LT(apart.abs().maxCoeff(), 0.02);
  const Eigen::ArrayXd ratios = few.estimate.belief.covariance.diagonal().array().sqrt() / stddevs;
  EXPECT_LT((ratios - 1.0).abs().maxCoeff(), 2e-3);
  EXPECT_LT(all.summary.used, all.summary.windows);  // a hand touched the rotor
  EXPECT_EQ(few.summary.used, all.summary.used);
  EXPECT_EQ(few.summary.orientations, all.summary.orientations);
  EXPECT_EQ(few.summary.held_out.windows, all.summary.held_out.windows);
  EXPECT_NEAR(few.summary.held_out.reduced_chi_square,
              all.summary.held_out.reduced_chi_square,
              2e-3 * all.summary.held_out.reduced_chi_square);
  EXPECT_NEAR(few.summary.window_chi_square, all.summary.window_chi_square, 2e-3);
  ASSERT_EQ(few.estimate.residuals.size(), all.estimate.residuals.size());
  for (std::size_t n = 0; n < all.estimate.residuals.size(); ++n) {
    EXPECT_NEAR(
        few.estimate.residuals[n].standardized, all.estimate.residuals[n].standardized, 0.02);
    EXPECT_EQ(few.estimate.residuals[n].rejected, all.estimate.residuals[n].rejected);
  }
}

TEST(MotionEstimator, HoldsOutEveryTenthWindowOfALongRecording) {
  MovingRotor moving = madeRotor();
  moving.duration = 10.6;
  const CalibrationModel model = motionModel();
  const MotionEstimate found = estimated(model, moving.record());
  ASSERT_EQ(found.estimate.termination, Termination::kConverged);
  const MotionSummary& summary = found.summary;
  ASSERT_GE(summary.windows, 40U);
  const HeldOutMotion& held_out = summary.held_out;
  EXPECT_EQ(held_out.windows + held_out.rejected, (summary.windows + 4) / 10);
  EXPECT_EQ(held_out.residuals.size(), held_out.windows);
  EXPECT_EQ(accountedFor(summary), summary.windows);
  // 250 of them a second.
  EXPECT_NEAR(static_cast<double>(held_out.orientations),
              62.5 * static_cast<double>(held_out.windows + held_out.rejected),
              10.0);
  for (const ObservationResidual& residual : held_out.residuals) {
    EXPECT_EQ(residual.observation.sample % 10, 5U);
  }
}

// Once they have judged, windows that were held out tell as much as all others.
TEST(MotionEstimator, UsesInTheEndWhatWasHeldOut) {
  MovingRotor moving = madeRotor();
  moving.duration = 10.6;
  const CalibrationModel model = motionModel();
  const MotionRecording recording = noisy(moving.record());
  const MotionEstimate found = estimated(model, recording);
  ASSERT_GT(found.summary.held_out.windows, 0U);
  EXPECT_EQ(found.estimate.residuals.size(), found.summary.windows);
  MotionOptions options;
  options.hold_out_every = 0;
  const MotionEstimate at_once = estimated(model, recording, options);
  EXPECT_EQ(found.summary.used, at_once.summary.used);
  EXPECT_EQ(found.summary.orientations, at_once.summary.orientations);
  const ParameterBelief& belief = found.estimate.belief;
  const ParameterBelief& other = at_once.estimate.belief;
  const Eigen::ArrayXd stddevs = other.covariance.diagonal().array().sqrt();
  EXPECT_LT((belief.covariance.diagonal().array().sqrt() / stddevs - 1.0).abs().maxCoeff(), 0.02);
  EXPECT_LT(((belief.x - other.x).array() / stddevs).abs().maxCoeff(), 0.1);
}

// Windows are cut, some of them held out, and none is looked at.
TEST(MotionEstimator, RefusesFewResidualsOfManyWindows) {
  MotionOptions options;
  options.test_functions = 1;
  options.least_windows_to_hold_out = 2;
  const CalibrationModel model = motionModel();
  const MotionEstimate found = estimated(model, madeRotor().record(), options);
  EXPECT_EQ(found.estimate.termination, Termination::kTooFewObservations);
  EXPECT_EQ(found.summary.held_out.windows, 0U);
}

TEST(MotionEstimator, HoldsOutNothingOfAShortRecording) {
  const CalibrationModel model = motionModel();
  const MotionEstimate found = estimated(model, madeRotor().record());
  EXPECT_LT(found.summary.windows, 40U);
  EXPECT_EQ(found.summary.held_out.windows, 0U);
  EXPECT_EQ(accountedFor(found.summary), found.summary.windows);
}

// Between dwells a fixture turns the rotor, and no coil carries current.
TEST(MotionEstimator, LeavesOutWindowsWithoutCurrent) {
  MotionRecording recording = noisy(madeRotor().record());
  MotionStreams& streams = recording.spans.front();
  streams.currents.matrix().middleRows(2000, 1000).setZero();
  const CalibrationModel model = motionModel();
  const MotionEstimate found = estimated(model, recording);
  ASSERT_EQ(found.estimate.termination, Termination::kConverged);
  const std::vector<WindowsLeftOut>& left_out = found.summary.left_out;
  EXPECT_TRUE(std::any_of(left_out.begin(), left_out.end(), [](const WindowsLeftOut& one) {
    return one.reason == "no coil carries current" && one.count >= 3 && one.count <= 4;
  }));
  EXPECT_EQ(accountedFor(found.summary), found.summary.windows);
}

TEST(MotionEstimator, CutsWindowsAroundHoles) {
  MotionRecording recording = madeRotor().record();
  MotionStreams& streams = recording.spans.front();
  constexpr std::size_t kFirst = 2600;
  constexpr std::size_t kLost = 50;
  for (std::size_t n = kFirst; n + kLost < streams.joints.size(); ++n) {
    streams.joints[n] = streams.joints[n + kLost];
    streams.joint_stamps[n] = streams.joint_stamps[n + kLost];
  }
  streams.joints.truncate(streams.joints.size() - kLost);
  streams.joint_stamps.truncate(streams.joints.size());
  const CalibrationModel model = motionModel();
  const MotionEstimate found = estimated(model, recording);
  ASSERT_EQ(found.estimate.termination, Termination::kConverged);
  const std::vector<WindowsLeftOut>& left_out = found.summary.left_out;
  EXPECT_TRUE(std::any_of(left_out.begin(), left_out.end(), [](const WindowsLeftOut& one) {
    return one.reason == "joint readings are missing" && one.count == 1;
  }));
  EXPECT_LE(found.estimate.reduced_chi_square, 2.0);
}

/// A recording in which one message in twenty got lost, two or three in a row now and then.
/// joints: every so manieth reading of what was recorded at a kilohertz.
MotionRecording lossy(MotionRecording recording, std::size_t joints) {
  scenarios::Generator generator(11);
  std::uniform_real_distribution<double> chance;
  MotionRecorder recorder(24);
  for (const MotionStreams& streams : recording.spans) {
    const auto arrives = [&] { return chance(generator) >= 0.05; };
    for (std::size_t n = 0, o = 0; n < streams.joint_stamps.size(); ++n) {
      if (n % joints == 0 && arrives()) {
        recorder.add(JointMeasurement{streams.joint_stamps[n], streams.joints[n]});
      }
      if (arrives()) {
        const Eigen::VectorXf current = streams.currents.row(static_cast<Eigen::Index>(n));
        recorder.add(CurrentMeasurement{streams.current_stamps[n], current.cast<double>()});
      }
      for (; o < streams.orientation_stamps.size() &&
             streams.orientation_stamps[o] <= streams.joint_stamps[n];
           ++o) {
        if (arrives()) {
          recorder.add(
              OrientationMeasurement{streams.orientation_stamps[o], streams.orientations[o]});
        }
      }
    }
  }
  return recorder.take();
}

// Also at 200 Hz, where a step whose reading got lost is twice as long as its neighbours.
TEST(MotionEstimator, LosesLittleWithMessagesThatGotLost) {
  MovingRotor moving = madeRotor();
  moving.duration = 12.0;
  const CalibrationModel model = motionModel();
  const ParameterSpace& space = model.space();
  for (const std::size_t joints : {1U, 5U}) {
    const MotionEstimate found = estimated(model, lossy(noisy(moving.record()), joints));
    ASSERT_EQ(found.estimate.termination, Termination::kConverged);
    EXPECT_GE(found.summary.windows, 40U);
    EXPECT_LE(4 * (found.summary.windows - found.summary.used), found.summary.windows) << joints;
    EXPECT_LE(found.estimate.reduced_chi_square, 1.15) << joints;
    const Eigen::VectorXd apart = found.estimate.belief.x - space.coordinatesOf(moving.truth);
    const Eigen::VectorXd stddevs = found.estimate.belief.covariance.diagonal().cwiseSqrt();
    EXPECT_LT(apart.cwiseQuotient(stddevs).head(space.effect()).cwiseAbs().maxCoeff(), 5.0);
  }
}

// What is open bends: whoever follows it as if it were straight comes to no end.
TEST(MotionEstimator, WithoutATrackerLeavesTheTurnOfTheStatorOpen) {
  MovingRotor moving = madeRotor();
  moving.has_tracker = false;
  const CalibrationModel model = motionModel();
  const MotionRecording recording = moving.record();
  const Eigen::VectorXd truth = model.space().coordinatesOf(moving.truth);
  for (const double limit : {0.3, 0.05, 0.002}) {
    EstimationOptions options;
    options.unobservable_stddev = limit;
    const Estimate found = estimated(model, recording, {}, options).estimate;
    ASSERT_EQ(found.termination, Termination::kConverged) << limit;
    EXPECT_LE(found.iterations, 30) << limit;  // rounding decides between 12 and 24
    EXPECT_GT(found.open_directions.cols(), 0) << limit;
    // They may be left anywhere, and say so.
    for (Eigen::Index k = 0; k < found.open_directions.cols(); ++k) {
      const Eigen::VectorXd direction = found.open_directions.col(k);
      const double apart = direction.dot(found.belief.x - truth);
      const double variance = direction.dot(found.belief.covariance * direction);
      EXPECT_LT(std::abs(apart), 3.0 * std::sqrt(variance)) << limit;
    }
  }
}

TEST(MotionEstimator, RefusesARecordingThatIsTooShort) {
  MovingRotor moving = madeRotor();
  moving.duration = 0.8;
  const CalibrationModel model = motionModel();
  EXPECT_EQ(estimated(model, moving.record()).estimate.termination,
            Termination::kTooFewObservations);
}

}  // namespace
}  // namespace sac
