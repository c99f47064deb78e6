#include "spherical_actuator_calibration/calibration/cycle_selection.hpp"

#include <algorithm>
#include <charconv>
#include <cstddef>
#include <iterator>

#include "cycle_demand.hpp"
#include "spherical_actuator_calibration/base/error.hpp"
#include "spherical_actuator_calibration/base/numbering.hpp"

namespace sac {
namespace {

[[noreturn]] void throwUnknown(const std::string& word) {
  throw ConfigError("The cycle \"" + word +
                    "\" is unknown: give joint, poles:J, coil:J (J counts coils from 1), coils, "
                    "refine or motion, separated by commas.");
}

/// The coil of a number: digits only, from 1.
std::optional<std::size_t> parseCoil(const std::string& digits, const std::string& word) {
  std::size_t number = 0;
  const char* end = digits.data() + digits.size();
  const std::from_chars_result result = std::from_chars(digits.data(), end, number);
  if (result.ec != std::errc{} || result.ptr != end || number == 0) {
    throwUnknown(word);
  }
  return indexOf(number);
}

CycleRequest parseCycle(const std::string& word) {
  if (word == "joint") {
    return {Cycle::kJoint};
  }
  if (word == "coils") {
    return {Cycle::kCoil};
  }
  if (word == "refine") {
    return {Cycle::kRefine};
  }
  if (word == "motion") {
    return {Cycle::kMotion};
  }
  const std::size_t colon = word.find(':');
  const std::string name = word.substr(0, colon);
  if (colon == std::string::npos || (name != "poles" && name != "coil")) {
    throwUnknown(word);
  }
  return {name == "poles" ? Cycle::kPoles : Cycle::kCoil, parseCoil(word.substr(colon + 1), word)};
}

/// expandCoils() by counts.
std::vector<CycleRequest> expanded(const std::vector<CycleRequest>& requests,
                                   const std::vector<std::size_t>& per_coil) {
  std::vector<CycleRequest> result;
  std::vector<bool> is_covered(per_coil.size(), false);
  const auto take = [&](const CycleRequest& request) {
    result.push_back(request);
    if (request.coil && *request.coil < is_covered.size()) {
      is_covered[*request.coil] = true;
    }
  };
  for (const CycleRequest& request : requests) {
    if (request.cycle != Cycle::kCoil || request.coil) {
      take(request);
      continue;
    }
    for (std::size_t coil = 0; coil < per_coil.size(); ++coil) {
      if (per_coil[coil] > 0 && !is_covered[coil]) {
        take({Cycle::kCoil, coil});
      }
    }
  }
  return result;
}

/// possibleCycles() by counts.
std::vector<CycleRequest> possible(const CalibrationModel& model, const SampleCounts& counts) {
  std::vector<CycleRequest> requests;
  const bool has_orientations = counts.orientations() > 0;
  if (has_orientations) {
    requests.push_back({Cycle::kJoint});
  }
  const std::vector<std::size_t>& per_coil = counts.perCoil();
  const auto most = std::max_element(per_coil.begin(), per_coil.end());
  const bool has_torques = most != per_coil.end() && *most > 0;
  if (has_torques) {
    const auto coil = static_cast<std::size_t>(std::distance(per_coil.begin(), most));
    requests.push_back({Cycle::kPoles, coil});
    requests.push_back({Cycle::kCoil});
  }
  const bool models_effects = model.space().effects().size() > 0;
  if (has_torques || counts.ofSeveralCoils() > 0 || (has_orientations && models_effects)) {
    requests.push_back({Cycle::kRefine});
  }
  return expanded(requests, per_coil);
}

}  // namespace

std::vector<CycleRequest> parseCycles(const std::string& text) {
  std::vector<CycleRequest> requests;
  for (std::size_t begin = 0; begin <= text.size();) {
    const std::size_t end = std::min(text.find(',', begin), text.size());
    requests.push_back(parseCycle(text.substr(begin, end - begin)));
    begin = end + 1;
  }
  return requests;
}

std::vector<CycleRequest> expandCoils(const std::vector<CycleRequest>& requests,
                                      const CalibrationModel& model,
                                      const std::vector<Sample>& samples,
                                      const EstimationOptions& options) {
  return expanded(requests, SampleCounts(model, options, samples).perCoil());
}

std::vector<CycleRequest> possibleCycles(const CalibrationModel& model,
                                         const std::vector<Sample>& samples,
                                         const EstimationOptions& options) {
  return possible(model, SampleCounts(model, options, samples));
}

std::vector<CycleRequest> nextCycles(const CalibrationModel& model, const SampleCounts& counts) {
  std::vector<CycleRequest> cycles;
  const auto has_samples = [&](const CycleRequest& request) {
    switch (request.cycle) {
      case Cycle::kJoint:
        return counts.enoughForJoint();
      case Cycle::kPoles:
      case Cycle::kCoil:
        return counts.perCoil().at(request.coil.value()) >=
               demandOf(request.cycle, model.space().poles()).needed;
      case Cycle::kRefine:
      case Cycle::kMotion:
        break;
    }
    // What one cycle has enough of, all at once have; without, torques of several coils at a time.
    return !cycles.empty() || counts.enoughForRefinement();
  };
  bool has_poles = false;
  for (const CycleRequest& request : possible(model, counts)) {
    if (!has_samples(request)) {
      continue;
    }
    has_poles = has_poles || request.cycle == Cycle::kPoles;
    if (request.cycle != Cycle::kCoil || has_poles) {
      cycles.push_back(request);
    }
  }
  return cycles;
}

std::string cycleText(const CycleRequest& request) {
  const bool has_coil = request.cycle == Cycle::kPoles || request.cycle == Cycle::kCoil;
  return cycleName(request.cycle) +
         (has_coil ? ":" + std::to_string(numberOrZero(request.coil)) : "");
}

}  // namespace sac
