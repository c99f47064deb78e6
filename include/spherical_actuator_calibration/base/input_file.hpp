#pragma once

#include <cstddef>
#include <string>

namespace sac {

/// Largest text file that is read [byte]: thousands of samples of hundreds of coils.
inline constexpr std::size_t kLargestTextFile = std::size_t{64} << 20U;
/// Of a description: that of 400 coils with the covariance of all its parameters has 5.7 MB.
inline constexpr std::size_t kLargestDescription = std::size_t{8} << 20U;
/// Of a configuration or a plan.
inline constexpr std::size_t kLargestConfiguration = std::size_t{1} << 20U;

/// Content of a file that comes from outside. Only regular files are read: a FIFO would wait for
/// ever, a device never end. Throws ConfigError that names the file and says what it is when it is
/// none, cannot be read, or is larger than `largest` [byte].
std::string readInputFile(const std::string& path, std::size_t largest = kLargestTextFile);

/// What stands at a path that is no regular file ("a folder", "a device", "a FIFO"); empty for a
/// regular file and for nothing. Links are followed.
std::string unreadableKind(const std::string& path);

}  // namespace sac
