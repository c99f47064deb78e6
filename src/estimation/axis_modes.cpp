#include "axis_modes.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <utility>

#include <Eigen/LU>

#include "axis_scan.hpp"
#include "effects_at.hpp"
#include "spherical_actuator_calibration/actuator/spherical_joint.hpp"
#include "spherical_actuator_calibration/actuator/torque_model.hpp"
#include "spherical_actuator_calibration/base/median.hpp"
#include "spherical_actuator_calibration/base/pi.hpp"
#include "spherical_actuator_calibration/estimation/calibration_state.hpp"

namespace sac {
namespace {

/// All torques at x, as they depend on single axes.
class ScannedModel {
 public:
  ScannedModel(const EstimationProblem& problem,
               const WeightedObservations& observations,
               const Eigen::VectorXd& x);

  const TorqueCurve& curve() const { return curve_; }
  /// Those that the axis can change while it stays within an angle of the nominal one [rad]: the
  /// others say nothing of where it is.
  ScannedTorques torquesOfPole(std::size_t pole, double within) const;
  ScannedTorques torquesOfCoil(std::size_t coil, double within) const;

 private:
  struct Torque {
    Eigen::Vector3d residual;
    Eigen::Matrix3d R_rotor_stator;
    Eigen::Matrix3d whitening;
    const std::vector<Excitation>* excitations;
  };
  /// One coil of one torque.
  struct Exerted {
    std::size_t torque;
    double current;  ///< [A]
  };

  double weight(std::size_t pole, std::size_t coil, double current) const {
    const Actuator& nominal = space_.nominal();
    return current * nominal.coils[coil].gain * nominal.poles[pole].polarity *
           nominal.poles[pole].gain * effects_.strength(pole, coil);
  }
  /// Cosine of the angle between two axes beyond which they do not interact, wherever one of them
  /// is within an angle [rad].
  double cosReach(double within) const {
    return std::cos(std::min(kPi, curve_.supportEnd() + within));
  }
  Eigen::Vector3d torqueOf(const ScannedPartner& partner, const Eigen::Vector3d& pole_rotor) const {
    return partner.weight * pairTorque(curve_, pole_rotor, partner.axis_rotor);
  }

