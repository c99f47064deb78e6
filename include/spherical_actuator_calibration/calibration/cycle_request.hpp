#pragma once

#include <cstddef>
#include <optional>
#include <string>

namespace sac {

/// The cycles of a calibration: level 1, level 2 situations 1 and 2, and all parameters at once.
enum class Cycle { kJoint, kPoles, kCoil, kRefine };

/// joint, poles, coil, refine: as in CalibrationReport messages.
std::string cycleName(Cycle cycle);

/// A cycle as an operator asks for it.
struct CycleRequest {
  Cycle cycle = Cycle::kJoint;
  std::optional<std::size_t> coil = std::nullopt;  ///< the excited one, for kPoles and kCoil only
};

}  // namespace sac
