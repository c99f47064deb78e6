#pragma once

#include <cstddef>
#include <optional>

#include "spherical_actuator_calibration/actuator/cycle.hpp"

namespace sac {

/// Whether the report of a cycle tells what errors it lets expect over the workspace, which takes
/// longer than a short cycle itself.
enum class ExpectedErrors { kReported, kLeftOut };

/// A cycle as an operator asks for it.
struct CycleRequest {
  Cycle cycle = Cycle::kJoint;
  std::optional<std::size_t> coil = std::nullopt;  ///< the excited one, for kPoles and kCoil only
  ExpectedErrors expected_errors = ExpectedErrors::kReported;
};

/// The same cycle where nobody reads what errors it lets expect.
inline CycleRequest withoutExpectedErrors(CycleRequest request) {
  request.expected_errors = ExpectedErrors::kLeftOut;
  return request;
}

}  // namespace sac