  const ParameterSpace& space_;
  EffectsAt effects_;
  TorqueCurve curve_;
  std::vector<Eigen::Vector3d> poles_rotor_;
  std::vector<Eigen::Vector3d> coils_stator_;
  std::vector<Torque> torques_;
  std::vector<std::vector<Exerted>> by_coil_;
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

ScannedModel::ScannedModel(const EstimationProblem& problem,
                           const WeightedObservations& observations,
                           const Eigen::VectorXd& x)
    : space_(problem.model->space()),
      effects_(space_, x),
      curve_(curveAt(*problem.model, effects_)),
      by_coil_(space_.coils()) {
  for (std::size_t i = 0; i < space_.poles(); ++i) {
    const Eigen::Index at = space_.pole(i);
    poles_rotor_.emplace_back(space_.poleChart(i).axis(x[at], x[at + 1]));
  }
  for (std::size_t j = 0; j < space_.coils(); ++j) {
    const Eigen::Index at = space_.coil(j);
    coils_stator_.emplace_back(space_.coilChart(j).axis(x[at], x[at + 1]));
  }
  const JointGeometry joints = jointGeometry(space_.actuatorAt(x));
  const std::vector<Eigen::Vector3d> residuals = observations.residuals(x);
  for (std::size_t n = 0; n < problem.observations.size(); ++n) {
    if (problem.observations[n].quantity != Quantity::kTorque) {
      continue;
    }
    const Eigen::Vector3d& reading =
        (*problem.samples)[problem.observations[n].sample].joint_position;
    const Eigen::Vector3d q = reading + effects_.readingColumns(reading) * effects_.values();
    const Eigen::Matrix3d& W = observations.whitening()[n];
    for (const Excitation& excitation : observations.evaluator().excitations(n)) {
      by_coil_[excitation.coil].push_back({torques_.size(), excitation.current});
    }
    torques_.push_back({W.partialPivLu().solve(residuals[n]),
                        rotorOrientation(joints, q).transpose(),
                        W,
                        &observations.evaluator().excitations(n)});
  }
}

ScannedTorques ScannedModel::torquesOfPole(std::size_t pole, double within) const {
  const double cos_reach = cosReach(within);
  const Eigen::Vector3d nominal = space_.poleChart(pole).axis(0.0, 0.0);
  const auto is_near = [&](const Torque& torque, const Excitation& excitation) {
    return nominal.dot(torque.R_rotor_stator * coils_stator_[excitation.coil]) > cos_reach;
  };
  std::vector<const Torque*> near;
  for (const Torque& torque : torques_) {
    if (std::any_of(torque.excitations->begin(), torque.excitations->end(), [&](const auto& coil) {
          return is_near(torque, coil);
        })) {
      near.push_back(&torque);
    }
  }
  const std::vector<const Torque*> chosen = spread(near, kMostTorques);
  ScannedTorques result{{}, standsFor(near.size(), chosen.size())};
  for (const Torque* torque : chosen) {
    ScannedTorque scanned{torque->residual, Eigen::Matrix3d::Identity(), torque->whitening, {}};
    for (const Excitation& excitation : *torque->excitations) {
      if (is_near(*torque, excitation)) {
        const ScannedPartner partner{torque->R_rotor_stator * coils_stator_[excitation.coil],
                                     weight(pole, excitation.coil, excitation.current)};
        scanned.rest += torqueOf(partner, poles_rotor_[pole]);
        scanned.partners.push_back(partner);
      }
    }
    result.torques.push_back(std::move(scanned));
  }
  return result;
}

ScannedTorques ScannedModel::torquesOfCoil(std::size_t coil, double within) const {
  const double cos_reach = cosReach(within);
  const Eigen::Vector3d nominal = space_.coilChart(coil).axis(0.0, 0.0);
  const auto is_near = [&](const Exerted& exerted, std::size_t pole) {
    return (torques_[exerted.torque].R_rotor_stator * nominal).dot(poles_rotor_[pole]) > cos_reach;
  };
  std::vector<Exerted> near;
  for (const Exerted& exerted : by_coil_[coil]) {
    for (std::size_t i = 0; i < poles_rotor_.size(); ++i) {
      if (is_near(exerted, i)) {
        near.push_back(exerted);
        break;
      }
    }
  }
  const std::vector<Exerted> chosen = spread(near, kMostTorques);
  ScannedTorques result{{}, standsFor(near.size(), chosen.size())};
  for (const Exerted& exerted : chosen) {
    const Torque& torque = torques_[exerted.torque];
    ScannedTorque scanned{torque.residual, torque.R_rotor_stator, torque.whitening, {}};
    const ScannedPartner self{torque.R_rotor_stator * coils_stator_[coil], 1.0};
    for (std::size_t i = 0; i < poles_rotor_.size(); ++i) {
      if (is_near(exerted, i)) {
        scanned.partners.push_back({poles_rotor_[i], weight(i, coil, exerted.current)});
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
  const ScannedModel model(problem, observations, x);
  const CoarseCurve coarse_curve(model.curve());
  // The present place may be farther off than the scan looks.
  const auto within = [&](Eigen::Index first) {
    return std::max(AxisScan::reach(search.range), 1.1 * x.segment<2>(first).norm());
  };
  // Few torques may fit elsewhere as well by chance. The prior is no judge: an earlier cycle may
  // have left it in the wrong place.
  const DrawingDistance distance(space, x, search.tolerance);
  const auto scan =
      [&](Eigen::Index first, const AxisChart& chart, bool is_pole, ScannedTorques torques) {
        const Eigen::Vector2d present = x.segment<2>(first);
        const AxisScan axis(model.curve(),
                            coarse_curve,
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
      scan(first, space.poleChart(i), true, model.torquesOfPole(i, within(first)));
    }
  }
  for (std::size_t j = 0; j < space.coils(); ++j) {
    if (is_estimated(space.coil(j))) {
      const Eigen::Index first = space.coil(j);
      scan(first, space.coilChart(j), false, model.torquesOfCoil(j, within(first)));
    }
  }
  return modes;
}

}  // namespace sac
