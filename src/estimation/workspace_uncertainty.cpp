#include "spherical_actuator_calibration/estimation/workspace_uncertainty.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include <boost/container/small_vector.hpp>

#include "axis_point.hpp"
#include "effects_at.hpp"
#include "spherical_actuator_calibration/actuator/spherical_joint.hpp"
#include "spherical_actuator_calibration/actuator/torque_model.hpp"
#include "spherical_actuator_calibration/base/pi.hpp"
#include "spherical_actuator_calibration/base/rotations.hpp"
#include "spherical_actuator_calibration/estimation/model_point.hpp"

namespace sac {
namespace {

/// Element `index` ≥ 1 of the van der Corput sequence in [0, 1).
double vanDerCorput(int index, int base) {
  double value = 0.0;
  double digit = 1.0 / base;
  for (int rest = index; rest > 0; rest /= base) {
    value += digit * (rest % base);
    digit /= base;
  }
  return value;
}

double percentile95(std::vector<double>& values) {
  if (values.empty()) {
    return 0.0;
  }
  const std::ptrdiff_t rank = std::lround(0.95 * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), values.begin() + rank, values.end());
  return values[static_cast<std::size_t>(rank)];
}

/// √tr(J Σ Jᵀ), the columns of J given with their places in Σ.
class ExpectedError {
 public:
  void add(const Eigen::Vector3d& column, Eigen::Index place) {
    columns_.push_back({column, place});
  }
  double value(const Eigen::MatrixXd& covariance) const {
    double trace = 0.0;
    for (const Column& a : columns_) {
      for (const Column& b : columns_) {
        trace += a.derivative.dot(b.derivative) * covariance(a.place, b.place);
      }
    }
    return std::sqrt(std::max(0.0, trace));
  }

 private:
  struct Column {
    Eigen::Vector3d derivative;
    Eigen::Index place;
  };
  boost::container::small_vector<Column, 32> columns_;
};

/// Of a belief what belongs to the machine: errors of the laboratory turn no rotor.
ParameterBelief ofMachine(const ParameterSpace& space, ParameterBelief belief) {
  for (const PlacedEffect& placed : space.effects().effects()) {
    if (placed.belongs_to != LaboratoryEffect::BelongsTo::kActuator) {
      const Eigen::Index first = space.effect() + placed.first;
      belief.x.segment(first, placed.size()).setZero();
      belief.covariance.middleRows(first, placed.size()).setZero();
      belief.covariance.middleCols(first, placed.size()).setZero();
    }
  }
  return belief;
}

/// Expected errors at single poses. What turns the rotor, joints and errors of their readings, is
/// condensed into the rotation error ξ at the pose, since the torque depends on it through that
/// alone; the covariance then is that of (ξ, poles, coils, effects).
class PoseUncertainty {
 public:
  PoseUncertainty(const CalibrationModel& model, const ParameterBelief& belief)
      : model_(model),
        belief_(ofMachine(model.space(), belief)),
        point_(model, belief_.x),
        effects_(model.space(), belief_.x),
        changed_curve_(model.hasTorqueModel() ? effects_.changedCurve() : std::nullopt),
        moved_covariance_(moved(space().size()), moved(space().size())) {
    const Eigen::Index others = space().size() - space().pole(0);
    moved_covariance_.bottomRightCorner(others, others) =
        belief_.covariance.bottomRightCorner(others, others);
    for (std::size_t i = 0; i < space().poles(); ++i) {
      poles_.push_back(axisPoint(space().poleChart(i), belief.x.data() + space().pole(i)));
    }
    for (std::size_t j = 0; j < space().coils(); ++j) {
      coils_.push_back(axisPoint(space().coilChart(j), belief.x.data() + space().coil(j)));
    }
  }

