#pragma once

namespace sac {

/// Whether orientations get a map of what axes and corrections leave unexplained.
enum class MapUse {
  kAuto,    ///< where it predicts regions that it has not seen clearly better
  kAlways,  ///< wherever one can be fitted
  kNever,
};

}  // namespace sac
