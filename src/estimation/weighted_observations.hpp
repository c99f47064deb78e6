#pragma once

#include <cstddef>
#include <limits>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include "spherical_actuator_calibration/estimation/estimation_problem.hpp"
#include "spherical_actuator_calibration/estimation/linearization.hpp"
#include "spherical_actuator_calibration/estimation/shared_errors.hpp"

namespace sac {

/// The observations of one problem: how much each weighs, and which of them serve.
class WeightedObservations {
 public:
  /// All serve; weights come with the first updateWeights(). Keeps references.
  WeightedObservations(const EstimationProblem& problem, const EstimationOptions& options);

  const ObservationEvaluator& evaluator() const { return evaluator_; }
  std::size_t size() const { return whitening_.size(); }

  /// Recomputes the weights at x, where the coordinates marked in `held` stay at the prior. Returns
  /// whether one changed noticeably.
  bool updateWeights(const Eigen::VectorXd& x, const std::vector<bool>& held);
  /// W per observation: of what it does not share.
  const std::vector<Eigen::Matrix3d>& whitening() const { return whitening_; }
  const SharedErrorModel& shared() const { return shared_; }

  const std::vector<bool>& active() const { return active_; }
  std::size_t activeCount() const;
  void activateAll();
  /// Returns whether that changed anything.
  bool setActive(std::size_t observation, bool active);

  /// What calls have changed so far.
  struct Setting {
    std::vector<Eigen::Matrix3d> whitening;
    std::vector<SharedLoading> loading;
    std::vector<bool> active;
  };
  Setting setting() const { return {whitening_, shared_.loading, active_}; }
  void restore(Setting setting) {
    weighed_at_.resize(0);
    whitening_ = std::move(setting.whitening);
    shared_.loading = std::move(setting.loading);
    active_ = std::move(setting.active);
  }

  /// Squared whitened norms of all observations at x, χ² with three degrees of freedom each where
  /// they fit. Within a dwell that of an observation given the others there, whose squares do not
  /// exceed `limit`: the least likely is set aside, one after the other. The residual by itself
  /// would be blind to faults that are smaller than the errors which the dwell shares, and with all
  /// others one fault would accuse the whole dwell.
  std::vector<double> squares(const Eigen::VectorXd& x,
                              double limit = std::numeric_limits<double>::infinity()) const;
  /// χ² of the active observations at x, shared errors eliminated.
  double chiSquare(const Eigen::VectorXd& x) const;
  /// Whitened residuals at x less the errors that their dwells share, by the active ones.
  std::vector<Eigen::Vector3d> residuals(const Eigen::VectorXd& x) const;
  enum class Which { kActive, kAll };
  /// Information of the active or all observations on chosen coordinates (ascending) at x.
  Eigen::MatrixXd information(const Eigen::VectorXd& x,
                              const std::vector<Eigen::Index>& coordinates,
                              Which which = Which::kActive) const;

 private:
  void squaresOfDwell(const std::vector<std::size_t>& dwell,
                      const ModelPoint& point,
                      double limit,
                      std::vector<double>& squares) const;
  DwellElimination eliminated(const std::vector<std::size_t>& dwell, const ModelPoint& point) const;
  Eigen::Vector3d whitenedResidual(std::size_t observation, const ModelPoint& point) const {
    return whitening_[observation] * evaluator_.residual(observation, point);
  }

  ObservationEvaluator evaluator_;
  SharedErrorModel shared_;
  std::vector<Eigen::Matrix3d> whitening_;
  std::vector<bool> active_;
  Eigen::VectorXd weighed_at_;      ///< the coordinates that the weights belong to, or none
  std::vector<bool> weighed_with_;  ///< the same of the held ones
};

}  // namespace sac