  /// Goes to a pose, R_stator_rotor where the model puts it; returns the orientation error [rad].
  double moveTo(const Sample& pose) {
    R_rotor_stator_ = pose.R_stator_rotor.transpose();
    if (space().joints() == 0) {
      moved_covariance_.topRows<3>().setZero();
      moved_covariance_.leftCols<3>().setZero();
      return 0.0;
    }
    // Measured where the model puts it, so that the residual's Jacobian is minus that of ξ.
    point_.orientationResidual(pose, &jacobian_);
    Eigen::Matrix3Xd with_all = Eigen::Matrix3Xd::Zero(3, space().size());
    const std::vector<Eigen::Index> turning = turningColumns();
    for (const Eigen::Index p : turning) {
      with_all -= jacobian_.col(p) * belief_.covariance.row(p);
    }
    Eigen::Matrix3d own = Eigen::Matrix3d::Zero();
    for (const Eigen::Index p : turning) {
      own -= with_all.col(p) * jacobian_.col(p).transpose();
    }
    if (model_.hasOrientationMap()) {
      const OrientationMap::Uncertainty map =
          space().nominal().orientation_map->uncertainty(pose.joint_position);
      own.diagonal() += map.of_rotor;
    }
    const Eigen::Index others = space().size() - space().pole(0);
    moved_covariance_.topLeftCorner<3, 3>() = own;
    moved_covariance_.topRightCorner(3, others) = with_all.rightCols(others);
    moved_covariance_.bottomLeftCorner(others, 3) = with_all.rightCols(others).transpose();
    return std::sqrt(std::max(0.0, own.trace()));
  }

  /// Number of coils whose torque is modelled.
  Eigen::Index torqueCoils() const {
    return model_.hasTorqueModel() ? static_cast<Eigen::Index>(space().coils()) : 0;
  }

  /// Torque error of one coil at unit current, at the pose [N·m/A].
  double torque(std::size_t coil) const {
    const AxisPoint& axis = coils_[coil];
    const Eigen::Vector3d coil_rotor = R_rotor_stator_ * axis.axis;
    const double coil_gain = space().nominal().coils[coil].gain;
    ExpectedError error;
    Eigen::Matrix3d d_coil = Eigen::Matrix3d::Zero();
    Eigen::Matrix3Xd d_curve = Eigen::Matrix3Xd::Zero(3, effects_.onCurve().size());
    for (std::size_t i = 0; i < poles_.size(); ++i) {
      if (!interacts(curve(), poles_[i].axis, coil_rotor)) {
        continue;
      }
      const PoleAxis& pole = space().nominal().poles[i];
      const double weight = coil_gain * pole.polarity * pole.gain * effects_.strength(i, coil);
      const PairTorque pair = linearizePairTorque(curve(), poles_[i].axis, coil_rotor);
      d_coil += weight * pair.d_coil;
      const Eigen::Matrix<double, 3, 2> d_pole = weight * pair.d_pole * poles_[i].d_axis;
      error.add(d_pole.col(0), moved(space().pole(i)));
      error.add(d_pole.col(1), moved(space().pole(i)) + 1);
      effects_.forEachStrength(i, coil, [&](Eigen::Index coordinate, double factor) {
        error.add(factor * weight * pair.torque, moved(coordinate));
      });
      effects_.addPairColumns(poles_[i].axis, coil_rotor, weight, d_curve);
    }
    for (const ActingEffects::Part& part : effects_.onCurve().parts) {
      for (Eigen::Index n = 0; n < part.placed->size(); ++n) {
        error.add(part.placed->effect->scale() * d_curve.col(part.first + n),
                  moved(space().effect() + part.placed->first + n));
      }
    }
    // s = Rᵀ s⁰, so ∂s/∂ξ = Rᵀ ŝ⁰.
    const Eigen::Matrix3d d_stator = d_coil * R_rotor_stator_;
    const Eigen::Matrix3d d_rotation = d_stator * skew(axis.axis);
    for (Eigen::Index c = 0; c < 3; ++c) {
      error.add(d_rotation.col(c), c);
    }
    const Eigen::Matrix<double, 3, 2> d_axis = d_stator * axis.d_axis;
    error.add(d_axis.col(0), moved(space().coil(coil)));
    error.add(d_axis.col(1), moved(space().coil(coil)) + 1);
    return error.value(moved_covariance_);
  }

 private:
  const ParameterSpace& space() const { return model_.space(); }
  const TorqueCurve& curve() const { return changed_curve_ ? *changed_curve_ : model_.curve(); }
  /// Coordinates that an orientation depends on.
  std::vector<Eigen::Index> turningColumns() const {
    std::vector<Eigen::Index> columns;
    const auto take = [&](Eigen::Index first, Eigen::Index last) {
      for (Eigen::Index p = first; p < last; ++p) {
        if (!jacobian_.col(p).isZero(0.0)) {
          columns.push_back(p);
        }
      }
    };
    take(0, space().pole(0));
    take(space().effect(), space().size());
    return columns;
  }
  /// Place of a coordinate that is none of a joint behind the three of ξ.
  Eigen::Index moved(Eigen::Index parameter) const { return parameter - space().pole(0) + 3; }

