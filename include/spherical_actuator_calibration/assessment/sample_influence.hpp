#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "spherical_actuator_calibration/calibration/calibration_session.hpp"
#include "spherical_actuator_calibration/measurement/sample.hpp"

namespace sac {

/// How much one observation moves the result of a cycle.
struct SampleInfluence {
  std::uint32_t id = 0;
  Quantity quantity = Quantity::kOrientation;
  /// Share of the observation that the fit reproduces by itself, 0 to 1: near 1 no other
  /// observation checks it.
  double leverage = 0.0;
  /// Largest change of a parameter, in its standard deviations, if the observation were left out.
  double largest_shift = 0.0;
  /// Without it some parameter could not be told at all: nothing checks it there, and only the rest
  /// of it shifts anything.
  bool irreplaceable = false;
  std::string parameter;  ///< the one that changes most, or that could not be told
};

/// Influence of every observation that the last cycle of a session used, by leave-one-out from one
/// factorisation: Δx = −(JᵀWJ)⁻¹Jₙᵀ W (I − Hₙ)⁻¹ rₙ, exact for a linear model. The errors that a
/// dwell shares are found along, as the fit does; what a motion told stays when an observation
/// goes. Rejected observations have none. Empty where no cycle ran, or the last one failed.
std::vector<SampleInfluence> sampleInfluences(const CalibrationSession& session);

}  // namespace sac
