#pragma once

#include "spherical_actuator_calibration/actuator/description_file.hpp"
#include "spherical_actuator_calibration/calibration/calibration_session.hpp"

namespace sac {

/// What a session says that its description comes from.
inline CalibrationOrigin savedOrigin() {
  return {"2024-05-31T12:00:00Z", {{"a.bag", "sha256:00"}}, "0.3.0"};
}

/// The description of a session as it is read again from its file.
inline CalibratedDescription reloaded(const CalibrationSession& session) {
  return parseDescription(renderDescription(session.description(savedOrigin()), "c.yaml"),
                          "c.yaml");
}

}  // namespace sac
