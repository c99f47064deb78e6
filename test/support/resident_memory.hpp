#pragma once

#include <functional>

namespace sac {

/// How much more memory [byte] is resident at most while something runs than before it. That is
/// what is in use only where the heap gives large blocks back at once: M_MMAP_THRESHOLD of
/// mallopt().
double peakBeside(const std::function<void()>& action);

}  // namespace sac
