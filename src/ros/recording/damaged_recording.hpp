#pragma once

#include <exception>
#include <new>
#include <string>

#include "spherical_actuator_calibration/base/error.hpp"

namespace sac {

/// Runs what reads a recording, `place` of it in messages. Throws DataError that says what to do
/// where the recording is damaged: rosbag and the message classes report that by several
/// exceptions, some of them of the standard library. Errors of our own pass, and so does a lack of
/// memory.
template <typename Action>
void readUndamaged(const std::string& place, const Action& action) {
  try {
    action();
  } catch (const Error&) {
    throw;
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const std::exception& error) {
    throw DataError(place + ": the recording is damaged (" + error.what() +
                    "); copy it again, or rescue what is in it by `rosbag reindex`.");
  }
}

}  // namespace sac
