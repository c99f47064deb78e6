#include "axis_modes.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <utility>

#include <Eigen/LU>

#include "axis_scan.hpp"
#include "effects_at.hpp"
#include "spherical_actuator_calibration/actuator/torque_model.hpp"
#include "spherical_actuator_calibration/base/median.hpp"
#include "spherical_actuator_calibration/base/pi.hpp"
#include "spherical_actuator_calibration/estimation/calibration_state.hpp"
#include "spherical_actuator_calibration/estimation/model_point.hpp"

namespace sac {
namespace {

/// All torques at x, as they depend on single axes. Of each axis it lists those that the axis can
/// change while it stays `within` an angle of the nominal one [rad]: the others say nothing of
/// where it is. What such a torque is, is worked out for the few that are scanned alone.
class ScannedModel {
 public:
  /// Keeps references. `within`: by the first coordinate of an axis.
  template <typename Within>
  ScannedModel(const EstimationProblem& problem,
               const WeightedObservations& observations,
               const Eigen::VectorXd& x,
               const Within& within);

  const TorqueCurve& curve() const { return curve_; }
  ScannedTorques torquesOfPole(std::size_t pole) const;
  ScannedTorques torquesOfCoil(std::size_t coil) const;

 private:
  /// A pole or coil where it is drawn, and the torques that it can change.
  struct Scanned {
    Eigen::Vector3d nominal;  ///< rotor frame for poles, stator frame for coils
    double cos_reach;         ///< of the angle to a partner beyond which it changes nothing
    std::vector<std::uint32_t> torques;      ///< indices of observations; then some of them
    std::size_t all = 0;                     ///< number of all
    std::vector<Eigen::Vector3d> residuals;  ///< of torques, whitened
  };

  double weight(std::size_t pole, std::size_t coil, double current) const {
    const Actuator& nominal = space_.nominal();
    return current * nominal.coils[coil].gain * nominal.poles[pole].polarity *
           nominal.poles[pole].gain * effects_.strength(pole, coil);
  }
  Scanned scanned(const Eigen::Vector3d& nominal, double within) const {
    return {nominal, std::cos(std::min(kPi, curve_.supportEnd() + within)), {}, 0, {}};
  }
  void list(std::size_t observation);
  Eigen::Matrix3d rotorStator(std::size_t observation) const;
  ScannedTorque torque(const Scanned& axis, std::size_t k, const Eigen::Matrix3d& to_rotor) const;
  Excitations excitations(std::size_t observation) const {
    return observations_.evaluator().excitations(observation);
  }
  Eigen::Vector3d torqueOf(const ScannedPartner& partner, const Eigen::Vector3d& pole_rotor) const {
    return partner.weight * pairTorque(curve_, pole_rotor, partner.axis_rotor);
  }

