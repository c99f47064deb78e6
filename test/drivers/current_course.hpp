#pragma once

#include <functional>

namespace sac {

/// A current [A] over the time [s].
using Course = std::function<double(double)>;

}  // namespace sac
