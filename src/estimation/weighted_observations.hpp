#pragma once

#include <cstddef>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include "spherical_actuator_calibration/estimation/estimation_problem.hpp"
#include "spherical_actuator_calibration/estimation/linearization.hpp"

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
  /// W per observation.
  const std::vector<Eigen::Matrix3d>& whitening() const { return whitening_; }

  const std::vector<bool>& active() const { return active_; }
  std::size_t activeCount() const;
  void activateAll();
  /// Returns whether that changed anything.
  bool setActive(std::size_t observation, bool active);

  /// What calls have changed so far.
  struct Setting {
    std::vector<Eigen::Matrix3d> whitening;
    std::vector<bool> active;
  };
  Setting setting() const { return {whitening_, active_}; }
  void restore(Setting setting) {
    whitening_ = std::move(setting.whitening);
    active_ = std::move(setting.active);
  }

  /// Squared whitened norms of all observations at x.
  std::vector<double> squares(const Eigen::VectorXd& x) const;
  /// Information of the active observations on chosen coordinates (ascending) at x.
  Eigen::MatrixXd information(const Eigen::VectorXd& x,
                              const std::vector<Eigen::Index>& coordinates) const;

 private:
  ObservationEvaluator evaluator_;
  std::vector<Eigen::Matrix3d> whitening_;
  std::vector<bool> active_;
};

}  // namespace sac
