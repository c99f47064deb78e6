#include "start_state.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include "covariance_record.hpp"
#include "spherical_actuator_calibration/base/pseudo_inverse.hpp"

namespace sac {
namespace {

using BelongsTo = LaboratoryEffect::BelongsTo;

/// Enters what a calibrated description states into a state.
class StatedUncertainty {
 public:
  StatedUncertainty(const ParameterSpace& space, CalibrationState& state)
      : space_(space), state_(state) {}

  void enter(const ParameterStddevs& stddevs) const {
    for (std::size_t k = 0; k < space_.joints(); ++k) {
      enter(space_.joint(k), stddevs.joints[k].offset, 1.0);
      enter(space_.joint(k) + 1, stddevs.joints[k].axis_u, 1.0);
      enter(space_.joint(k) + 2, stddevs.joints[k].axis_v, 1.0);
    }
    for (std::size_t i = 0; i < stddevs.poles.size(); ++i) {
      enterAngles(space_.pole(i), stddevs.poles[i], space_.nominal().poles[i].polar);
    }
    for (std::size_t j = 0; j < stddevs.coils.size(); ++j) {
      enterAngles(space_.coil(j), stddevs.coils[j], space_.nominal().coils[j].polar);
    }
  }

 private:
  // Coordinate v of an axis is cos(polar) times the azimuth (AxisChart::aroundAngles).
  void enterAngles(Eigen::Index at, const AxisStddev& stddev, double polar) const {
    enter(at, stddev.polar, 1.0);
    enter(at + 1, stddev.azimuth, std::cos(polar));
  }

  void enter(Eigen::Index at, const std::optional<double>& stddev, double scale) const {
    if (stddev) {
      state_.belief.covariance(at, at) = std::pow(scale * *stddev, 2);
      state_.identified[static_cast<std::size_t>(at)] = true;
    }
  }

  const ParameterSpace& space_;
  CalibrationState& state_;
};

/// What the parameters of a record have in common, for a space that may model other effects.
class RecordedCovariance {
 public:
  /// `recorded` is the space of the record. Effects of the laboratory are left out: the next one
  /// states its own.
  RecordedCovariance(const ParameterSpace& space, const ParameterSpace& recorded) {
    for (Eigen::Index p = 0; p < recorded.size(); ++p) {
      if (!isOfMachine(recorded, p)) {
        continue;
      }
      const std::optional<Eigen::Index> place = placeOf(space, recorded.name(p));
      if (place) {
        kept_.push_back(p);
        places_.push_back(*place);
      } else {
        exact_.push_back(p);
      }
    }
  }

  // What is not modelled any more counts as exact: the rest is as certain as it is beside that.
  void enter(const Eigen::MatrixXd& covariance, CalibrationState& state) const {
    Eigen::MatrixXd known = covariance(kept_, kept_);
    if (!exact_.empty()) {
      const Eigen::MatrixXd common = covariance(exact_, kept_);
      const Eigen::MatrixXd exact = covariance(exact_, exact_);
      known -= common.transpose() * pseudoInverse(exact) * common;
      known = (0.5 * (known + known.transpose())).eval();
    }
    state.belief.covariance(places_, places_) = known;
    for (const Eigen::Index place : places_) {
      state.identified[static_cast<std::size_t>(place)] = true;
    }
  }

 private:
  static bool isOfMachine(const ParameterSpace& recorded, Eigen::Index p) {
    if (p < recorded.effect()) {
      return true;
    }
    const BelongsTo owner = recorded.effects().at(p - recorded.effect()).belongs_to;
    return owner == BelongsTo::kActuator || owner == BelongsTo::kLoad;
  }

  static std::optional<Eigen::Index> placeOf(const ParameterSpace& space, const std::string& name) {
    for (Eigen::Index p = 0; p < space.size(); ++p) {
      if (space.name(p) == name) {
        return p;
      }
    }
    return std::nullopt;
  }

  std::vector<Eigen::Index> kept_;    ///< of the record
  std::vector<Eigen::Index> places_;  ///< of the kept ones in the space
  std::vector<Eigen::Index> exact_;   ///< of the record
};

/// The weight that the rotor carries is no deviation from what its description says.
void enterWeight(const ParameterSpace& space, CalibrationState& state) {
  for (const PlacedEffect& placed : space.effects().effects()) {
    if (placed.belongs_to == BelongsTo::kLoad) {
      state.belief.x.segment(space.effect() + placed.first, placed.size()) =
          space.nominal().unbalance / placed.effect->scale();
    }
  }
}

}  // namespace

CalibrationState startState(const ParameterSpace& space,
                            const CalibratedDescription& start,
                            const ManufacturingTolerance& tolerance) {
  CalibrationState state = nominalState(space, tolerance);
  enterWeight(space, state);
  if (start.calibration && start.calibration->covariance) {
    const ParameterSpace recorded(space.nominal(), effectsOf(start.calibration));
    RecordedCovariance(space, recorded).enter(coordinateCovariance(recorded, start), state);
  } else {
    StatedUncertainty(space, state).enter(start.stddevs);
  }
  if (start.calibration) {
    const std::vector<std::string>& open = start.calibration->unidentified;
    for (Eigen::Index p = 0; p < space.size(); ++p) {
      if (std::find(open.begin(), open.end(), space.name(p)) != open.end()) {
        state.identified[static_cast<std::size_t>(p)] = false;
      }
    }
  }
  return state;
}

}  // namespace sac
