#pragma once

#include <string>

#include "spherical_actuator_calibration/calibration/calibration_config.hpp"

namespace sac {

/// What is to be said of registrations that count as exact because nothing is stated of them; empty
/// where all are stated. That of the force/torque sensor counts where torques were used.
std::string unstatedRegistrationInWords(const RegistrationUncertainty& registration,
                                        bool used_torques);

}  // namespace sac
