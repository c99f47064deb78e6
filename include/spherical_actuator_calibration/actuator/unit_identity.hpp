#pragma once

#include <optional>
#include <string>

#include "spherical_actuator_calibration/actuator/actuator.hpp"

namespace sac {

/// What is not of an actuator, as a sentence wants it: it is of the `kind` `its`, not of `own`.
struct OtherUnit {
  std::string kind;  ///< "actuator" where names differ, "unit" where serials do
  std::string its;
  std::string own;
};

/// How a plan or a recording that states name and serial of its unit is of another one. Nothing
/// where it may be of this one: names agree, and serials where both are known; empty is not known.
std::optional<OtherUnit> otherUnit(const Actuator& actuator,
                                   const std::string& name,
                                   const std::string& serial);

}  // namespace sac
