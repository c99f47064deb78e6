#pragma once

#include <array>
#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "spherical_actuator_calibration/actuator/orientation_map.hpp"
#include "spherical_actuator_calibration/actuator/torque_curve.hpp"

namespace sac {

/// Number of joints of the spherical joint: the rotational degrees of freedom of a rigid body,
/// hence the same for every actuator. How many poles and coils there are, the description alone
/// says.
inline constexpr std::size_t kJoints = 3;

/// What the angle of one joint has beside its reading: linear·(q₁, q₂, q₃) + a₁ cos q + b₁ sin q +
/// a₂ cos 2q + b₂ sin 2q, all readings raw, q its own. Zero unless identified.
struct ReadingCorrection {
  std::array<double, kJoints> linear = {};  ///< scale and cross-axis: a row of the matrix [1]
  std::array<double, 4> harmonics = {};     ///< a₁, b₁, a₂, b₂ [rad]
};

/// One joint of the product of exponentials (paper (1)).
struct JointAxis {
  std::string name;                                 ///< joint name in joint_states and URDF
  Eigen::Vector3d axis = Eigen::Vector3d::UnitX();  ///< unit axis ω_k
  double offset = 0.0;                              ///< joint offset δq_k [rad]
  ReadingCorrection correction = {};
};

/// Axis of one magnet pole in the rotor frame (paper (19)).
struct PoleAxis {
  double polar = 0.0;    ///< elevation θ from the equator [rad], within ±π/2
  double azimuth = 0.0;  ///< φ [rad]
  int polarity = 1;      ///< p_i: +1 or −1
  double gain = 1.0;     ///< strength relative to the torque curve; 1 unless identified
};

/// Axis of one coil in the stator frame (paper (20)).
struct CoilAxis {
  double polar = 0.0;    ///< elevation η from the equator [rad], within ±π/2
  double azimuth = 0.0;  ///< ϕ [rad]
  double gain = 1.0;     ///< strength relative to the torque curve; 1 unless identified
};

/// Where the rotor may go.
struct Workspace {
  /// Largest |q₁| and |q₂| [rad], in (0, π/2); of a rotor without joints, those of
  /// freeRotorJoints().
  double tilt_limit = 0.6;

  /// Whether it may be at raw sensor angles q [rad], or up to `margin` [rad] of tilt beyond.
  bool contains(const Eigen::Vector3d& q, double margin = 0.0) const {
    return q.head<2>().cwiseAbs().maxCoeff() <= tilt_limit + margin;
  }
};

/// Throws ConfigError unless the workspace contains q, rounded as files and messages round it.
void requireInWorkspace(const Eigen::Vector3d& q, const Workspace& workspace);

/// Torque −(b + c/√(ω² + v²)) ω on a rotor that turns with ω, v = 0.05 rad/s.
struct RotorFriction {
  double viscous = 0.0;  ///< b [N·m·s/rad]
  double coulomb = 0.0;  ///< c [N·m]
};

/// One actuator: geometry, torque curve, workspace. Poles, coils and curve may be absent; then only
/// the joint can be calibrated.
struct Actuator {
  std::string name;
  std::string serial;  ///< one physical unit; empty when the description names none
  std::array<JointAxis, kJoints> joints;
  /// False for `joints: []`: the rotor is levitated or borne by air, and its orientation is what an
  /// external tracker measures. `joints` are then freeRotorJoints(), which are exact: no reading
  /// tells them, nothing identifies or reports them.
  bool has_joints = true;
  std::vector<PoleAxis> poles;
  std::vector<CoilAxis> coils;
  std::optional<TorqueCurveDescription> torque_curve;
  Workspace workspace;
  /// What turns the rotor beside axes, offsets and corrections; null unless identified.
  std::shared_ptr<const OrientationMap> orientation_map = nullptr;
  /// Weight of the rotor times its centre of gravity, rotor frame [N·m]; zero unless identified.
  Eigen::Vector3d unbalance = Eigen::Vector3d::Zero();
  // Unless a motion has identified them, they are not known.
  std::optional<Eigen::Matrix3d> inertia;  ///< about the centre, rotor frame, symmetric [kg·m²]
  std::optional<RotorFriction> friction;

  /// True when poles, coils and torque curve are all present, so that torque can be modelled.
  bool hasTorqueModel() const {
    return !poles.empty() && !coils.empty() && torque_curve.has_value();
  }
};

/// Number of coils that torques are modelled with: 0 when the description lacks poles or curve.
std::size_t modelledCoils(const Actuator& actuator);

/// The angles that stand for the orientation of a rotor without joints: about x, then y, then z of
/// frames that coincide where all of them are zero. Wherever other rotors have raw sensor angles q,
/// such as in samples and plans, this one has these, see freeRotorAngles().
std::array<JointAxis, kJoints> freeRotorJoints();

/// Names of the joints, from the stator to the rotor.
std::array<std::string, kJoints> jointNames(const Actuator& actuator);

/// Throws ConfigError, naming the key, when a value is not finite or out of range, an axis is not
/// unit to 1e-3, two joints share a name, or a rotor without joints has something of theirs.
void validate(const Actuator& actuator);

/// Unit vector of an elevation and azimuth: (cosθ cosφ, cosθ sinφ, sinθ), paper (19).
Eigen::Vector3d axisFromAngles(double polar, double azimuth);

/// Elevation and azimuth [rad].
struct AxisAngles {
  double polar = 0.0;
  double azimuth = 0.0;
};

/// Inverse of axisFromAngles. The azimuth is the one nearest to `azimuth_hint`, so that 5.5
/// stays 5.5; on the axis itself (polar = ±π/2), where it is undefined, it is the hint.
AxisAngles anglesFromAxis(const Eigen::Vector3d& axis, double azimuth_hint);

}  // namespace sac
