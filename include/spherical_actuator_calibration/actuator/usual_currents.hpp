#pragma once

namespace sac {

// Currents where nobody states others, of the amplifier and the coils that the package comes with
// (config/coil_driver.yaml, config/orientation_controller.yaml): planner, driver, controller and
// guided session agree by them. Programs in Python and the files are held to the first three by
// shared_rules_test.

inline constexpr double kUsualExcitation = 2.0;     ///< of an excited coil [A]
inline constexpr double kUsualCoilCurrent = 2.5;    ///< at most through one coil [A]
inline constexpr double kUsualTotalCurrent = 8.0;   ///< at most of the sum of all |currents| [A]
inline constexpr double kUsualSquareCurrent = 8.0;  ///< at most of a motion's ΣI² [A²]

}  // namespace sac
