#pragma once

#include <cstddef>
#include <optional>
#include <string>

namespace sac {

/// The cycles of a calibration: level 1, level 2 situations 1 and 2, all parameters at once from
/// dwells, and all at once from motion.
enum class Cycle { kJoint, kPoles, kCoil, kRefine, kMotion };

/// joint, poles, coil, refine, motion: as in CalibrationReport messages.
std::string cycleName(Cycle cycle);

/// A cycle as an operator asks for it.
struct CycleRequest {
  Cycle cycle = Cycle::kJoint;
  std::optional<std::size_t> coil = std::nullopt;  ///< the excited one, for kPoles and kCoil only
};

}  // namespace sac
