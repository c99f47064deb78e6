#pragma once

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include "spherical_actuator_calibration/actuator/actuator.hpp"

namespace sac {

/// One thing that a laboratory adds to the geometry of the paper (doc/method.md, Laboratory), as
/// modelled for one actuator. Its values v are its coordinates times scale(). A class of effects
/// overrides what it acts on; the defaults act on nothing.
class LaboratoryEffect {
 public:
  using Values = Eigen::Ref<const Eigen::VectorXd>;
  /// 3×n for n coordinates, zero before the call.
  using Columns = Eigen::Ref<Eigen::Matrix3Xd>;

  /// Observations that an effect acts on: on all of them by the readings of the joints.
  enum class ActsOn { kEverything, kOrientations, kTorques, kMotion };
  /// What has an effect: only what the actuator itself has changes what coils and joints do.
  enum class BelongsTo {
    kActuator,
    kLoad,  ///< the weight that the rotor carries
    kTracker,
    kTorqueSensor,
  };

  virtual ~LaboratoryEffect() = default;

  const std::vector<std::string>& names() const { return names_; }
  Eigen::Index size() const { return static_cast<Eigen::Index>(names_.size()); }
  /// Value of one unit of a coordinate. Chosen so that coordinates compare with geometric errors in
  /// rad: 0.03 is a usual, 0.05 a hardly tolerable size.
  double scale() const { return scale_; }
  /// What is added to value `n` where it is told to people: its coordinate is a deviation from it.
  virtual double nominalValue(Eigen::Index n) const;

  /// Standard deviation of each value around zero that is known of every machine; 0: none is. Such
  /// an effect is estimated as far as the observations tell it, and stays at zero beyond.
  virtual double priorStddev() const { return 0.0; }

  /// Whether observations with these coils excited tell coordinate `n`.
  virtual bool isToldBy(Eigen::Index n, const std::vector<bool>& excited) const;

  // ---- sensors of the joints

  /// ∂q/∂v at a reading, with q = reading + (∂q/∂v) v the joint angles.
  virtual void addReadingColumns(const Eigen::Vector3d& reading, Columns columns) const;

  // ---- the tracker: R_measured = exp(t) R(q) exp(m)

  /// ∂t/∂v: rotation vector of the tracker in the stator, stator frame [rad].
  virtual void addTrackerColumns(Columns columns) const;
  /// ∂m/∂v: rotation vector of the marker in the rotor, rotor frame [rad].
  virtual void addMarkerColumns(Columns columns) const;

  // ---- the force/torque sensor: T_measured = exp(z) T

  /// ∂z/∂v: rotation vector of the force/torque sensor in the rotor, rotor frame [rad].
  virtual void addTorqueFrameColumns(Columns columns) const;

  // ---- torque without current: T = (∂T/∂v) v

  /// ∂T/∂v [N·m], rotor frame.
  virtual void addLoadColumns(const Eigen::Matrix3d& R_rotor_stator, Columns columns) const;
  /// ∂T/∂ξ, where R_stator_rotor becomes e^{ξ̂} R_stator_rotor.
  virtual Eigen::Matrix3d loadRotation(const Values& values,
                                       const Eigen::Matrix3d& R_rotor_stator) const;

  // ---- torque of one pole and one coil

  /// The coordinate v of this effect by which the torque of a pair is multiplied as 1 + v, or −1.
  virtual Eigen::Index strengthCoordinate(std::size_t pole, std::size_t coil) const;
  /// ∂T/∂v of a pair of unit strength beside that [N·m/A].
  virtual void addPairColumns(const Eigen::Vector3d& pole_rotor,
                              const Eigen::Vector3d& coil_rotor,
                              Columns columns) const;
  /// Whether applyTo() changes the torque curve.
  virtual bool changesCurve() const;
  /// Puts what belongs to the machine into its description: corrections of readings, unbalance,
  /// gains, torque curve. What belongs to the laboratory stays out.
  virtual void applyTo(Actuator& actuator, const Values& values) const;

 protected:
  LaboratoryEffect(std::vector<std::string> names, double scale)
      : names_(std::move(names)), scale_(scale) {}

  /// name/x, name/y, name/z.
  static std::vector<std::string> components(const std::string& name);

 private:
  std::vector<std::string> names_;  ///< of the coordinates, as in parameter names
  double scale_;
};

}  // namespace sac