  const CalibrationModel& model_;
  const ParameterBelief belief_;
  ModelPoint point_;
  EffectsAt effects_;
  std::optional<TorqueCurve> changed_curve_;
  std::vector<AxisPoint> poles_;
  std::vector<AxisPoint> coils_;
  ResidualJacobian jacobian_;
  Eigen::Matrix3d R_rotor_stator_ = Eigen::Matrix3d::Identity();
  Eigen::MatrixXd moved_covariance_;
};

/// Where the model puts the rotor at joint angles q.
Sample poseAt(const JointGeometry& joints, const Eigen::Vector3d& q) {
  Sample pose;
  pose.joint_position = q;
  pose.R_stator_rotor = rotorOrientation(joints, q);
  return pose;
}

/// Errors at one tilt, root mean square over the spin, and those of torque over the coils.
struct SpinAverage {
  double orientation = 0.0;  ///< [rad]
  double torque = 0.0;       ///< [N·m/A]
};

SpinAverage averageOverSpin(PoseUncertainty& uncertainty,
                            const JointGeometry& joints,
                            const Eigen::Vector2d& tilt,
                            int spins) {
  Eigen::VectorXd orientation(spins);
  Eigen::MatrixXd torque = Eigen::MatrixXd::Zero(spins, uncertainty.torqueCoils());
  for (Eigen::Index s = 0; s < spins; ++s) {
    const double spin = kPi * (2.0 * static_cast<double>(s) / spins - 1.0);
    orientation[s] = uncertainty.moveTo(poseAt(joints, {tilt[0], tilt[1], spin}));
    for (Eigen::Index j = 0; j < torque.cols(); ++j) {
      torque(s, j) = uncertainty.torque(static_cast<std::size_t>(j));
    }
  }
  const auto count = static_cast<double>(std::max<Eigen::Index>(torque.size(), 1));
  return {orientation.norm() / std::sqrt(spins), torque.norm() / std::sqrt(count)};
}

}  // namespace

WorkspaceUncertainty workspaceUncertainty(const CalibrationModel& model,
                                          const ParameterBelief& belief,
                                          int poses) {
  const ParameterSpace& space = model.space();
  const double tilt = space.nominal().workspace.tilt_limit;
  const JointGeometry joints = jointGeometry(space.actuatorAt(belief.x));
  PoseUncertainty uncertainty(model, belief);
  std::vector<double> orientation_errors;
  std::vector<double> torque_errors;
  for (int n = 1; n <= poses; ++n) {
    const Eigen::Vector3d q(tilt * (2.0 * vanDerCorput(n, 2) - 1.0),
                            tilt * (2.0 * vanDerCorput(n, 3) - 1.0),
                            kPi * (2.0 * vanDerCorput(n, 5) - 1.0));
    orientation_errors.push_back(uncertainty.moveTo(poseAt(joints, q)));
    for (std::size_t j = 0; model.hasTorqueModel() && j < space.coils(); ++j) {
      torque_errors.push_back(uncertainty.torque(j));
    }
  }
  return {percentile95(orientation_errors), percentile95(torque_errors)};
}

WorkspaceMap workspaceMap(const CalibrationModel& model,
                          const ParameterBelief& belief,
                          int tilts,
                          int spins) {
  const ParameterSpace& space = model.space();
  const double limit = space.nominal().workspace.tilt_limit;
  const JointGeometry joints = jointGeometry(space.actuatorAt(belief.x));
  PoseUncertainty uncertainty(model, belief);
  WorkspaceMap map;
  map.tilt = Eigen::VectorXd::LinSpaced(tilts, -limit, limit);
  map.orientation.resize(tilts, tilts);
  if (model.hasTorqueModel()) {
    map.torque.resize(tilts, tilts);
  }
  for (Eigen::Index row = 0; row < tilts; ++row) {
    for (Eigen::Index column = 0; column < tilts; ++column) {
      const SpinAverage average =
          averageOverSpin(uncertainty, joints, {map.tilt[row], map.tilt[column]}, spins);
      map.orientation(row, column) = average.orientation;
      if (model.hasTorqueModel()) {
        map.torque(row, column) = average.torque;
      }
    }
  }
  return map;
}

}  // namespace sac
