#include "spherical_actuator_calibration/measurement/carried_currents.hpp"

#include "spherical_actuator_calibration/measurement/current_tolerance.hpp"

namespace sac {

std::optional<std::size_t> coilAmiss(const Eigen::VectorXd& commanded,
                                     const Eigen::VectorXd& measured,
                                     double current_threshold) {
  const CurrentTolerance tolerance = currentTolerance(current_threshold);
  for (Eigen::Index j = 0; j < measured.size(); ++j) {
    if (!tolerance.allows(measured[j], commanded[j])) {
      return static_cast<std::size_t>(j);
    }
  }
  return std::nullopt;
}

}  // namespace sac
