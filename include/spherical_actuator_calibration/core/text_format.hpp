#pragma once

#include <string>

namespace spherical_actuator_calibration {

/// Text as printf() writes it, of any length.
std::string format(const char* pattern, ...) __attribute__((format(printf, 1, 2)));

}  // namespace spherical_actuator_calibration
