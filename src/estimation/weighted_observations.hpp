#pragma once

#include <cstddef>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include "spherical_actuator_calibration/estimation/estimation_problem.hpp"
#include "spherical_actuator_calibration/estimation/linearization.hpp"
#include "spherical_actuator_calibration/estimation/shared_errors.hpp"
#include "spherical_actuator_calibration/estimation/whitened_observation.hpp"

namespace sac {

/// Of the misfit of one observation.
inline constexpr int kObservationComponents = 3;

/// The observations of one problem: how much each weighs, and which of them serve. What they are at
/// the last point is kept: weights, information and tests ask for the same one, one after the
/// other.
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
  const std::vector<Whitening>& whitening() const { return whitening_; }
  const SharedErrorModel& shared() const { return shared_; }

  const std::vector<bool>& active() const { return active_; }
  std::size_t activeCount() const;
  void activateAll();
  /// Returns whether that changed anything.
  bool setActive(std::size_t observation, bool active);

  /// What calls have changed so far.
  struct Setting {
    std::vector<Whitening> whitening;
    std::vector<SharedLoading> loading;
    std::vector<bool> active;
  };
  Setting setting() const { return {whitening_, shared_.loading, active_}; }
  void restore(Setting setting) {
    weighed_at_.resize(0);
    last_.sum.reset();
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

  /// Sum over the active observations at x, in all coordinates. Valid until anything changes.
  const InformationSum& sum(const Eigen::VectorXd& x) const;
  /// Gives back the memory of what is known at the last point.
  void forgetPass() const { last_ = {}; }

 private:
  /// Of one pass over all observations at one point.
  struct Pass {
    Eigen::VectorXd at;                      ///< empty: there was none
    std::vector<Eigen::Vector3d> residuals;  ///< of all observations, not whitened
    std::optional<InformationSum> sum;       ///< of the active ones, unless they changed since
  };
  /// Whitened residuals at one point, those of the last pass where it is the same.
  class Residuals {
   public:
    Residuals(const WeightedObservations& observations, const Eigen::VectorXd& x);
    Eigen::Vector3d operator()(std::size_t observation) const;

   private:
    const WeightedObservations& observations_;
    std::optional<ModelPoint> point_;  ///< nothing: the last pass was here
  };

  /// One pass at x. `prepare`(observation, linear) comes before the weights are used.
  template <typename Prepare>
  InformationSum pass(const Eigen::VectorXd& x, Which which, const Prepare& prepare) const;
  bool weigh(std::size_t observation,
             const LinearizedObservation& linear,
             const std::vector<bool>& held);
  void squaresOfDwell(const std::vector<std::size_t>& dwell,
                      const Residuals& whitened,
                      double limit,
                      std::vector<double>& squares) const;
  DwellElimination eliminated(const std::vector<std::size_t>& dwell,
                              const Residuals& whitened) const;

  ObservationEvaluator evaluator_;
  SharedErrorModel shared_;
  std::vector<Whitening> whitening_;
  std::vector<bool> active_;
  Eigen::VectorXd weighed_at_;      ///< the coordinates that the weights belong to, or none
  std::vector<bool> weighed_with_;  ///< the same of the held ones
  mutable Pass last_;
};

}  // namespace sac
