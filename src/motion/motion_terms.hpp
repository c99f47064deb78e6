#pragma once

#include <vector>

#include <Eigen/Core>

#include "motion_span.hpp"
#include "spherical_actuator_calibration/estimation/whitened_observation.hpp"
#include "spherical_actuator_calibration/motion/motion_problem.hpp"
#include "stream_noise.hpp"
#include "tracker_term.hpp"
#include "window_balance.hpp"

namespace sac {

/// One window in the estimation.
struct WindowTerm {
  MotionWindow window;
  WindowBalance balance;  ///< where it was linearised last
  Eigen::MatrixXd whitening;
  Eigen::VectorXd residual;  ///< whitened
  double square = 0.0;       ///< squared whitened residual, over the number of residuals
  bool active = true;
  bool held_out = false;  ///< judges, and does not serve as long as it does

  bool serves() const { return active && !held_out; }
};

/// One orientation of the tracker.
struct OrientationTerm {
  std::size_t span = 0;
  std::size_t index = 0;
  Eigen::Vector3d linearized = Eigen::Vector3d::Zero();  ///< whitened residual, where it was last
  Eigen::Vector3d residual = Eigen::Vector3d::Zero();    ///< whitened
  double time = 0.0;
  double square = 0.0;  ///< the same
  bool active = true;
  bool is_known = false;  ///< readings are there
  bool held_out = false;
  std::size_t window = 0;  ///< in which it is held out

  bool serves() const { return is_known && active && !held_out; }
};

/// How windows are linearised.
struct TermOrder {
  BalanceOrder balance;
  std::size_t every = 1;     ///< of so many windows one counts
  bool orientations = true;  ///< too
};

/// All that a recording tells at coordinates x. Terms are linearised at one place, which takes
/// time, and then tell of the places around it, as often as weights are looked at anew.
class MotionTerms {
 public:
  /// Keeps references.
  MotionTerms(const MotionProblem& problem, const MotionOptions& options);

  std::size_t windowCount() const { return windows_.size(); }
  /// Of so many windows one is linearised.
  std::size_t every() const { return every_; }
  /// That serve and are linearised; at least 1.
  std::size_t servingWindows() const;
  const std::vector<WindowTerm>& windows() const { return windows_; }
  std::vector<WindowTerm>& windows() { return windows_; }
  const std::vector<OrientationTerm>& orientations() const { return orientations_; }
  std::vector<OrientationTerm>& orientations() { return orientations_; }
  const std::vector<MotionSpan>& spans() const { return spans_; }
  const std::vector<WindowsLeftOut>& leftOut() const { return left_out_; }
  const StreamNoise& noise() const { return noise_; }
  const MotionPlaces& places() const { return places_; }
  /// Residuals of a window.
  Eigen::Index valuesPerWindow() const {
    return 3 * static_cast<Eigen::Index>(options_.test_functions);
  }
  /// Of so many currents one is enough for a coarse evaluation.
  std::size_t coarseStride() const;

  /// Squared scale below which a misfit counts in full, over that of noise alone.
  void setScales(double windows, double orientations);
  /// Factors on the covariances by joints and by currents.
  void setNoiseFactors(double joints, double currents);

  void linearize(const Eigen::VectorXd& x, const TermOrder& order);
  // Of the terms that serve, by the last linearisation and robustly weighted, in all coordinates.
  InformationSum balance(const Eigen::VectorXd& x);
  InformationSum orientation(const Eigen::VectorXd& x);
  /// Of what is held out and active, without robust weights: the windows' balance, and the mean
  /// orientation within each, so that white noise of the tracker does not hide the rest. `values`:
  /// how many residuals.
  InformationSum heldOut(const Eigen::VectorXd& x, std::size_t& values);
  /// Whether anything is.
  bool holdsOut() const;
  /// From now on all that is active serves.
  void admitHeldOut();

 private:
  void holdOut();
  Eigen::MatrixXd whiteningFor(const WindowBalance& balance) const;
  void linearizeWindows(const TermOrder& order);
  void linearizeOrientations();
  void moveOrientations(const Eigen::VectorXd& x);
  auto orientationJacobian(std::size_t n) const {
    return orientation_jacobians_.middleCols<3>(3 * static_cast<Eigen::Index>(n)).transpose();
  }

  const MotionProblem& problem_;
  const MotionOptions& options_;
  MotionPlaces places_;
  std::vector<MotionSpan> spans_;
  std::vector<WindowsLeftOut> left_out_;
  StreamNoise noise_;
  std::vector<WindowTerm> windows_;
  std::vector<OrientationTerm> orientations_;
  std::vector<Eigen::Index> orienting_;  ///< coordinates that orientations tell of
  double window_scale_ = 1.0;
  double orientation_scale_ = 1.0;
  double joint_factor_ = 1.0;
  double current_factor_ = 1.0;
  Eigen::VectorXd linearized_at_;
  std::size_t every_ = 1;  ///< window is linearised
  /// By the coordinates that orientations tell of, transposed: three columns for each.
  Eigen::MatrixXd orientation_jacobians_;
  std::vector<BalanceEvaluator> evaluators_;  ///< one for each thread
};

/// W with WᵀW the inverse of a covariance.
Eigen::MatrixXd whiteningOfMany(const Eigen::MatrixXd& covariance);

/// Weight of a misfit whose square over its scale is s: beyond twice the scale it counts linearly
/// (Huber).
double robustWeight(double s);

/// Coordinates that orientations of the tracker tell of, ascending: of joints and their sensors, of
/// registrations, and its delay.
std::vector<Eigen::Index> orientingCoordinates(const ParameterSpace& space,
                                               const MotionPlaces& places);

}  // namespace sac
