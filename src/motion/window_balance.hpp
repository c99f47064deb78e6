#pragma once

#include <vector>

#include <Eigen/Core>

#include "current_readings.hpp"
#include "motion_point.hpp"
#include "motion_span.hpp"
#include "spherical_actuator_calibration/motion/test_functions.hpp"

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
  /// The torque is evaluated at nodes, see NodeCurrents: as good, in less time. Not with a stride.
  bool at_nodes = false;
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

  /// The same by steps, for a window that several evaluators share: each sums up a part of it, one
  /// takes the sums of the others and concludes.
  void sumUp(const MotionSpan& span,
             const MotionWindow& window,
             const MotionPoint& point,
             const BalanceOrder& order,
             const WindowPart& part);
  void add(BalanceEvaluator& other);
  void conclude(const MotionPoint& point, WindowBalance& out);

  /// Where the covariance was asked for: derivatives of the last residual by the readings, each in
  /// units of `joint_stddev`: 3K × 3 for each, with the two before the window and the two behind
  /// it.
  const Eigen::MatrixXd& byReadings() const { return noise_; }

 private:
  /// 1/√(ω² + v²) of dry friction, by the turn between two of the readings.
  struct Fading {
    double value = 0.0;         ///< [s/rad]
    Eigen::RowVector3d d_turn;  ///< by the turn of the rotor at `last`, less that at `first`
    std::size_t first = 0;
    std::size_t last = 0;
  };
  /// Sums over columns times factors, one of each test function: many at once.
  class ColumnSum {
   public:
    void start(Eigen::Index rows, Eigen::Index functions);
    /// The next column, zero where nobody writes, and its factors.
    auto column() { return batch_.col(batched_); }
    auto factors() { return factors_.row(batched_); }
    void next();
    void add(ColumnSum& other) { result() += other.result(); }
    /// A column for each test function.
    Eigen::MatrixXd& result();

   private:
    static constexpr Eigen::Index kBatch = 32;
    void flush();

    Eigen::MatrixXd sum_;
    Eigen::MatrixXd batch_;
    Eigen::MatrixXd factors_;
    Eigen::Index batched_ = 0;
  };

  void start(const MotionSpan& span,
             const MotionWindow& window,
             const MotionPoint& point,
             const WindowPart& part);
  void addInterval(const MotionSpan& span, const MotionPoint& point, std::size_t place);
  void addImpulse(const MotionSpan& span,
                  const MotionPoint& point,
                  const BalanceOrder& order,
                  const WindowPart& part);
  void addNodes(const MotionSpan& span,
                const MotionPoint& point,
                const WindowPart& part,
                std::size_t every);
  void addCurrents(const TrackPoint& track, const MotionPoint& point, double step);
  Fading fadingAt(const JointTrack& track, std::size_t place) const;
  double neighbourShare(std::size_t place, double neighbour) const;
  void setMomentumFactors(std::size_t place);
  void addNoise(const TrackPoint& track, double step);
  void finishNoise(WindowBalance& out);

  const MotionOptions& options_;
  Eigen::Vector3d joint_stddev_;

  MotionWindow window_;
  bool wants_noise_ = false;
  double thinning_ = 1.0;                   ///< readings of the currents for each torque
  Eigen::Index count_ = 0;                  ///< of test functions
  Eigen::Index turning_ = 0;                ///< rows of what turns the rotor
  std::vector<TurnedRotor> turned_;         ///< at the readings, one more on either side
  std::vector<double> lengths_;             ///< of the intervals between them [s]
  std::vector<TestFunctionValues> middle_;  ///< between them
  std::vector<TestFunctionBends> bends_;    ///< there
  TurnedRotor between_;
  TestFunctionValues test_;
  Eigen::VectorXd factor_;
  StatorTorque torque_;
  Eigen::VectorXd current_;
  Eigen::VectorXd bend_;     ///< second derivative of the currents [A/s²]
  ColumnSum momentum_;       ///< by what turns the rotor, inertia, friction; last the residual
  ColumnSum impulse_;        ///< by all coordinates; last the residual
  Eigen::MatrixXd delay_;    ///< 3 × K: by the delay of the currents
  Eigen::MatrixXd noise_;    ///< 3K × 3 per reading: ∂residual/∂reading
  ColumnSum current_noise_;  ///< of each pair of test functions, its 3 × 3 block by columns
};

}  // namespace sac
