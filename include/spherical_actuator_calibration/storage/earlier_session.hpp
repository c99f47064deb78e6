#pragma once

#include <string>

#include "spherical_actuator_calibration/actuator/actuator.hpp"
#include "spherical_actuator_calibration/measurement/pose_to_measure.hpp"

namespace sac {

/// What an earlier session measured, in order to measure it again.
struct EarlierSession {
  PosesToMeasure poses;  ///< by their first samples; held-out ones are poses of their own
  double current = 0.0;  ///< of an excited coil, the median, to 10 mA [A]; 0: none was excited
};

/// Whether a file is a database, by its first bytes; false where it cannot be read. Not of one that
/// this process has open: closing it here would end the locks that SQLite has on it.
bool isDatabase(const std::string& path);

/// Poses and patterns of the samples in use of a session database of this unit, which is read only:
/// another process may work with it. A pose beyond the workspace by no more than kPoseTolerance, as
/// a hand meets it, is moved to the edge. `current_threshold` [A]: a coil below it counts as off.
/// Throws DataError that names the file: none, damaged, of a newer version or of another unit,
/// without samples, with a coil that there is not, or with a pose beyond the workspace.
EarlierSession loadEarlierSession(const std::string& path,
                                  const Actuator& actuator,
                                  double current_threshold);

}  // namespace sac
