#pragma once

#include <stdexcept>
#include <string>

namespace sac {

/// Base of every exception that this package throws on purpose. `what()` is one sentence that an
/// operator can act on. Not converging and not being observable are results, never exceptions.
class Error : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// A description, configuration or option is wrong: the message names file, line and key where
/// known.
class ConfigError : public Error {
 public:
  using Error::Error;
};

/// Measured data cannot be used as given (wrong size, not finite, another unit's serial,
/// unreadable).
class DataError : public Error {
 public:
  using Error::Error;
};

}  // namespace sac
