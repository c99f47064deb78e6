#pragma once

namespace sac {

/// From now on the program gets at most so much memory more [MB] than it has; what asks for more
/// fails with std::bad_alloc instead of taking it from everything else on the computer. Throws
/// Error when the system does not limit it.
void limitMemory(double megabytes);

}  // namespace sac
