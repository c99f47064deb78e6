#include "spherical_actuator_calibration/calibration/cycle_problem.hpp"

#include <algorithm>

namespace sac {
namespace {

/// Whether a coordinate of the effects acts on any observation.
bool concerns(const EffectLayout& effects,
              Eigen::Index coordinate,
              bool any_orientation,
              const std::vector<bool>& excited) {
  const PlacedEffect& placed = effects.at(coordinate);
  switch (placed.acts_on) {
    case LaboratoryEffect::ActsOn::kEverything:
      return true;
    case LaboratoryEffect::ActsOn::kOrientations:
      return any_orientation;
    case LaboratoryEffect::ActsOn::kMotion:
      return false;
    case LaboratoryEffect::ActsOn::kTorques:
      break;
  }
  return std::find(excited.begin(), excited.end(), true) != excited.end() &&
         placed.effect->isToldBy(coordinate - placed.first, excited);
}

bool isCycleOf(Cycle cycle, LaboratoryEffect::ActsOn acts_on) {
  return acts_on == LaboratoryEffect::ActsOn::kOrientations ? cycle == Cycle::kJoint
                                                            : cycle == Cycle::kPoles;
}

/// Per coil: a sample that serves the cycle excites it.
std::vector<bool> excitedInCycle(const ParameterSpace& space,
                                 const std::vector<Sample>& samples,
                                 const CycleRequest& request,
                                 const EstimationOptions& options) {
  std::vector<bool> excited(space.coils(), false);
  if (request.cycle == Cycle::kPoles || request.cycle == Cycle::kCoil) {
    excited.at(request.coil.value()) = true;
  }
  if (request.cycle != Cycle::kRefine) {
    return excited;
  }
  for (const Observation& observation : selectObservations(space, samples, request, options)) {
    if (observation.quantity == Quantity::kTorque) {
      for (const Excitation& e :
           excitedCoils(samples[observation.sample], options.current_threshold)) {
        excited.at(e.coil) = true;
      }
    }
  }
  return excited;
}

}  // namespace

std::vector<Observation> selectObservations(const ParameterSpace& space,
                                            const std::vector<Sample>& samples,
                                            const CycleRequest& request,
                                            const EstimationOptions& options) {
  std::vector<Observation> observations;
  for (std::size_t n = 0; n < samples.size(); ++n) {
    const Sample& sample = samples[n];
    if (sample.validation) {
      continue;
    }
    const bool wants_orientation =
        space.joints() > 0 && (request.cycle == Cycle::kJoint || request.cycle == Cycle::kRefine);
    if (wants_orientation && sample.has_orientation) {
      observations.push_back({n, Quantity::kOrientation});
    }
    if (request.cycle == Cycle::kJoint || !sample.has_torque) {
      continue;
    }
    const std::vector<Excitation> excited = excitedCoils(sample, options.current_threshold);
    const bool serves = request.cycle == Cycle::kRefine
                            ? !excited.empty()
                            : excited.size() == 1 && excited.front().coil == request.coil;
    if (serves) {
      observations.push_back({n, Quantity::kTorque});
    }
  }
  observations.shrink_to_fit();
  return observations;
}

std::vector<Eigen::Index> selectCoordinates(const ParameterSpace& space,
                                            const std::vector<Sample>& samples,
                                            const CycleRequest& request,
                                            const EstimationOptions& options) {
  const bool refines = request.cycle == Cycle::kRefine;
  std::vector<Eigen::Index> coordinates;
  const auto add = [&](Eigen::Index first, Eigen::Index last) {
    for (Eigen::Index p = first; p < last; ++p) {
      coordinates.push_back(p);
    }
  };
  if (request.cycle == Cycle::kJoint || refines) {
    add(0, space.pole(0));
  }
  const std::vector<bool> excited = excitedInCycle(space, samples, request, options);
  const bool any_coil = std::find(excited.begin(), excited.end(), true) != excited.end();
  if (request.cycle == Cycle::kPoles || (refines && any_coil)) {
    add(space.pole(0), space.coil(0));
  }
  for (std::size_t j = 0; j < excited.size(); ++j) {
    if (excited[j]) {
      add(space.coil(j), space.coil(j) + ParameterSpace::kPerAxis);
    }
  }
  const bool any_orientation = std::any_of(samples.begin(), samples.end(), [](const Sample& s) {
    return s.has_orientation && !s.validation;
  });
  const bool any_effect = refines || request.cycle != Cycle::kCoil;
  for (Eigen::Index e = 0; any_effect && e < space.effects().size(); ++e) {
    // What is stated beforehand belongs to every cycle that it acts on; but a coil follows the
    // poles, whose cycle knows the force/torque sensor's frame already.
    const bool is_tried = refines || (space.effects().statedVariance(e) > 0.0 &&
                                      isCycleOf(request.cycle, space.effects().at(e).acts_on));
    if (is_tried && concerns(space.effects(), e, any_orientation, excited)) {
      coordinates.push_back(space.effect() + e);
    }
  }
  return coordinates;
}

}  // namespace sac
