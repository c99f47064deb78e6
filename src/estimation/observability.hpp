#pragma once

#include <vector>

#include <Eigen/Core>

namespace sac {

/// What an information matrix says of its coordinates.
struct Observability {
  /// Positions (0…n−1, ascending) of coordinates that take part in an open direction.
  std::vector<Eigen::Index> weak;
  /// n×d, orthonormal columns: directions that the data leave open.
  Eigen::MatrixXd open_directions;
  /// Number of the other directions.
  Eigen::Index rank = 0;
  /// √(λ_max/λ_min) over those; 0 when there is none.
  double identified_condition_number = 0.0;
  /// √(λ_max/λ_min) of the given matrix; infinite when λ_min is not positive.
  double condition_number = 0.0;
};

/// Whether no direction at all is known worse than `limit`: then judgeInformation() leaves none
/// open. Much cheaper than that.
bool leavesNothingOpen(const Eigen::MatrixXd& information, double limit);

/// Judges an information matrix N = JᵀΣ⁻¹J (n×n) of coordinates of one unit. The data leave
/// eigenvectors with eigenvalue below 1/`limit`² open, where a coordinate is known no better than
/// `limit` by them: a turn of the whole machine that is known to 28 mrad moves ten coordinates by
/// as much each, and by 90 mrad together. A coordinate belongs to open directions when its squared
/// components there sum to more than 1 %.
Observability judgeInformation(const Eigen::MatrixXd& information, double limit);

/// Observability::identified_condition_number alone; much cheaper where the matrix has islands, see
/// InformationFactor.
double identifiedConditionNumber(const Eigen::MatrixXd& information, double limit);

}  // namespace sac
