#include "axis_modes.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>

#include <Eigen/LU>

#include "axis_scan.hpp"
#include "effects_at.hpp"
#include "spherical_actuator_calibration/actuator/spherical_joint.hpp"
#include "spherical_actuator_calibration/actuator/torque_model.hpp"
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
  std::vector<ScannedTorque> torquesOfPole(std::size_t pole) const;
  std::vector<ScannedTorque> torquesOfCoil(std::size_t coil) const;

 private:
  struct Torque {
    Eigen::Vector3d residual;
    Eigen::Matrix3d R_rotor_stator;
    Eigen::Matrix3d whitening;
    const std::vector<Excitation>* excitations;
  };

  double weight(std::size_t pole, const Excitation& excitation) const {
    const Actuator& nominal = space_.nominal();
    return excitation.current * nominal.coils[excitation.coil].gain * nominal.poles[pole].polarity *
           nominal.poles[pole].gain * effects_.strength(pole, excitation.coil);
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
};

TorqueCurve curveAt(const CalibrationModel& model, const EffectsAt& effects) {
  const std::optional<TorqueCurve> changed = effects.changedCurve();
  return changed ? *changed : model.curve();
}

ScannedModel::ScannedModel(const EstimationProblem& problem,
                           const WeightedObservations& observations,
                           const Eigen::VectorXd& x)
    : space_(problem.model->space()),
      effects_(space_, x),
      curve_(curveAt(*problem.model, effects_)) {
  for (std::size_t i = 0; i < space_.poles(); ++i) {
    const Eigen::Index at = space_.pole(i);
    poles_rotor_.emplace_back(space_.poleChart(i).axis(x[at], x[at + 1]));
  }
  for (std::size_t j = 0; j < space_.coils(); ++j) {
    const Eigen::Index at = space_.coil(j);
    coils_stator_.emplace_back(space_.coilChart(j).axis(x[at], x[at + 1]));
  }
  const JointGeometry joints = jointGeometry(space_.actuatorAt(x).joints);
  const std::vector<Eigen::Vector3d> residuals = observations.residuals(x);
  for (std::size_t n = 0; n < problem.observations.size(); ++n) {
    if (problem.observations[n].quantity != Quantity::kTorque) {
      continue;
    }
    const Eigen::Vector3d& reading =
        (*problem.samples)[problem.observations[n].sample].joint_position;
    const Eigen::Vector3d q = reading + effects_.readingColumns(reading) * effects_.values();
    const Eigen::Matrix3d& W = observations.whitening()[n];
    torques_.push_back({W.partialPivLu().solve(residuals[n]),
                        rotorOrientation(joints, q).transpose(),
                        W,
                        &observations.evaluator().excitations(n)});
  }
}

std::vector<ScannedTorque> ScannedModel::torquesOfPole(std::size_t pole) const {
  std::vector<ScannedTorque> result;
  for (const Torque& torque : torques_) {
    ScannedTorque scanned{torque.residual, Eigen::Matrix3d::Identity(), torque.whitening, {}};
    for (const Excitation& excitation : *torque.excitations) {
      const ScannedPartner partner{torque.R_rotor_stator * coils_stator_[excitation.coil],
                                   weight(pole, excitation)};
      scanned.rest += torqueOf(partner, poles_rotor_[pole]);
      scanned.partners.push_back(partner);
    }
    result.push_back(std::move(scanned));
  }
  return result;
}

std::vector<ScannedTorque> ScannedModel::torquesOfCoil(std::size_t coil) const {
  std::vector<ScannedTorque> result;
  for (const Torque& torque : torques_) {
    for (const Excitation& excitation : *torque.excitations) {
      if (excitation.coil != coil) {
        continue;
      }
      ScannedTorque scanned{torque.residual, torque.R_rotor_stator, torque.whitening, {}};
      const ScannedPartner self{torque.R_rotor_stator * coils_stator_[coil], 1.0};
      for (std::size_t i = 0; i < poles_rotor_.size(); ++i) {
        scanned.partners.push_back({poles_rotor_[i], weight(i, excitation)});
        scanned.rest += scanned.partners.back().weight * torqueOf(self, poles_rotor_[i]);
      }
      result.push_back(std::move(scanned));
    }
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
    const auto middle = squares.begin() + static_cast<std::ptrdiff_t>(squares.size() / 2);
    std::nth_element(squares.begin(), middle, squares.end());
    return std::sqrt(*middle / kMedianOfTwo);
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
  // Few torques may fit elsewhere as well by chance. The prior is no judge: an earlier cycle may
  // have left it in the wrong place.
  const DrawingDistance distance(space, x, search.tolerance);
  const auto scan = [&](Eigen::Index first,
                        const AxisChart& chart,
                        bool is_pole,
                        std::vector<ScannedTorque> torques) {
    const Eigen::Vector2d present = x.segment<2>(first);
    const AxisScan axis(
        model.curve(), chart, is_pole, std::move(torques), search.range, search.transition);
    for (const ScannedPlace& other : axis.others(present)) {
      modes.push_back({first,
                       other.place,
                       other.gain + distance(first, present) - distance(first, other.place)});
    }
  };
  for (std::size_t i = 0; i < space.poles(); ++i) {
    if (is_estimated(space.pole(i))) {
      scan(space.pole(i), space.poleChart(i), true, model.torquesOfPole(i));
    }
  }
  for (std::size_t j = 0; j < space.coils(); ++j) {
    if (is_estimated(space.coil(j))) {
      scan(space.coil(j), space.coilChart(j), false, model.torquesOfCoil(j));
    }
  }
  return modes;
}

}  // namespace sac
