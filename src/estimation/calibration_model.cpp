#include "spherical_actuator_calibration/estimation/calibration_model.hpp"

#include <utility>

#include "spherical_actuator_calibration/measurement/current_tolerance.hpp"

namespace sac {

std::vector<Excitation> excitedCoils(const Sample& sample, double threshold) {
  std::vector<Excitation> excitations;
  for (Eigen::Index j = 0; j < sample.current.size(); ++j) {
    if (isExcited(sample.current[j], threshold)) {
      excitations.push_back({static_cast<std::size_t>(j), sample.current[j]});
    }
  }
  return excitations;
}

CalibrationModel::CalibrationModel(ParameterSpace space) : space_(std::move(space)) {
  if (space_.nominal().hasTorqueModel()) {
    curve_.emplace(*space_.nominal().torque_curve);
  }
}

}  // namespace sac
