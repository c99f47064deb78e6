#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include <Eigen/Core>

#include "spherical_actuator_calibration/actuator/torque_curve.hpp"
#include "spherical_actuator_calibration/estimation/parameter_space.hpp"

namespace sac {

/// The effects that act in one way, side by side. By the values of the others a derivative is zero,
/// and nothing is spent on them: of 400 coils each has a gain.
struct ActingEffects {
  struct Part {
    const PlacedEffect* placed;
    Eigen::Index first;  ///< of its values among those side by side
  };
  std::vector<Part> parts;
  Eigen::VectorXd values;  ///< N, side by side

  Eigen::Index size() const { return values.size(); }
  bool empty() const { return parts.empty(); }
};

/// All modelled effects together, at the coordinates x.
class EffectsAt {
 public:
  /// Keeps a reference to the space.
  EffectsAt(const ParameterSpace& space, const Eigen::VectorXd& x);

  bool empty() const { return values_.size() == 0; }

  // What acts in each way, and ∂/∂values of it, 3×N each: see LaboratoryEffect.
  const ActingEffects& onReadings() const { return on_readings_; }
  const ActingEffects& onTracker() const { return on_tracker_; }
  const ActingEffects& onMarker() const { return on_marker_; }
  const ActingEffects& onTorqueFrame() const { return on_torque_frame_; }
  const ActingEffects& onLoad() const { return on_load_; }
  const ActingEffects& onCurve() const { return on_curve_; }
  Eigen::Matrix3Xd readingColumns(const Eigen::Vector3d& reading) const;
  Eigen::Matrix3Xd trackerColumns() const;
  Eigen::Matrix3Xd markerColumns() const;
  Eigen::Matrix3Xd torqueFrameColumns() const;
  Eigen::Matrix3Xd loadColumns(const Eigen::Matrix3d& R_rotor_stator) const;
  Eigen::Matrix3d loadRotation(const Eigen::Matrix3d& R_rotor_stator) const;

  /// Factor on the torque of a pair.
  double strength(std::size_t pole, std::size_t coil) const;
  /// visit(coordinate of the space, factor) for each coordinate on which that factor depends: a
  /// pair that exerts T has ∂T/∂coordinate = factor T.
  template <typename Visit>
  void forEachStrength(std::size_t pole, std::size_t coil, const Visit& visit) const {
    for (const PlacedEffect* const placed : on_strength_) {
      const Eigen::Index n = placed->effect->strengthCoordinate(pole, coil);
      if (n >= 0) {
        visit(space_.effect() + placed->first + n,
              placed->effect->scale() / (1.0 + values_[placed->first + n]));
      }
    }
  }
  /// Takes ∂T/∂values of that factor off a Jacobian, for a pair that exerts `torque` [N·m].
  void subtractStrengthColumns(std::size_t pole,
                               std::size_t coil,
                               const Eigen::Vector3d& torque,
                               ResidualJacobian& jacobian) const;
  /// Adds ∂T/∂values of other changes of a pair, whose strength times current is `weight` [A].
  void addPairColumns(const Eigen::Vector3d& pole_rotor,
                      const Eigen::Vector3d& coil_rotor,
                      double weight,
                      Eigen::Matrix3Xd& columns) const;
  /// The torque curve, where it is not the nominal one.
  std::optional<TorqueCurve> changedCurve() const;

  /// Adds `left` times derivatives by values to the columns of their coordinates.
  void add(const ActingEffects& acting,
           const Eigen::Matrix3d& left,
           const Eigen::Matrix3Xd& columns,
           ResidualJacobian& jacobian) const;

 private:
  template <typename AddColumns>
  ActingEffects actingBy(const AddColumns& add_columns) const;
  template <typename AddColumns>
  static Eigen::Matrix3Xd collect(const ActingEffects& acting, const AddColumns& add_columns);

  const ParameterSpace& space_;
  Eigen::VectorXd values_;  ///< of all
  std::vector<const PlacedEffect*> on_strength_;
  ActingEffects on_readings_;
  ActingEffects on_tracker_;
  ActingEffects on_marker_;
  ActingEffects on_torque_frame_;
  ActingEffects on_load_;
  ActingEffects on_curve_;
};

}  // namespace sac
