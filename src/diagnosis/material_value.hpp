#pragma once

namespace sac {

/// A value that is further than so many tolerances from what is described is a mistake:
/// manufacturing does not explain it.
constexpr double kMaterial = 3.0;

}  // namespace sac
