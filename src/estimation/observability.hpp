#pragma once

#include <vector>

#include <Eigen/Core>

namespace sac {

/// What an information matrix says of its coordinates.
struct Observability {
  /// Positions (0…n−1, ascending) of coordinates that take part in a direction whose standard
  /// deviation exceeds the limit.
  std::vector<Eigen::Index> weak;
  /// n×d, orthonormal columns: directions whose standard deviation exceeds the limit.
  Eigen::MatrixXd open_directions;
  /// Number of directions within the limit.
  Eigen::Index rank = 0;
  /// √(λ_max/λ_min) over the directions within the limit; 0 when there is none.
  double identified_condition_number = 0.0;
  /// √(λ_max/λ_min) of the given matrix; infinite when λ_min is not positive.
  double condition_number = 0.0;
};

/// Whether it leaves no direction open, see judgeInformation(); much cheaper than that.
bool leavesNothingOpen(const Eigen::MatrixXd& information, double limit);

/// Judges an information matrix N = JᵀΣ⁻¹J (n×n) of coordinates of one unit: eigenvectors with
/// eigenvalue below 1/`limit`² are directions that the data leave open. A coordinate belongs to
/// them when its squared components there sum to more than 1 %.
Observability judgeInformation(const Eigen::MatrixXd& information, double limit);

/// Observability::identified_condition_number alone; much cheaper where the matrix has islands, see
/// InformationFactor.
double identifiedConditionNumber(const Eigen::MatrixXd& information, double limit);

}  // namespace sac
