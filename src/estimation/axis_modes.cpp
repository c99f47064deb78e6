#include "axis_modes.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>

#include <Eigen/Cholesky>
#include <Eigen/LU>

#include "effects_at.hpp"
#include "spherical_actuator_calibration/actuator/spherical_joint.hpp"
#include "spherical_actuator_calibration/actuator/torque_model.hpp"
#include "spherical_actuator_calibration/estimation/calibration_state.hpp"

namespace sac {
namespace {

/// Steps of the scan from the nominal axis to its edge. The basins of a torque curve are wider than
/// a step for ranges of up to 0.2 rad.
constexpr int kSteps = 4;
constexpr int kWidth = 2 * kSteps + 1;
/// Nearer places than this many steps are the same mode.
constexpr double kSameMode = 0.5;

/// A pole and a coil of which the one is scanned: where the other is, rotor frame, and the current
/// times all strengths [A].
struct Partner {
  Eigen::Vector3d axis_rotor;
  double weight;
};

/// One torque as a function of the scanned axis alone.
struct ScannedTorque {
  Eigen::Vector3d rest;      ///< measured without what all else exerts [N·m], rotor frame
  Eigen::Matrix3d to_rotor;  ///< of the scanned axis
  Eigen::Matrix3d whitening;
  std::vector<Partner> partners;
};

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
  Eigen::Vector3d torqueOf(const Partner& partner, const Eigen::Vector3d& pole_rotor) const {
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
      const Partner partner{torque.R_rotor_stator * coils_stator_[excitation.coil],
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
      const Partner self{torque.R_rotor_stator * coils_stator_[coil], 1.0};
      for (std::size_t i = 0; i < poles_rotor_.size(); ++i) {
        scanned.partners.push_back({poles_rotor_[i], weight(i, excitation)});
        scanned.rest += scanned.partners.back().weight * torqueOf(self, poles_rotor_[i]);
      }
      result.push_back(std::move(scanned));
    }
  }
  return result;
}

/// The robust misfit of the torques of one axis over its two angles.
class AxisScan {
 public:
  AxisScan(const TorqueCurve& curve,
           const AxisChart& chart,
           bool is_pole,
           std::vector<ScannedTorque> torques,
           const ModeSearch& search)
      : curve_(curve),
        chart_(chart),
        is_pole_(is_pole),
        torques_(std::move(torques)),
        limit_(search.transition * search.transition),
        step_(search.range / kSteps),
        range_(search.range) {}

  /// The best place in another mode than `present`, or none.
  std::optional<AxisMode> best(const Eigen::Vector2d& present) const;

 private:
  /// Half the gradient and half the Gauss–Newton Hessian beside the misfit.
  struct Normal {
    double misfit = 0.0;
    Eigen::Vector2d gradient = Eigen::Vector2d::Zero();
    Eigen::Matrix2d information = Eigen::Matrix2d::Zero();
  };

  double misfit(const Eigen::Vector2d& place) const;
  Normal linearized(const Eigen::Vector2d& place) const;
  Eigen::Vector2d descended(Eigen::Vector2d place) const;
  bool isWithin(const Eigen::Vector2d& place) const {
    return place.cwiseAbs().maxCoeff() <= range_ + step_;
  }
  std::vector<Eigen::Vector2d> localMinima() const;

