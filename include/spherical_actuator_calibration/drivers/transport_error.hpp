#pragma once

#include <string>

#include "spherical_actuator_calibration/base/error.hpp"

namespace sac {

/// What went wrong between this machine and a device.
enum class TransportFailure {
  kUnreachable,  ///< the link cannot be opened, or was closed by the other side
  kTimeout,      ///< no answer in time
  kRefused,      ///< the device answered with an exception: it is there, and does not do this
  kGarbled,  ///< the answer is not one to the request (checksum, length, function), or no number
};

/// A device did not do what it was asked to. `what()` names device and register.
class TransportError : public Error {
 public:
  TransportError(TransportFailure failure, const std::string& sentence)
      : Error(sentence), failure_(failure) {}

  TransportFailure failure() const { return failure_; }

 private:
  TransportFailure failure_;
};

}  // namespace sac
