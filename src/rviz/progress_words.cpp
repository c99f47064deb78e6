#include "progress_words.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <optional>
#include <vector>

#include "signed_degrees.hpp"
#include "spherical_actuator_calibration/base/numbering.hpp"
#include "spherical_actuator_calibration/base/printable_text.hpp"
#include "spherical_actuator_calibration/base/text_format.hpp"

namespace sac {
namespace {

using msg::MeasurementProgress;

std::string coilsInWords(const MeasurementProgress& progress) {
  std::string text;
  for (const std::int32_t coil : progress.coils) {
    text += (text.empty() ? "" : " ") + std::to_string(coil);
  }
  return text;
}

std::string inAmperes(double current) {
  return format("%.3f A", current);
}

/// "1.998 A, the others at most 0.004 A." of measured currents [A]; `coils` as in a message.
std::string currentsInWords(const std::vector<std::int32_t>& coils,
                            const std::vector<double>& measured) {
  std::string text;
  std::vector<double> others = measured;
  for (const std::int32_t coil : coils) {
    const auto number = static_cast<std::size_t>(std::abs(std::int64_t{coil}));
    const std::optional<std::size_t> j = indexOf(number);
    if (j && *j < measured.size()) {
      text += (text.empty() ? "" : ", ") + inAmperes(measured[*j]);
      others[*j] = 0.0;
    }
  }
  double most = 0.0;
  for (const double current : others) {
    most = std::max(most, std::abs(current));
  }
  return text + ", the others at most " + inAmperes(most) + ".";
}

std::string stageInWords(const MeasurementProgress& progress) {
  if (progress.stage == MeasurementProgress::TURNING) {
    return "Waiting until the rotor rests there …";
  }
  return progress.coils.empty() ? "Measuring without current …"
                                : "Measuring with coil " + coilsInWords(progress) + " …";
}

/// What a session does that is not at a pose.
std::string courseInWords(const MeasurementProgress& progress) {
  if (progress.stage == MeasurementProgress::PLANNING) {
    return "Planning …";
  }
  if (progress.stage == MeasurementProgress::ESTIMATING) {
    return "Calibrating …";
  }
  if (progress.stage == MeasurementProgress::SAVING) {
    return "Validating and saving …";
  }
  return progress.stage == MeasurementProgress::ENDED ? "It ends …" : "It begins …";
}

/// "Turn joint_1 by +12.3°, joint_3 by −4.0°."; empty where the rotor is at the pose.
std::string wayInWords(const MeasurementProgress& progress) {
  std::string turns;
  for (std::size_t k = 0; k < progress.way.size() && k < progress.joint_names.size(); ++k) {
    if (std::abs(progress.way[k]) > progress.tolerance) {
      turns += (turns.empty() ? "Turn " : ", ") + printable(progress.joint_names[k]) + " by " +
               signedDegrees(progress.way[k]);
    }
  }
  return turns.empty() ? "" : turns + ".";
}

}  // namespace

std::string sessionInWords(const MeasurementProgress& progress) {
  const std::string leads = "A guided session leads";
  if (progress.pose == 0) {
    return leads + ". " + courseInWords(progress);
  }
  const std::string way = wayInWords(progress);
  return leads + ", pose " + std::to_string(progress.pose) + " of " +
         std::to_string(progress.poses) + (progress.held_out != 0 ? ", held out. " : ". ") +
         (way.empty() ? stageInWords(progress) : way);
}

void ProgressWords::receive(const MeasurementProgress& progress) {
  text_ = stageInWords(progress);
  if (progress.captures != captures_) {
    captures_ = progress.captures;
    told_ = progress.told;
  }
  if (progress.told != told_ && !progress.sentences.empty()) {
    text_ += "\n" + printable(progress.sentences.back());
  }
}

void ExcitationWords::receive(const msg::ExciteFeedback& feedback) {
  const MeasurementProgress& progress = feedback.progress;
  if (progress.stage != MeasurementProgress::EXCITING || progress.coils.empty()) {
    text_ = "Waiting for the laboratory …";
  } else if (feedback.measured.empty()) {
    text_ = "Coil " + coilsInWords(progress) + " is excited, but no measured currents arrive.";
  } else {
    const std::string currents = currentsInWords(progress.coils, feedback.measured);
    text_ = "Coil " + coilsInWords(progress) +
            (progress.carries != 0 ? " carries " : ": measured ") + currents +
            (progress.carries != 0 ? "" : " It does not carry its current yet.");
    if (progress.carries != 0) {
      carried_ = "Coil " + coilsInWords(progress) + " carried " + currents;
    }
  }
  if (progress.carries == 0 && !progress.sentences.empty()) {
    text_ += "\n" + printable(progress.sentences.back());
  }
}

}  // namespace sac
