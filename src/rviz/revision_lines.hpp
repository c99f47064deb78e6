#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "spherical_actuator_calibration/Revision.h"
#include "spherical_actuator_calibration/ros/conversion/messages.hpp"

namespace sac {

/// One revision of the parameters, ready to be read.
struct RevisionLine {
  std::uint32_t number = 0;
  bool restorable = false;
  std::string name;    ///< its number, or the folder of another session and the number there; that
                       ///< of the one in force says so
  std::string date;    ///< as it is told, without T and Z: UTC
  std::string origin;  ///< what made it
  std::string error;   ///< before → after, with its unit; empty where no cycle made it
  std::string drift;   ///< since the session before, where it is told

  bool operator==(const RevisionLine& other) const {
    return number == other.number && restorable == other.restorable && name == other.name &&
           date == other.date && origin == other.origin && error == other.error &&
           drift == other.drift;
  }
};

/// The newest first, `revisions` as list_revisions tells them; `in_force`: number of the one in
/// force, which is of the session that can be restored from.
std::vector<RevisionLine> revisionLines(const std::vector<msg::Revision>& revisions,
                                        std::uint32_t in_force);

}  // namespace sac