  const EstimationProblem& problem_;
  const WeightedObservations& observations_;
  const ParameterSpace& space_;
  EffectsAt effects_;
  TorqueCurve curve_;
  ModelPoint point_;
  std::vector<Eigen::Vector3d> poles_rotor_;
  std::vector<Eigen::Vector3d> coils_stator_;
  std::vector<Scanned> scanned_poles_;
  std::vector<Scanned> scanned_coils_;
};

/// So many of them, spread over all.
template <typename Item>
std::vector<Item> spread(const std::vector<Item>& items, std::size_t most) {
  if (items.size() <= most) {
    return items;
  }
  // One of each stretch, not always at the same place of it: sessions repeat their patterns.
  constexpr double kGoldenRatio = 0.6180339887498949;
  const double stretch = static_cast<double>(items.size()) / static_cast<double>(most);
  std::vector<Item> chosen;
  chosen.reserve(most);
  double place = 0.0;
  for (std::size_t k = 0; k < most; ++k) {
    place = std::fmod(place + kGoldenRatio, 1.0);
    chosen.push_back(items[static_cast<std::size_t>((static_cast<double>(k) + place) * stretch)]);
  }
  return chosen;
}

/// Enough to tell one basin of the misfit from another.
constexpr std::size_t kMostTorques = 200;

double standsFor(std::size_t all, std::size_t chosen) {
  return chosen == 0 ? 1.0 : static_cast<double>(all) / static_cast<double>(chosen);
}

TorqueCurve curveAt(const CalibrationModel& model, const EffectsAt& effects) {
  const std::optional<TorqueCurve> changed = effects.changedCurve();
  return changed ? *changed : model.curve();
}

template <typename Within>
ScannedModel::ScannedModel(const EstimationProblem& problem,
                           const WeightedObservations& observations,
                           const Eigen::VectorXd& x,
                           const Within& within)
    : problem_(problem),
      observations_(observations),
      space_(problem.model->space()),
      effects_(space_, x),
      curve_(curveAt(*problem.model, effects_)),
      point_(*problem.model, x) {
  for (std::size_t i = 0; i < space_.poles(); ++i) {
    const Eigen::Index at = space_.pole(i);
    poles_rotor_.emplace_back(space_.poleChart(i).axis(x[at], x[at + 1]));
    scanned_poles_.push_back(scanned(space_.poleChart(i).axis(0.0, 0.0), within(at)));
  }
  for (std::size_t j = 0; j < space_.coils(); ++j) {
    const Eigen::Index at = space_.coil(j);
    coils_stator_.emplace_back(space_.coilChart(j).axis(x[at], x[at + 1]));
    scanned_coils_.push_back(scanned(space_.coilChart(j).axis(0.0, 0.0), within(at)));
  }
  for (std::size_t n = 0; n < problem.observations.size(); ++n) {
    if (problem.observations[n].quantity == Quantity::kTorque) {
      list(n);
    }
  }
  // Of so many torques each other list would cost as much as the samples.
  for (std::vector<Scanned>* axes : {&scanned_poles_, &scanned_coils_}) {
    for (Scanned& axis : *axes) {
      axis.all = axis.torques.size();
      axis.torques = spread(axis.torques, kMostTorques);
    }
  }
  const std::vector<Eigen::Vector3d> residuals = observations.residuals(x);
  for (std::vector<Scanned>* axes : {&scanned_poles_, &scanned_coils_}) {
    for (Scanned& axis : *axes) {
      for (const std::size_t n : axis.torques) {
        axis.residuals.push_back(residuals[n]);
      }
    }
  }
}

Eigen::Matrix3d ScannedModel::rotorStator(std::size_t observation) const {
  return point_.orientation((*problem_.samples)[problem_.observations[observation].sample])
      .transpose();
}

/// Lists a torque with the axes that can change it.
void ScannedModel::list(std::size_t observation) {
  const auto index = static_cast<std::uint32_t>(observation);
  const Eigen::Matrix3d R_rotor_stator = rotorStator(observation);
  for (const Excitation& excitation : excitations(observation)) {
    Scanned& own = scanned_coils_[excitation.coil];
    const Eigen::Vector3d nominal = R_rotor_stator * own.nominal;
    if (std::any_of(poles_rotor_.begin(), poles_rotor_.end(), [&](const Eigen::Vector3d& pole) {
          return nominal.dot(pole) > own.cos_reach;
        })) {
      own.torques.push_back(index);
    }
    const Eigen::Vector3d coil = R_rotor_stator * coils_stator_[excitation.coil];
    for (Scanned& pole : scanned_poles_) {
      const bool is_listed = !pole.torques.empty() && pole.torques.back() == index;
      if (!is_listed && pole.nominal.dot(coil) > pole.cos_reach) {
        pole.torques.push_back(index);
      }
    }
  }
}

/// As far as it does not depend on which axis is scanned.
ScannedTorque ScannedModel::torque(const Scanned& axis,
                                   std::size_t k,
                                   const Eigen::Matrix3d& to_rotor) const {
  const Eigen::Matrix3d W = observations_.whitening()[axis.torques[k]];
  return {W.inverse() * axis.residuals[k], to_rotor, W, {}};
}

ScannedTorques ScannedModel::torquesOfPole(std::size_t pole) const {
  const Scanned& own = scanned_poles_[pole];
  ScannedTorques result{{}, standsFor(own.all, own.torques.size())};
  for (std::size_t k = 0; k < own.torques.size(); ++k) {
    const std::size_t n = own.torques[k];
    const Eigen::Matrix3d R_rotor_stator = rotorStator(n);
    ScannedTorque scanned = torque(own, k, Eigen::Matrix3d::Identity());
    for (const Excitation& excitation : excitations(n)) {
      const ScannedPartner partner{R_rotor_stator * coils_stator_[excitation.coil],
                                   weight(pole, excitation.coil, excitation.current)};
      if (own.nominal.dot(partner.axis_rotor) > own.cos_reach) {
        scanned.rest += torqueOf(partner, poles_rotor_[pole]);
        scanned.partners.push_back(partner);
      }
    }
    result.torques.push_back(std::move(scanned));
  }
  return result;
}

ScannedTorques ScannedModel::torquesOfCoil(std::size_t coil) const {
  const Scanned& own = scanned_coils_[coil];
  ScannedTorques result{{}, standsFor(own.all, own.torques.size())};
  for (std::size_t k = 0; k < own.torques.size(); ++k) {
    const std::size_t n = own.torques[k];
    const Eigen::Matrix3d R_rotor_stator = rotorStator(n);
    ScannedTorque scanned = torque(own, k, R_rotor_stator);
    const ScannedPartner self{R_rotor_stator * coils_stator_[coil], 1.0};
    const Eigen::Vector3d nominal = R_rotor_stator * own.nominal;
    const Excitations excited = excitations(n);
    const auto* const excitation =
        std::find_if(excited.begin(), excited.end(), [coil](const Excitation& each) {
          return each.coil == coil;
        });
    for (std::size_t i = 0; i < poles_rotor_.size(); ++i) {
      if (nominal.dot(poles_rotor_[i]) > own.cos_reach) {
        scanned.partners.push_back({poles_rotor_[i], weight(i, coil, excitation->current)});
        scanned.rest += scanned.partners.back().weight * torqueOf(self, poles_rotor_[i]);
      }
    }
    result.torques.push_back(std::move(scanned));
  }
  return result;
}

/// Squared distance of places from the drawing, in tolerances of manufacture; in the scatter of the
/// unit's own axes where they lie farther off than that.
class DrawingDistance {
 public:
  DrawingDistance(const ParameterSpace& space,
                  const Eigen::VectorXd& x,
                  const ManufacturingTolerance& tolerance)
      : space_(space), tolerance_(tolerance), scatter_(scatterOf(space, x)) {}

