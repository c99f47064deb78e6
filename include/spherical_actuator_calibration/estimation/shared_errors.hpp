#pragma once

#include <cstddef>
#include <vector>

#include <Eigen/Core>

#include "spherical_actuator_calibration/estimation/estimation_problem.hpp"
#include "spherical_actuator_calibration/estimation/whitened_observation.hpp"

namespace sac {

/// Errors u that all observations of a dwell share, in standard deviations: of the three joints'
/// readings, and of the torque without current that was taken off. A whitened residual is W r =
/// noise + G u, with unit noise and u ~ N(0, 1).
inline constexpr Eigen::Index kSharedErrors = 6;
using SharedErrors = Eigen::Matrix<double, kSharedErrors, 1>;
using SharedLoading = Eigen::Matrix<double, 3, kSharedErrors>;  ///< G of an observation

/// The observations that share errors, and how they feel them.
struct SharedErrorModel {
  /// Of each dwell its observations, ascending; those in none have errors of their own.
  std::vector<std::vector<std::size_t>> dwells;
  std::vector<bool> shares;            ///< per observation: it is in a dwell
  std::vector<SharedLoading> loading;  ///< G per observation, zero in none; empty without dwells
};

/// Observations of one problem that share errors: those of consecutive samples of one dwell. Where
/// samples do not say of which they are, those whose readings agree far better than independent
/// errors of their stated size would.
SharedErrorModel groupByDwell(const EstimationProblem& problem, const EstimationOptions& options);

/// Elimination of u from the observations of one dwell: what is left is exactly the misfit with
/// the covariance I + G Gᵀ of the stacked residuals, without ever forming it.
class DwellElimination {
 public:
  DwellElimination();

  /// Takes an observation in, with its whitened residual, and a weight beside its noise.
  void add(const SharedLoading& loading, const Eigen::Vector3d& residual, double weight = 1.0);
  /// Takes it out again.
  void remove(const SharedLoading& loading, const Eigen::Vector3d& residual);

  /// Most likely u.
  SharedErrors errors() const;
  /// (I + Σ GᵀG)⁻¹: covariance of u.
  Eigen::Matrix<double, kSharedErrors, kSharedErrors> covariance() const;
  /// Σ rᵀr + … of what was taken in, with u eliminated.
  double squaredMisfit() const;

 private:
  Eigen::Matrix<double, kSharedErrors, kSharedErrors> information_;
  SharedErrors gradient_;
  double squares_ = 0.0;
};

/// Whitened observations of one dwell, added to a sum with u eliminated.
class DwellSum {
 public:
  explicit DwellSum(Eigen::Index size)
      : crossed_(decltype(crossed_)::Zero(kSharedErrors, size)),
        touched_(static_cast<std::size_t>(size), false) {}

  /// Forgets the dwell before.
  void begin();
  void add(const WhitenedObservation& observation,
           const SharedLoading& loading,
           double weight = 1.0);
  /// Σ GᵀJ, 6×F.
  const Eigen::Matrix<double, kSharedErrors, Eigen::Dynamic>& crossed() const { return crossed_; }
  const DwellElimination& elimination() const { return elimination_; }
  /// `sum`: one that knows add() and takeOff(), as InformationSum does.
  template <typename Sum>
  void addTo(Sum& sum) const {
    const SharedErrors errors = elimination_.errors();
    for (const Entry& entry : entries_) {
      WhitenedObservation corrected = entry.observation;
      corrected.residual -= entry.loading * errors;
      sum.add(corrected, entry.weight);
    }
    sum.takeOff(crossed_, touched(), elimination_.covariance(), errors.squaredNorm());
  }

 private:
  struct Entry {
    WhitenedObservation observation;
    SharedLoading loading;
    double weight;
  };
  /// Columns of crossed_ that may not be zero, ascending.
  std::vector<Eigen::Index> touched() const;

  std::vector<Entry> entries_;
  Eigen::Matrix<double, kSharedErrors, Eigen::Dynamic> crossed_;
  std::vector<bool> touched_;          ///< per column of crossed_: it may not be zero
  std::vector<Eigen::Index> columns_;  ///< that are touched
  DwellElimination elimination_;
};

}  // namespace sac
