#pragma once

#include <vector>

#include <Eigen/Core>

#include "motion_point.hpp"
#include "motion_span.hpp"
#include "test_functions.hpp"

namespace sac {

/// Momentum balance of a window: 3K residuals, test function by test function, stator frame.
struct WindowBalance {
  Eigen::VectorXd residual;     ///< M − P [N·m·s]
  Eigen::MatrixXd jacobian;     ///< by all coordinates
  Eigen::MatrixXd by_joints;    ///< covariance from readings with the stated noise
  Eigen::MatrixXd by_currents;  ///< covariance from currents with a noise of 1 A
};

/// What of it is wanted, and how fine.
struct BalanceOrder {
  bool covariance = false;
  /// Of so many currents one serves: quick and coarse.
  std::size_t stride = 1;
};

/// Evaluates windows of one recording (doc/motion.md). Storage is reused from window to window.
class BalanceEvaluator {
 public:
  BalanceEvaluator(const MotionOptions& options, const Eigen::Vector3d& joint_stddev)
      : options_(options), joint_stddev_(joint_stddev) {}

  void evaluate(const MotionSpan& span,
                const MotionWindow& window,
                const MotionPoint& point,
                const BalanceOrder& order,
                WindowBalance& out);

 private:
  /// 1/√(ω² + v²) of dry friction.
  struct Fading {
    double value = 0.0;      ///< [s/rad]
    Eigen::RowVectorXd d_x;  ///< by MotionPoint::turning()
  };

  void start(const MotionSpan& span, const MotionWindow& window, const MotionPoint& point);
  void addMomentum(const MotionSpan& span, const MotionPoint& point, WindowBalance& out);
  void addInterval(const MotionSpan& span,
                   const MotionPoint& point,
                   std::size_t place,
                   WindowBalance& out);
  void addImpulse(const MotionSpan& span,
                  const MotionPoint& point,
                  const BalanceOrder& order,
                  WindowBalance& out);
  void addCurrents(const TrackPoint& track,
                   const MotionPoint& point,
                   double step,
                   const BalanceOrder& order,
                   WindowBalance& out);
  Fading fadingAt(const JointTrack& track, std::size_t place) const;
  Eigen::VectorXd momentumFactors(std::size_t place, double h) const;
  void addNoise(const TrackPoint& track,
                double step,
                const BalanceOrder& order,
                WindowBalance& out);
  void flush();
  void finish(const MotionPoint& point, const BalanceOrder& order, WindowBalance& out);

  const MotionOptions& options_;
  Eigen::Vector3d joint_stddev_;

  MotionWindow window_;
  bool wants_noise_ = false;
  Eigen::Index count_ = 0;                  ///< of test functions
  std::vector<TurnedRotor> turned_;         ///< at the readings, one more on either side
  std::vector<TestFunctionValues> middle_;  ///< between them
  TurnedRotor between_;
  TestFunctionValues test_;
  StatorTorque torque_;
  Eigen::VectorXd current_;
  Eigen::VectorXd bend_;     ///< second derivative of the currents [A/s²]
  Eigen::MatrixXd sum_;      ///< 3P × K: the Jacobian, a column for each test function
  Eigen::MatrixXd batch_;    ///< 3P × B: of single currents, not yet in the sum
  Eigen::MatrixXd factors_;  ///< B × K
  Eigen::Index batched_ = 0;
  std::vector<Eigen::MatrixXd> noise_;  ///< per reading: ∂residual/∂reading, 3K × 3
};

}  // namespace sac