  double operator()(Eigen::Index first, const Eigen::Vector2d& place) const {
    const double tolerance = toleranceOf(space_.id(first).kind, tolerance_);
    const double usual = std::max(tolerance, scatter_);
    return tolerance > 0.0 ? place.squaredNorm() / (usual * usual) : 0.0;
  }

 private:
  /// Standard deviation of a coordinate, by the median of the axes that were moved.
  static double scatterOf(const ParameterSpace& space, const Eigen::VectorXd& x) {
    constexpr std::size_t kLeast = 8;
    constexpr double kMedianOfTwo = 1.386;  // of the χ² distribution with two degrees of freedom
    std::vector<double> squares;
    for (Eigen::Index p = space.pole(0); p < space.effect(); p += ParameterSpace::kPerAxis) {
      const double square = x.segment<2>(p).squaredNorm();
      if (square > 0.0) {
        squares.push_back(square);
      }
    }
    if (squares.size() < kLeast) {
      return 0.0;
    }
    return std::sqrt(medianOf(std::move(squares)) / kMedianOfTwo);
  }

  const ParameterSpace& space_;
  const ManufacturingTolerance& tolerance_;
  double scatter_;
};

}  // namespace

std::vector<AxisMode> otherModes(const EstimationProblem& problem,
                                 const WeightedObservations& observations,
                                 const Eigen::VectorXd& x,
                                 const std::vector<Eigen::Index>& estimated,
                                 const ModeSearch& search) {
  std::vector<AxisMode> modes;
  const ParameterSpace& space = problem.model->space();
  const auto is_estimated = [&](Eigen::Index first) {
    return std::binary_search(estimated.begin(), estimated.end(), first) &&
           std::binary_search(estimated.begin(), estimated.end(), first + 1);
  };
  if (!problem.model->hasTorqueModel()) {
    return modes;
  }
  // The present place may be farther off than the scan looks.
  const auto within = [&](Eigen::Index first) {
    return std::max(AxisScan::reach(search.range), 1.1 * x.segment<2>(first).norm());
  };
  const ScannedModel model(problem, observations, x, within);
  const TabulatedCurve tabulated_curve(model.curve());
  // Few torques may fit elsewhere as well by chance. The prior is no judge: an earlier cycle may
  // have left it in the wrong place.
  const DrawingDistance distance(space, x, search.tolerance);
  const auto scan =
      [&](Eigen::Index first, const AxisChart& chart, bool is_pole, ScannedTorques torques) {
        const Eigen::Vector2d present = x.segment<2>(first);
        const AxisScan axis(model.curve(),
                            tabulated_curve,
                            chart,
                            is_pole,
                            std::move(torques),
                            search.range,
                            search.transition);
        for (const ScannedPlace& other : axis.others(present)) {
          modes.push_back({first,
                           other.place,
                           other.gain + distance(first, present) - distance(first, other.place)});
        }
      };
  for (std::size_t i = 0; i < space.poles(); ++i) {
    if (is_estimated(space.pole(i))) {
      const Eigen::Index first = space.pole(i);
      scan(first, space.poleChart(i), true, model.torquesOfPole(i));
    }
  }
  for (std::size_t j = 0; j < space.coils(); ++j) {
    if (is_estimated(space.coil(j))) {
      const Eigen::Index first = space.coil(j);
      scan(first, space.coilChart(j), false, model.torquesOfCoil(j));
    }
  }
  return modes;
}

}  // namespace sac
