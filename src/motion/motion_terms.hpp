#pragma once

#include <vector>

#include <Eigen/Core>

#include "motion_span.hpp"
#include "spherical_actuator_calibration/motion/motion_problem.hpp"
#include "stream_noise.hpp"
#include "tracker_term.hpp"
#include "window_balance.hpp"

namespace sac {

/// Normal equations of one kind of terms, in all coordinates: half the Hessian and half the
/// gradient of the squared whitened misfit.
struct TermSum {
  Eigen::MatrixXd information;
  Eigen::VectorXd gradient;
  double misfit = 0.0;  ///< Σ of squared whitened residuals, robustly weighted
};

/// One window in the estimation.
struct WindowTerm {
  MotionWindow window;
  Eigen::MatrixXd by_joints;    ///< covariance of its residuals
  Eigen::MatrixXd by_currents;  ///< the same per A² of the currents' noise
  Eigen::MatrixXd whitening;
  Eigen::VectorXd residual;
  double square = 0.0;  ///< squared whitened residual, over the number of residuals
  bool active = true;
};

/// One orientation of the tracker.
struct OrientationTerm {
  std::size_t span = 0;
  std::size_t index = 0;
  Eigen::Vector3d residual = Eigen::Vector3d::Zero();
  double time = 0.0;
  double square = 0.0;  ///< the same
  bool active = true;
  bool is_known = false;  ///< readings are there
};

/// How terms are evaluated.
struct TermOrder {
  BalanceOrder balance;
  std::size_t every = 1;  ///< of so many terms one counts
};

/// All that a recording tells at coordinates x.
class MotionTerms {
 public:
  /// Keeps references.
  MotionTerms(const MotionProblem& problem, const MotionOptions& options);

  std::size_t windowCount() const { return windows_.size(); }
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

  TermSum balance(const Eigen::VectorXd& x, const TermOrder& order);
  TermSum orientation(const Eigen::VectorXd& x, const TermOrder& order);

 private:
  void addWindow(const MotionPoint& point, const TermOrder& order, WindowTerm& term, TermSum& sum);

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
  BalanceEvaluator evaluator_;
  WindowBalance balance_;
};

/// W with WᵀW the inverse of a covariance.
Eigen::MatrixXd whiteningOfMany(const Eigen::MatrixXd& covariance);

}  // namespace sac
