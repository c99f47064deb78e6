#pragma once

#include <cstddef>
#include <functional>

namespace sac {

/// Calls `work(worker, n)` once for each n < count, by so many threads, of which the caller's is
/// one. `worker` < `threads` tells who works, for storage that each needs of its own. Which worker
/// gets which n is left to chance: results must not depend on it. Rethrows what the first call
/// that failed has thrown, after all threads have ended. No threads count as one.
void parallelFor(std::size_t count,
                 unsigned threads,
                 const std::function<void(unsigned worker, std::size_t n)>& work);

}  // namespace sac
