#pragma once

#include <cmath>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "motion_noise.hpp"
#include "motion_span.hpp"
#include "noise_factors.hpp"
#include "orientation_terms.hpp"
#include "spherical_actuator_calibration/estimation/whitened_observation.hpp"
#include "spherical_actuator_calibration/motion/motion_problem.hpp"
#include "window_balance.hpp"

namespace sac {

/// What windows tell of a torque that is the same all the time, stator frame.
struct TorqueEvidence {
  Eigen::Matrix3d information = Eigen::Matrix3d::Zero();
  Eigen::Vector3d gradient = Eigen::Vector3d::Zero();
};

/// One window in the estimation.
struct WindowTerm {
  MotionWindow window;
  WindowBalance
      balance;  ///< where it was linearised last; of one that is summed the residual alone
  Eigen::MatrixXd whitening;
  Eigen::VectorXd residual;  ///< whitened
  double square = 0.0;       ///< squared whitened residual, over the number of residuals
  bool active = true;
  bool held_out = false;    ///< judges, and does not serve as long as it does
  bool is_summed = false;   ///< its derivatives are not kept: what it tells is in a sum of many
  bool is_in_sum = false;   ///< it was sound when it was summed up
  bool is_pushed = false;   ///< with others around it: see steadilyPushed()
  std::string at_end;       ///< SaturatedReadings::within()
  bool is_cut_off = false;  ///< by that end: see leaveCutOff()
  TorqueEvidence steady;    ///< of one that is summed
  NoiseEvidence noise;      ///< of one that is summed

  bool isSound() const { return active && !is_pushed && !is_cut_off; }
  bool serves() const { return isSound() && !held_out; }
  bool isKept() const { return whitening.size() > 0; }
};

/// How windows are linearised.
struct TermOrder {
  BalanceOrder balance;
  std::size_t every = 1;     ///< of so many windows one counts
  bool orientations = true;  ///< too
};

/// All that a recording tells at coordinates x. Terms are linearised at one place, which takes
/// time, and then tell of the places around it, as often as weights are looked at anew. Derivatives
/// of so many windows are kept as the options say; of more, sums: in them weights are those of
/// where they were linearised.
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
  const OrientationTerms& orientations() const { return orientations_; }
  OrientationTerms& orientations() { return orientations_; }
  const std::vector<MotionSpan>& spans() const { return spans_; }
  const std::vector<WindowsLeftOut>& leftOut() const { return left_out_; }
  const MotionNoise& noise() const { return noise_; }
  /// Where the tracker's delay is known better than at the begin, what seemed noise may be motion.
  void findTrackerNoise(const Eigen::VectorXd& x);
  /// From the next linearisation on its variance is so many times as large.
  void widenTracker(double factor) { noise_.orientation *= std::sqrt(factor); }
  const MotionPlaces& places() const { return places_; }
  /// The model at other coordinates. Keeps references to these terms.
  MotionPoint pointAt(const Eigen::VectorXd& x) const {
    return MotionPoint(*problem_.model, places_, x, &tabulated_);
  }
  /// Whether derivatives of some windows are not kept.
  bool areSummed() const;
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
  /// What a window tells of a steady torque that is not modelled, where balance() was asked last.
  TorqueEvidence steadyTorque(std::size_t window) const;
  /// What the windows that serve tell of the noise, where balance() was asked last.
  std::vector<NoiseEvidence> noiseEvidence() const;
  /// Squared whitened residuals of the windows that serve, at x, where balance() was asked last.
  double squares(const Eigen::VectorXd& x) const;
  /// Of what is held out and active, without robust weights: the windows' balance, and the mean
  /// orientation within each, so that white noise of the tracker does not hide the rest. `values`:
  /// how many residuals.
  InformationSum heldOut(const Eigen::VectorXd& x, std::size_t& values);
  /// Whether anything is.
  bool holdsOut() const;
  /// From now on all that is active serves.
  void admitHeldOut();

 private:
  /// What windows that are not kept tell where they are linearised.
  struct WindowSums {
    explicit WindowSums(Eigen::Index size) : serving(size), held_out(size) {}

    InformationSum serving;
    InformationSum held_out;
  };

  Eigen::MatrixXd whiteningFor(const WindowBalance& balance) const;
  NoiseEvidence noiseEvidenceOf(const WindowTerm& term) const;
  void linearizeWindows(const BalanceOrder& order);
  void keep(WindowTerm& term, const MotionPoint& point, BalanceEvaluator& evaluator);
  void sumUp(WindowTerm& term,
             const MotionPoint& point,
             BalanceEvaluator& evaluator,
             WindowSums& sums);
  static void addToSums(const WindowTerm& term, double weight, WindowSums& sums);
  void sumUpWhatChanged();

  const MotionProblem& problem_;
  const MotionOptions& options_;
  MotionPlaces places_;
  TabulatedCurve tabulated_;
  std::vector<MotionSpan> spans_;
  std::vector<WindowsLeftOut> left_out_;
  MotionNoise noise_;
  std::vector<WindowTerm> windows_;
  OrientationTerms orientations_;
  double window_scale_ = 1.0;
  double joint_factor_ = 1.0;
  double current_factor_ = 1.0;
  Eigen::VectorXd linearized_at_;
  std::size_t every_ = 1;      ///< window is linearised
  BalanceOrder order_;         ///< of the last linearisation
  double summed_scale_ = 1.0;  ///< of windows, when they were summed up
  bool sums_are_old_ = false;  ///< noise is another since
  WindowSums sums_;
  std::vector<BalanceEvaluator> evaluators_;  ///< one for each thread
};

/// Of so many windows one is kept, whatever it tells.
std::size_t keptStride(std::size_t windows);

/// W with WᵀW the inverse of a covariance.
Eigen::MatrixXd whiteningOfMany(const Eigen::MatrixXd& covariance);

}  // namespace sac
