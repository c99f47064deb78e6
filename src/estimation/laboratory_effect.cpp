#include "spherical_actuator_calibration/estimation/laboratory_effect.hpp"

namespace sac {

double LaboratoryEffect::nominalValue(Eigen::Index /*n*/) const {
  return 0.0;
}

bool LaboratoryEffect::isToldBy(Eigen::Index /*n*/, const std::vector<bool>& /*excited*/) const {
  return true;
}

void LaboratoryEffect::addReadingColumns(const Eigen::Vector3d& /*reading*/,
                                         Columns /*columns*/) const {}

void LaboratoryEffect::addTrackerColumns(Columns /*columns*/) const {}

void LaboratoryEffect::addMarkerColumns(Columns /*columns*/) const {}

void LaboratoryEffect::addTorqueFrameColumns(Columns /*columns*/) const {}

void LaboratoryEffect::addLoadColumns(const Eigen::Matrix3d& /*R_rotor_stator*/,
                                      Columns /*columns*/) const {}

Eigen::Matrix3d LaboratoryEffect::loadRotation(const Values& /*values*/,
                                               const Eigen::Matrix3d& /*R_rotor_stator*/) const {
  return Eigen::Matrix3d::Zero();
}

Eigen::Index LaboratoryEffect::strengthCoordinate(std::size_t /*pole*/,
                                                  std::size_t /*coil*/) const {
  return -1;
}

void LaboratoryEffect::addPairColumns(const Eigen::Vector3d& /*pole_rotor*/,
                                      const Eigen::Vector3d& /*coil_rotor*/,
                                      Columns /*columns*/) const {}

bool LaboratoryEffect::changesCurve() const {
  return false;
}

void LaboratoryEffect::applyTo(Actuator& /*actuator*/, const Values& /*values*/) const {}

std::vector<std::string> LaboratoryEffect::components(const std::string& name) {
  return {name + "/x", name + "/y", name + "/z"};
}

}  // namespace sac
