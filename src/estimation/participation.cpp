#include "spherical_actuator_calibration/estimation/participation.hpp"

namespace sac {

std::vector<Eigen::Index> coordinatesOf(const Eigen::MatrixXd& directions) {
  constexpr double kParticipation = 0.01;
  std::vector<Eigen::Index> result;
  for (Eigen::Index p = 0; p < directions.rows(); ++p) {
    if (directions.row(p).squaredNorm() > kParticipation) {
      result.push_back(p);
    }
  }
  return result;
}

}  // namespace sac
