#pragma once

#include <cstddef>
#include <vector>

#include <Eigen/Core>

#include "spherical_actuator_calibration/estimation/shared_errors.hpp"
#include "spherical_actuator_calibration/estimation/whitened_observation.hpp"

namespace sac {

/// Sums over observations that are linearised by P coordinates and K further columns behind them:
/// the information on the coordinates, what they have in common with each further column, and what
/// further columns of one group have among themselves. Nobody asks for the rest, so that an
/// observation costs as many steps as it has columns times coordinates.
class ScoreSum {
 public:
  /// `groups`: per further column the first one of its group, whose columns follow each other; both
  /// counted from 0.
  ScoreSum(Eigen::Index coordinates, std::vector<Eigen::Index> groups);

  /// `weight`: of the observation beside its noise.
  void add(const WhitenedObservation& observation, double weight = 1.0);
  /// Takes CᵀKC off the information. `crossed`: C, of which only `columns` (ascending) are not
  /// zero.
  void takeOff(const Eigen::Matrix<double, kSharedErrors, Eigen::Dynamic>& crossed,
               const std::vector<Eigen::Index>& columns,
               const Eigen::Matrix<double, kSharedErrors, kSharedErrors>& covariance,
               double misfit);

  Eigen::Index coordinates() const { return crossed_.rows(); }
  /// P×P.
  Eigen::MatrixXd information() const { return own_.information(); }
  /// P: between the coordinates and a column of either kind.
  Eigen::VectorXd crossed(Eigen::Index column) const;
  /// Between two columns of one group, or two coordinates.
  double between(Eigen::Index a, Eigen::Index b) const;
  double gradient(Eigen::Index column) const;
  /// P.
  const Eigen::VectorXd& gradient() const { return own_.gradient(); }

 private:
  /// How many of ascending columns are coordinates.
  std::size_t leading(const std::vector<Eigen::Index>& columns) const;
  template <typename Product>
  void addFurther(const std::vector<Eigen::Index>& columns,
                  std::size_t own,
                  std::size_t b,
                  const Product& product);

  InformationSum own_;
  std::vector<Eigen::Index> groups_;
  Eigen::MatrixXd crossed_;   ///< P×K
  Eigen::MatrixXd within_;    ///< (m, k): of column k with the column at place m of its group
  Eigen::VectorXd gradient_;  ///< of further columns
};

}  // namespace sac
