#include "effect_candidates.hpp"

#include <cstddef>
#include <utility>

#include "spherical_actuator_calibration/base/numbering.hpp"
#include "spherical_actuator_calibration/estimation/effect_name.hpp"

namespace sac {
namespace {

std::string adviceFor(const std::string& effect) {
  return "measure it anew, or model it: effects: {" + effect + ": true}";
}

/// "joint_3" of "joint_3/cos_1".
std::string ownerOf(const std::string& name) {
  return name.substr(0, name.find('/'));
}

/// Coordinates [begin, end) of a layout whose first column is `first`.
EffectCandidate candidateOf(const EffectLayout& layout,
                            Eigen::Index begin,
                            Eigen::Index end,
                            Eigen::Index first) {
  const PlacedEffect& placed = layout.at(begin);
  const std::string owner = ownerOf(layout.name(begin));
  const bool is_single = end == begin + 1;
  EffectCandidate candidate;
  candidate.name = is_single ? layout.name(begin) : placed.name;
  if (!is_single && owner.rfind("joint_", 0) == 0) {
    candidate.name += " of " + owner;
  }
  candidate.unit = placed.unit;
  candidate.advice = adviceFor(placed.name);
  candidate.first = first + begin;
  for (Eigen::Index n = begin; n < end; ++n) {
    candidate.scales.push_back(layout.scale(n));
  }
  return candidate;
}

/// Those of a layout one by one, each the coordinates of one owner.
std::vector<EffectCandidate> candidatesOf(const EffectLayout& layout, Eigen::Index first) {
  std::vector<EffectCandidate> candidates;
  for (Eigen::Index n = 0; n < layout.size();) {
    Eigen::Index end = n + 1;
    while (end < layout.size() && ownerOf(layout.name(end)) == ownerOf(layout.name(n)) &&
           layout.at(end).name == layout.at(n).name) {
      ++end;
    }
    candidates.push_back(candidateOf(layout, n, end, first));
    n = end;
  }
  return candidates;
}

}  // namespace

std::vector<EffectCandidate> effectCandidates(const FurtherColumns& columns) {
  const ParameterSpace& own = columns.space();
  std::vector<EffectCandidate> candidates;
  for (EffectCandidate& one : candidatesOf(own.effects(), own.effect())) {
    if (own.effects().statedVariance(one.first - own.effect()) > 0.0) {
      one.advice = "it is more than is stated of it: measure it anew";
      candidates.push_back(std::move(one));
    }
  }
  const EffectLayout& further = columns.model().space().effects();
  for (EffectCandidate& one : candidatesOf(further, own.size())) {
    // What the description states is modelled in either.
    if (columns.first(further.at(one.first - own.size()).name) >= own.size()) {
      candidates.push_back(std::move(one));
    }
  }
  for (std::size_t k = 0; k < own.joints(); ++k) {
    candidates.push_back({"joint_" + std::to_string(numberOf(k)) + "/scale",
                          "1",
                          "check the scale of that joint's sensor",
                          columns.scale(k),
                          {1.0}});
  }
  return candidates;
}

std::vector<StepCandidate> stepCandidates(const FurtherColumns& columns) {
  std::vector<StepCandidate> candidates;
  for (const char* name : {effect_name::kMarkerRegistration,
                           effect_name::kTrackerRegistration,
                           effect_name::kTorqueRegistration}) {
    const Eigen::Index first = columns.first(name);
    if (first >= 0) {
      candidates.push_back({name, first, 3});
    }
  }
  for (std::size_t k = 0; k < columns.space().joints(); ++k) {
    candidates.push_back(
        {"joint_" + std::to_string(numberOf(k)) + "/offset", columns.space().joint(k), 1});
  }
  return candidates;
}

}  // namespace sac
