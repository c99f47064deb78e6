#include "spherical_actuator_calibration/calibration/registration_uncertainty.hpp"

#include <utility>

#include "spherical_actuator_calibration/base/cholesky.hpp"
#include "spherical_actuator_calibration/base/error.hpp"
#include "spherical_actuator_calibration/base/yaml_writer.hpp"
#include "spherical_actuator_calibration/estimation/effect_name.hpp"

namespace sac {

std::optional<FrameCovariance> frameCovariance(const std::vector<double>& row_by_row) {
  constexpr double kSymmetric = 1e-6;  // of the norm, of rounded numbers
  const FrameCovariance read(row_by_row.data());
  const FrameCovariance covariance = 0.5 * (read + read.transpose());
  if (!read.isApprox(covariance, kSymmetric) || !Cholesky(covariance).isPositive()) {
    return std::nullopt;
  }
  return covariance;
}

std::vector<double> rowByRow(const FrameCovariance& covariance) {
  const FrameCovariance rows = covariance.transpose();  // stored by columns
  return {rows.data(), rows.data() + rows.size()};
}

std::string inWords(const RegistrationUncertainty& registration) {
  YamlLine line;
  for (const auto& [name, stddev] : {std::pair{"stator_tracker", registration.stator_tracker},
                                     std::pair{"rotor_marker", registration.rotor_marker},
                                     std::pair{"rotor_ft_sensor", registration.rotor_ft_sensor}}) {
    if (stddev) {
      line.add(name, yamlNumber(*stddev));
    }
  }
  if (registration.tracker_and_marker) {
    line.add("tracker_and_marker", yamlNumbers(rowByRow(*registration.tracker_and_marker)));
  }
  return line.text();
}

void validate(const RegistrationUncertainty& registration) {
  if (registration.tracker_and_marker &&
      (registration.stator_tracker || registration.rotor_marker)) {
    throw ConfigError(
        "registration: tracker_and_marker states stator_tracker and rotor_marker, too: give its "
        "covariance or their stddev, not both.");
  }
}

void stateRegistration(EffectSelection& effects, const RegistrationUncertainty& registration) {
  effects.setStddev(effect_name::kTrackerRegistration, registration.stator_tracker.value_or(0.0));
  effects.setStddev(effect_name::kMarkerRegistration, registration.rotor_marker.value_or(0.0));
  effects.setStddev(effect_name::kTorqueRegistration, registration.rotor_ft_sensor.value_or(0.0));
  if (registration.tracker_and_marker) {
    // Orientations taken by frames that are off by (ξ, ζ) are e^{−ξ̂} R e^{ζ̂}.
    FrameCovariance of_effects = *registration.tracker_and_marker;
    of_effects.topRightCorner<3, 3>() *= -1.0;
    of_effects.bottomLeftCorner<3, 3>() *= -1.0;
    effects.setTogether({"frame_registration",
                         {effect_name::kTrackerRegistration, effect_name::kMarkerRegistration},
                         of_effects});
  }
}

}  // namespace sac
