#pragma once

#include <cstddef>
#include <map>
#include <set>

#include "held_out_measurement.hpp"
#include "spherical_actuator_calibration/estimation/parameter_space.hpp"

namespace sac {

/// Coils that held-out torques judge: the largest error of an axis that is judged (kLinearRange)
/// would show in all torques of the coil together.
class ToldCoils {
 public:
  /// A torque that counts.
  void add(const HeldOutMeasurement& torque, const ParameterSpace& space);

  std::set<std::size_t> coils() const;

 private:
  std::map<std::size_t, double> information_;  ///< [1/rad²] of the better known angle, by coil
};

}  // namespace sac
