#include "unstated_registration.hpp"

namespace sac {

std::string unstatedRegistrationInWords(const RegistrationUncertainty& registration,
                                        bool used_torques) {
  std::string names;
  const auto add = [&names](const char* name) {
    names += std::string(names.empty() ? "" : ", ") + name;
  };
  if (!registration.stator_tracker && !registration.tracker_and_marker) {
    add("stator_tracker");
  }
  if (!registration.rotor_marker && !registration.tracker_and_marker) {
    add("rotor_marker");
  }
  if (used_torques && !registration.rotor_ft_sensor) {
    add("rotor_ft_sensor");
  }
  const bool are_several = names.find(',') != std::string::npos;
  return names.empty() ? names
                       : ", but their uncertainty is relative to the registrations, which count "
                         "as exact because registration." +
                             names + (are_several ? " are not stated" : " is not stated");
}

}  // namespace sac
