#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "spherical_actuator_calibration/calibration/calibration_report.hpp"

namespace sac {

/// The number that people see of a joint, pole or coil.
std::string numberText(std::size_t index);

/// Whether a value differs from what it is without its cause by more than its uncertainty explains.
bool isSignificant(const ParameterEstimate& estimate);

/// "coil_7/gain = 5.02 % ± 0.03 %, …": those that are known best in their own uncertainty, three at
/// most.
std::string valuesInWords(std::vector<ParameterEstimate> estimates);

/// " explains it: chi-square 72 → 0.94."
std::string explainsInWords(double reduced_chi_square_before, double reduced_chi_square_with);

}  // namespace sac
