#include "window_balance.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "spherical_actuator_calibration/estimation/calibration_state.hpp"
#include "support/moving_rotor.hpp"
#include "support/numeric_jacobian.hpp"

namespace sac {
namespace {

/// Every coordinate somewhere near zero.
Eigen::VectorXd somewhere(const ParameterSpace& space) {
  Eigen::VectorXd x(space.size());
  for (Eigen::Index p = 0; p < x.size(); ++p) {
    x[p] = 0.01 * std::sin(1.0 + 1.7 * static_cast<double>(p));
  }
  return x;
}

class WindowBalanceTest : public ::testing::Test {
 protected:
  WindowBalanceTest() {
    rotor_.duration = 1.0;
    recording_ = rotor_.record();
    spans_.emplace_back(recording_.spans.front());
    windows_ = cutWindows(spans_, options_, left_out_);
  }

  static CalibrationModel model(const std::vector<std::string>& effects) {
    EffectSelection selection;
    for (const std::string& effect : effects) {
      selection[effect] = true;
    }
    return CalibrationModel(
        ParameterSpace(scenarios::paperNominal(), withMotionEffects(selection)));
  }

  MovingRotor rotor_;
  MotionRecording recording_;
  std::vector<MotionSpan> spans_;
  MotionOptions options_;
  std::vector<WindowsLeftOut> left_out_;
  std::vector<MotionWindow> windows_;
};

TEST_F(WindowBalanceTest, HasTheJacobianOfItsResidual) {
  const CalibrationModel model =
      WindowBalanceTest::model({"pole_gains", "coil_gains", "encoder_harmonics", "torque_curve"});
  const MotionPlaces places(model.space());
  BalanceEvaluator evaluator(options_, Eigen::Vector3d::Constant(1e-5));
  WindowBalance balance;
  const auto residual = [&](const Eigen::VectorXd& x) -> Eigen::VectorXd {
    evaluator.evaluate(spans_[0], windows_[1], MotionPoint(model, places, x), {}, balance);
    return balance.residual;
  };
  const Eigen::VectorXd x = somewhere(model.space());
  const Eigen::MatrixXd numeric = numericJacobian(residual, x);
  residual(x);
  for (Eigen::Index p = 0; p < x.size(); ++p) {
    // Numeric steps take pairs over the ends of the torque curve's parts, where its second
    // derivative jumps; those of the delay take currents over readings.
    const double tolerance = p == places.current_delay ? 5e-3 : 1e-3;
    EXPECT_LT((balance.jacobian.col(p) - numeric.col(p)).norm(),
              tolerance * (numeric.col(p).norm() + 1e-6))
        << model.space().name(p);
  }
}

TEST_F(WindowBalanceTest, IsTheSameByEvaluatorsThatShareTheWindow) {
  const CalibrationModel model = WindowBalanceTest::model({"coil_gains"});
  const MotionPlaces places(model.space());
  const MotionPoint point(model, places, somewhere(model.space()));
  BalanceEvaluator one(options_, Eigen::Vector3d::Constant(1e-5));
  std::vector<BalanceEvaluator> several(3, one);
  for (const BalanceOrder& order : {BalanceOrder{true, 1}, BalanceOrder{false, 4}}) {
    WindowBalance expected;
    one.evaluate(spans_[0], windows_[1], point, order, expected);
    for (std::size_t n = 0; n < several.size(); ++n) {
      several[n].sumUp(spans_[0], windows_[1], point, order, {n, several.size()});
    }
    several[0].add(several[1]);
    several[0].add(several[2]);
    WindowBalance shared;
    several[0].conclude(point, shared);
    EXPECT_TRUE(shared.residual.isApprox(expected.residual, 1e-9));
    EXPECT_TRUE(shared.jacobian.isApprox(expected.jacobian, 1e-12));
    if (order.covariance) {
      EXPECT_TRUE(shared.by_joints.isApprox(expected.by_joints, 1e-12));
      EXPECT_TRUE(shared.by_currents.isApprox(expected.by_currents, 1e-12));
    }
  }
}

// Currents may do anything between nodes; the torque of each is smooth.
TEST_F(WindowBalanceTest, AtNodesIsThatOfAllCurrents) {
  const CalibrationModel model = WindowBalanceTest::model({});
  const MotionPoint point(model, MotionPlaces(model.space()), somewhere(model.space()));
  std::mt19937_64 generator(2);
  std::normal_distribution<double> normal;
  auto currents = recording_.spans.front().currents.matrix();
  for (Eigen::Index n = 0; n < currents.size(); ++n) {
    currents.data()[n] += static_cast<float>(0.02 * normal(generator));
  }
  BalanceEvaluator evaluator(options_, Eigen::Vector3d::Constant(1e-5));
  for (const MotionWindow& window : windows_) {
    WindowBalance all;
    WindowBalance nodes;
    evaluator.evaluate(spans_[0], window, point, {true, 1, false}, all);
    evaluator.evaluate(spans_[0], window, point, {true, 1, true}, nodes);
    // Of currents that are as exact as readings of joints.
    const Eigen::LLT<Eigen::MatrixXd> factor(all.by_joints + 1e-6 * all.by_currents);
    EXPECT_LT(factor.matrixL().solve(nodes.residual - all.residual).cwiseAbs().maxCoeff(), 0.05);
    EXPECT_TRUE(nodes.jacobian.isApprox(all.jacobian, 1e-3));
    EXPECT_TRUE(nodes.by_currents.isApprox(all.by_currents, 1e-3));
    EXPECT_TRUE(nodes.by_joints.isApprox(all.by_joints, 0.15));
  }
}

// As where a delay that is being looked for has gone astray.
TEST_F(WindowBalanceTest, AtNodesTakesNoCurrentsWhereNoneAre) {
  const CalibrationModel model = WindowBalanceTest::model({});
  const MotionPlaces places(model.space());
  Eigen::VectorXd x = Eigen::VectorXd::Zero(model.space().size());
  BalanceEvaluator evaluator(options_, Eigen::Vector3d::Constant(1e-5));
  for (const double delay : {-50.0, 50.0}) {
    x[places.current_delay] =
        delay / model.space().effects().scale(places.current_delay - model.space().effect());
    WindowBalance all;
    WindowBalance nodes;
    const MotionPoint point(model, places, x);
    evaluator.evaluate(spans_[0], windows_[1], point, {false, 1, false}, all);
    evaluator.evaluate(spans_[0], windows_[1], point, {false, 1, true}, nodes);
    EXPECT_EQ(nodes.residual, all.residual);
  }
}

TEST_F(WindowBalanceTest, IsZeroForTheRotorThatMoved) {
  const CalibrationModel model = WindowBalanceTest::model({});
  const MotionPlaces places(model.space());
  Eigen::VectorXd x = Eigen::VectorXd::Zero(model.space().size());
  x[places.current_delay] =
      -0.5e-3 / model.space().effects().scale(places.current_delay - model.space().effect());
  BalanceEvaluator evaluator(options_, Eigen::Vector3d::Constant(1e-5));
  WindowBalance balance;
  WindowBalance still;
  for (const MotionWindow& window : windows_) {
    evaluator.evaluate(spans_[0], window, MotionPoint(model, places, x), {}, balance);
    // Beside what an inertia that is larger by half would leave.
    x[places.inertia] += 0.35;
    x[places.inertia + 1] += 0.35;
    evaluator.evaluate(spans_[0], window, MotionPoint(model, places, x), {}, still);
    x[places.inertia] -= 0.35;
    x[places.inertia + 1] -= 0.35;
    EXPECT_LT(balance.residual.norm(), 0.02 * still.residual.norm());
  }
}

TEST_F(WindowBalanceTest, CoversThreeSquareNoisesByItsCovariance) {
  const CalibrationModel model = WindowBalanceTest::model({});
  const MotionPlaces places(model.space());
  const Eigen::VectorXd x = Eigen::VectorXd::Zero(model.space().size());
  const MotionPoint point(model, places, x);
  constexpr double kJoints = 2e-5;
  constexpr double kCurrents = 2e-3;
  BalanceEvaluator evaluator(options_, Eigen::Vector3d::Constant(kJoints));
  for (const bool at_nodes : {false, true}) {
    WindowBalance exact;
    evaluator.evaluate(spans_[0], windows_[1], point, {true, 1, at_nodes}, exact);
    const Eigen::MatrixXd covariance = exact.by_joints + kCurrents * kCurrents * exact.by_currents;
    const Eigen::LLT<Eigen::MatrixXd> factor(covariance);
    std::mt19937_64 generator(5);
    std::normal_distribution<double> normal;
    double squares = 0.0;
    constexpr int kTrials = 60;
    for (int trial = 0; trial < kTrials; ++trial) {
      MotionStreams noisy = recording_.spans.front();
      for (Eigen::Vector3d& reading : noisy.joints) {
        reading +=
            kJoints * Eigen::Vector3d(normal(generator), normal(generator), normal(generator));
      }
      auto currents = noisy.currents.matrix();
      for (Eigen::Index n = 0; n < currents.size(); ++n) {
        currents.data()[n] += static_cast<float>(kCurrents * normal(generator));
      }
      WindowBalance balance;
      evaluator.evaluate(MotionSpan(noisy), windows_[1], point, {false, 1, at_nodes}, balance);
      squares += factor.matrixL().solve(balance.residual - exact.residual).squaredNorm();
    }
    // χ² with 60 × 18 degrees of freedom: within 4 of its standard deviations.
    const double freedom = kTrials * static_cast<double>(exact.residual.size());
    EXPECT_NEAR(squares / freedom, 1.0, 4.0 * std::sqrt(2.0 / freedom)) << at_nodes;
  }
}

// Beside the largest delay of the currents at both ends, nothing is lost.
TEST_F(WindowBalanceTest, WindowsFillWhatHasCurrents) {
  ASSERT_EQ(windows_.size(), 3U);
  EXPECT_TRUE(left_out_.empty());
  const JointTrack& track = spans_[0].track;
  const StampTimes& currents = spans_[0].current_times;
  const double step = track.step();
  EXPECT_NEAR(track.time(windows_.front().first), currents.front() + options_.largest_delay, step);
  EXPECT_NEAR(track.time(windows_.back().last), currents.back() - options_.largest_delay, step);
  for (std::size_t n = 0; n + 1 < windows_.size(); ++n) {
    EXPECT_EQ(windows_[n].last, windows_[n + 1].first);
  }
}

TEST_F(WindowBalanceTest, WindowsWithoutCurrentsAreCounted) {
  MotionStreams late = recording_.spans.front();
  constexpr Eigen::Index kMissing = 600;
  const LongSeries<Stamp> stamps = late.current_stamps;
  late.current_stamps = {stamps.begin() + kMissing, stamps.end()};
  late.currents =
      StreamCurrents(late.currents.matrix().bottomRows(late.currents.rows() - kMissing));
  std::vector<WindowsLeftOut> left_out;
  const std::vector<MotionWindow> windows = cutWindows({MotionSpan(late)}, options_, left_out);
  EXPECT_EQ(windows.size(), 1U);
  ASSERT_EQ(left_out.size(), 1U);
  EXPECT_EQ(left_out[0].reason, "currents are missing");
  EXPECT_EQ(left_out[0].count, 2U);
}

TEST_F(WindowBalanceTest, WindowsOfFewCurrentsAreCounted) {
  const MotionStreams& all = recording_.spans.front();
  for (const std::size_t every : {20U, 30U}) {  // 50 and 33 Hz
    MotionStreams some = all;
    some.current_stamps.clear();
    some.currents = {};
    for (std::size_t n = 0; n < all.current_stamps.size(); n += every) {
      some.currents.addRow(all.currents.row(static_cast<Eigen::Index>(n)));
      some.current_stamps.push_back(all.current_stamps[n]);
    }
    std::vector<WindowsLeftOut> left_out;
    const std::vector<MotionWindow> windows = cutWindows({MotionSpan(some)}, options_, left_out);
    const bool is_refused = !left_out.empty() && left_out[0].reason.rfind("fewer than ten", 0) == 0;
    EXPECT_EQ(is_refused, every == 30U);
    EXPECT_EQ(windows.empty(), every == 30U);
  }
}

/// A rotor at a tilt whose joints 1 and 3 turn steadily, without currents.
MotionRecording steadyMotion(const Eigen::Vector3d& begin, const Eigen::Vector3d& rates) {
  MotionRecorder recorder(scenarios::paperNominal().coils.size());
  for (int n = 0; n < 500; ++n) {
    const double t = 1e-3 * n;
    const auto stamp = static_cast<Stamp>(std::llround((t + 10.0) * 1e9));
    recorder.add(JointMeasurement{stamp, begin + t * rates});
    recorder.add(CurrentMeasurement{stamp, Eigen::VectorXd::Zero(24)});
  }
  return recorder.take();
}

// The rates of the joints are not its components: at a tilt their axes are not at right angles.
TEST(DryFriction, IsThatOfTheRotorsSpeed) {
  const Eigen::Vector3d begin(0.1, 0.6, -0.4);
  const Eigen::Vector3d rates(1.5, 0.0, 1.5);
  const MotionRecording recording = steadyMotion(begin, rates);
  const MotionSpan span(recording.spans.front());
  const CalibrationModel model(ParameterSpace(scenarios::paperNominal(), withMotionEffects({})));
  const MotionPoint point(
      model, MotionPlaces(model.space()), Eigen::VectorXd::Zero(model.space().size()));
  const MotionOptions options;
  BalanceEvaluator evaluator(options, Eigen::Vector3d::Constant(1e-5));
  WindowBalance balance;
  const MotionWindow window{0, 100, 350};
  evaluator.evaluate(span, window, point, {}, balance);
  const TestFunctions functions(0.1, 0.35, options.test_functions);
  TestFunctionValues values;
  const auto orientation = [&](double t) {
    return rotorOrientation(JointGeometry(), begin + t * rates);
  };
  Eigen::VectorXd expected = Eigen::VectorXd::Zero(balance.residual.size());
  constexpr double kStep = 1e-3;
  for (double t = 0.1 + 0.5 * kStep; t < 0.35; t += kStep) {
    functions.evaluate(t, values);
    const Eigen::Vector3d rate =
        rotationLog(orientation(t + 1e-4) * orientation(t - 1e-4).transpose()) / 2e-4;
    for (Eigen::Index k = 0; k < functions.count(); ++k) {
      expected.segment<3>(3 * k) +=
          kStep * values.value[k] / std::hypot(rate.norm(), options.friction_speed) * rate;
    }
  }
  const Eigen::Index place = point.places().coulomb;
  EXPECT_LT((balance.jacobian.col(place) / point.scaleAt(place) - expected).norm(),
            1e-3 * expected.norm());
}

}  // namespace
}  // namespace sac
