#pragma once

#include <cstddef>
#include <deque>
#include <vector>

#include <Eigen/Core>

#include "current_steps.hpp"
#include "live_window.hpp"
#include "noise_factors.hpp"
#include "spherical_actuator_calibration/motion/live_estimate.hpp"
#include "spherical_actuator_calibration/motion/silent_coils.hpp"

namespace sac {

/// What LiveMotion does and keeps.
class LiveMotionWork {
 public:
  LiveMotionWork(const CalibrationModel& model,
                 ParameterBelief prior,
                 std::vector<Eigen::Index> free,
                 const EstimationOptions& estimation,
                 const MotionOptions& options,
                 const LiveMotionOptions& live);

  void add(MotionSlice slice);
  const LiveEstimate& estimate() const { return estimate_; }

 private:
  void chooseFree();
  void begin();
  void take(LiveWindow& window);
  void freezeOldest();
  void linearizeAnew(bool with_noise);
  double linearizeKept(bool with_covariance);
  void takeNoise();
  void findNoise();
  double scaleOf(const std::vector<double>& squares) const;
  double limitFor(std::size_t windows) const;
  void judgeKept();
  void sumUp();
  bool misleads();
  Eigen::VectorXd residualOf(const LiveWindow& window) const { return window.residualAt(x_); }
  bool contradicts(const LiveWindow& window) const;
  /// To the means; `weight` −1 takes it off again.
  void addMean(const LiveWindow& window, double weight);
  void addTo(InformationSum& balance, InformationSum& orientation, const LiveWindow& window) const;
  Eigen::MatrixXd information() const;
  void solve();
  Eigen::MatrixXd orientingColumns(const Eigen::MatrixXd& of_free) const;
  void tell(const Eigen::MatrixXd& inverse);
  void tellBesideHeld(const Eigen::MatrixXd& inverse, const Eigen::MatrixXd& own);
  void tellWithHeld(const Eigen::MatrixXd& inverse, const Eigen::MatrixXd& own);
  double squares() const;
  double freedom() const;
  double orientationChiSquare() const;
  void countServing();

  const CalibrationModel* model_;
  ParameterBelief prior_;
  std::vector<Eigen::Index> asked_;
  std::vector<Eigen::Index> free_;  ///< of those, what coils tell of that are not silent
  EstimationOptions estimation_;
  MotionOptions options_;
  LiveMotionOptions live_;
  MotionPlaces places_;
  TabulatedCurve tabulated_;
  std::vector<Eigen::Index> orienting_;
  Eigen::MatrixXd prior_information_;  ///< zero where a coordinate is held
  bool holds_uncertain_ = false;       ///< some coordinate that is not free is uncertain

  MotionNoise noise_;
  NoiseFactors factors_;
  SilentCoils silent_coils_;                  ///< of all windows
  std::vector<std::size_t> silent_;           ///< of them, for which `free_` was chosen
  CurrentSteps steps_;                        ///< of all windows
  double by_steps_ = 0.0;                     ///< variance of the current's delay by them
  std::vector<BalanceEvaluator> evaluators_;  ///< one for each thread
  WindowBalance probe_;
  double scale_ = 1.0;  ///< squared misfit of usual windows, over that of noise

  std::deque<LiveWindow> kept_;  ///< oldest first
  std::size_t next_probe_ = 0;
  std::size_t next_begin_;
  std::size_t next_noise_ = 0;

  // At `anchor_`.
  Eigen::VectorXd anchor_;
  InformationSum balance_;
  InformationSum orientation_;
  InformationSum means_;  ///< of orientations over each window that is kept
  // Of windows that are not kept any more, at `frozen_at_`.
  InformationSum frozen_balance_;
  InformationSum frozen_orientation_;
  Eigen::VectorXd frozen_at_;
  std::size_t frozen_serving_ = 0;
  double frozen_duration_ = 0.0;
  std::size_t frozen_orientations_ = 0;

  Eigen::VectorXd x_;
  std::size_t lately_left_out_ = 0;
  LiveEstimate estimate_;
};

}  // namespace sac