  const TorqueCurve& curve_;
  const AxisChart& chart_;
  bool is_pole_;
  std::vector<ScannedTorque> torques_;
  double limit_;
  double step_;
  double range_;
};

double AxisScan::misfit(const Eigen::Vector2d& place) const {
  const Eigen::Vector3d axis = chart_.axis(place[0], place[1]);
  double sum = 0.0;
  for (const ScannedTorque& torque : torques_) {
    const Eigen::Vector3d own = torque.to_rotor * axis;
    Eigen::Vector3d rest = torque.rest;
    for (const Partner& partner : torque.partners) {
      if (interacts(curve_, partner.axis_rotor, own)) {
        rest -= partner.weight * (is_pole_ ? pairTorque(curve_, own, partner.axis_rotor)
                                           : pairTorque(curve_, partner.axis_rotor, own));
      }
    }
    sum += limit_ * std::log1p((torque.whitening * rest).squaredNorm() / limit_);
  }
  return sum;
}

AxisScan::Normal AxisScan::linearized(const Eigen::Vector2d& place) const {
  Eigen::Vector3d axis;
  Eigen::Matrix<double, 3, 2> d_axis;
  chart_.evaluate(place[0], place[1], axis, d_axis);
  Normal sum;
  for (const ScannedTorque& torque : torques_) {
    const Eigen::Vector3d own = torque.to_rotor * axis;
    Eigen::Vector3d rest = torque.rest;
    Eigen::Matrix3d d_own = Eigen::Matrix3d::Zero();
    for (const Partner& partner : torque.partners) {
      if (interacts(curve_, partner.axis_rotor, own)) {
        const PairTorque pair = is_pole_ ? linearizePairTorque(curve_, own, partner.axis_rotor)
                                         : linearizePairTorque(curve_, partner.axis_rotor, own);
        rest -= partner.weight * pair.torque;
        d_own -= partner.weight * (is_pole_ ? pair.d_pole : pair.d_coil);
      }
    }
    const Eigen::Vector3d residual = torque.whitening * rest;
    const Eigen::Matrix<double, 3, 2> jacobian =
        torque.whitening * d_own * torque.to_rotor * d_axis;
    const double square = residual.squaredNorm() / limit_;
    const double weight = 1.0 / (1.0 + square);
    sum.misfit += limit_ * std::log1p(square);
    sum.gradient += weight * jacobian.transpose() * residual;
    sum.information += weight * jacobian.transpose() * jacobian;
  }
  return sum;
}

/// The minimum below a place of the scan.
Eigen::Vector2d AxisScan::descended(Eigen::Vector2d place) const {
  constexpr int kMaxIterations = 20;
  constexpr double kNothing = 1e-5;  // [rad]: the estimator goes on from there
  double damping = 1e-3;
  Normal here = linearized(place);
  for (int iteration = 0; iteration < kMaxIterations; ++iteration) {
    Eigen::Matrix2d damped = here.information;
    damped.diagonal() *= 1.0 + damping;
    damped.diagonal().array() += 1e-6;
    Eigen::Vector2d step = -damped.ldlt().solve(here.gradient);
    // Beyond one step of the scan is another place of it.
    step *= std::min(1.0, step_ / std::max(step.norm(), kNothing));
    const Normal there = linearized(place + step);
    if (there.misfit < here.misfit) {
      place += step;
      here = there;
      damping *= 0.1;
      if (step.norm() < kNothing) {
        break;
      }
    } else {
      damping *= 10.0;
      if (step.norm() < kNothing) {
        break;
      }
    }
  }
  return place;
}

/// Places of the scan that no neighbour is better than, best first.
std::vector<Eigen::Vector2d> AxisScan::localMinima() const {
  const auto place = [this](int row, int column) {
    return Eigen::Vector2d(step_ * (row - kSteps), step_ * (column - kSteps));
  };
  Eigen::Matrix<double, kWidth, kWidth> misfits;
  for (int row = 0; row < kWidth; ++row) {
    for (int column = 0; column < kWidth; ++column) {
      misfits(row, column) = misfit(place(row, column));
    }
  }
  std::vector<std::pair<double, Eigen::Vector2d>> minima;
  for (int row = 0; row < kWidth; ++row) {
    for (int column = 0; column < kWidth; ++column) {
      const int top = std::max(row - 1, 0);
      const int left = std::max(column - 1, 0);
      const double least = misfits
                               .block(top,
                                      left,
                                      std::min(row + 1, kWidth - 1) - top + 1,
                                      std::min(column + 1, kWidth - 1) - left + 1)
                               .minCoeff();
      if (misfits(row, column) <= least) {
        minima.emplace_back(misfits(row, column), place(row, column));
      }
    }
  }
  std::sort(
      minima.begin(), minima.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  std::vector<Eigen::Vector2d> places;
  places.reserve(minima.size());
  for (const auto& [value, where] : minima) {
    places.push_back(where);
  }
  return places;
}

std::optional<AxisMode> AxisScan::best(const Eigen::Vector2d& present) const {
  constexpr std::size_t kMostStarts = 4;
  if (torques_.empty()) {
    return std::nullopt;
  }
  const double here = misfit(present);
  std::optional<AxisMode> best;
  std::vector<Eigen::Vector2d> starts = localMinima();
  starts.resize(std::min(starts.size(), kMostStarts));
  for (const Eigen::Vector2d& start : starts) {
    const Eigen::Vector2d place = descended(start);
    if ((place - present).norm() < kSameMode * step_ || !isWithin(place)) {
      continue;
    }
    const double gain = here - misfit(place);
    if (!best || gain > best->gain) {
      best = AxisMode{0, place, gain};
    }
  }
  return best;
}

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
  const auto distance_from_drawing = [&](Eigen::Index first, const Eigen::Vector2d& place) {
    const double tolerance = toleranceOf(space.id(first).kind, search.tolerance);
    return tolerance > 0.0 ? place.squaredNorm() / (tolerance * tolerance) : 0.0;
  };
  const auto scan = [&](Eigen::Index first,
                        const AxisChart& chart,
                        bool is_pole,
                        std::vector<ScannedTorque> torques) {
    const AxisScan search_here(model.curve(), chart, is_pole, std::move(torques), search);
    if (std::optional<AxisMode> mode = search_here.best(x.segment<2>(first))) {
      mode->first = first;
      mode->gain += distance_from_drawing(first, x.segment<2>(first)) -
                    distance_from_drawing(first, mode->place);
      modes.push_back(*mode);
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
