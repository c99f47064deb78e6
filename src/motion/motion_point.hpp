#pragma once

#include <optional>
#include <vector>

#include <Eigen/Core>

#include "spherical_actuator_calibration/actuator/spherical_joint.hpp"
#include "spherical_actuator_calibration/actuator/tabulated_curve.hpp"
#include "spherical_actuator_calibration/actuator/torque_curve.hpp"
#include "spherical_actuator_calibration/estimation/calibration_model.hpp"
#include "spherical_actuator_calibration/estimation/joint_point.hpp"

namespace sac {

/// Where the coordinates of motion stand in the vector of a ParameterSpace; −1: not modelled.
struct MotionPlaces {
  explicit MotionPlaces(const ParameterSpace& space);

  Eigen::Index inertia = -1;  ///< first of six
  Eigen::Index viscous = -1;
  Eigen::Index coulomb = -1;
  Eigen::Index current_delay = -1;
  Eigen::Index current_dispersion = -1;
  Eigen::Index tracker_delay = -1;
};

/// Rotor orientation at a reading, and how it turns with those coordinates that move it.
struct TurnedRotor {
  Eigen::Matrix3d R_stator_rotor;
  Eigen::Matrix3d d_reading;  ///< ∂ξ/∂q
  Eigen::Matrix3Xd d_x;       ///< ∂ξ/∂x of MotionPoint::turning()
};

/// A pole and a coil that act on each other.
struct NearPair {
  Eigen::Index pole = 0;
  Eigen::Index coil = 0;
  Eigen::Vector3d cross;  ///< r × s of their axes, stator frame
  TorqueCurve::Safe curve;
};

/// Torque on the rotor, stator frame, and its derivatives.
struct StatorTorque {
  Eigen::Vector3d torque;   ///< R T [N·m]
  Eigen::Matrix3d d_turn;   ///< ∂(RT)/∂ξ
  Eigen::Matrix3Xd d_x;     ///< 3×P, without what turns the rotor
  Eigen::Matrix3Xd d_coil;  ///< per ampere of each coil
  // While it is summed up.
  Eigen::Matrix3Xd poles;       ///< axes, stator frame
  Eigen::MatrixXd cosines;      ///< coils × poles
  std::vector<NearPair> pairs;  ///< pole by pole, those that are near first
  std::size_t near = 0;         ///< so many of them
};

/// All that a model of motion needs at coordinates x.
class MotionPoint {
 public:
  /// Keeps references. `tabulated`: the curve of the model, for speed; not used where effects
  /// change the curve.
  MotionPoint(const CalibrationModel& model,
              const MotionPlaces& places,
              const Eigen::VectorXd& x,
              const TabulatedCurve* tabulated = nullptr);

  const ParameterSpace& space() const { return *space_; }
  const MotionPlaces& places() const { return places_; }
  const Eigen::VectorXd& x() const { return x_; }

  /// Coordinates that turn the rotor at a reading, ascending: of joints and their sensors.
  const std::vector<Eigen::Index>& turning() const { return turning_; }
  /// Fills `out`, whose storage is reused.
  void turn(const Eigen::Vector3d& reading, TurnedRotor& out) const;

  /// Torque of coils and load. Fills `out`, whose storage is reused.
  void torque(const Eigen::Matrix3d& R_stator_rotor,
              const Eigen::VectorXd& current,
              StatorTorque& out) const;

  /// What multiplies the torque of a pair per ampere.
  double strength(const NearPair& pair) const { return weight_(pair.pole, pair.coil); }

  const Eigen::Matrix3d& inertia() const { return inertia_; }
  double viscous() const { return valueAt(places_.viscous); }
  double coulomb() const { return valueAt(places_.coulomb); }
  double currentDelay() const { return valueAt(places_.current_delay); }
  double currentDispersion() const { return valueAt(places_.current_dispersion); }
  /// Value of an effect per coordinate, at its place.
  double scaleAt(Eigen::Index place) const { return scales_[place]; }

 private:
  /// What multiplies the torque of a pair as 1 + v.
  struct Strength {
    Eigen::Index coordinate;  ///< of x
    double relative;          ///< ∂ ln(torque)/∂x
  };
  /// What acts without current.
  struct Load {
    const PlacedEffect* placed;
    Eigen::VectorXd values;
  };

  void setScales();
  void setAxes();
  void setStrengths();
  void setLoads();
  void setTurning();
  void setInertia();
  double valueAt(Eigen::Index place) const;
  void findPairs(const Eigen::Matrix3d& R, StatorTorque& out) const;
  std::size_t addPole(std::size_t first,
                      const Eigen::Matrix3d& R,
                      const Eigen::VectorXd& current,
                      StatorTorque& out) const;
  void addEffects(std::size_t pole,
                  std::size_t coil,
                  double weight,
                  const Eigen::Vector3d& pole_stator,
                  const Eigen::Vector3d& torque,
                  StatorTorque& out) const;
  void addLoads(const Eigen::Matrix3d& R, StatorTorque& out) const;

  const ParameterSpace* space_;
  MotionPlaces places_;
  Eigen::VectorXd x_;
  const TorqueCurve* curve_;
  const TabulatedCurve* tabulated_;  ///< of curve_, or none
  std::optional<TorqueCurve> changed_curve_;
  Eigen::VectorXd scales_;  ///< of each coordinate; 1 of the geometry's
  JointPoint joints_;
  JointGeometry nominal_joints_;  ///< what the description corrects already
  Eigen::Matrix3Xd poles_;        ///< rotor frame
  Eigen::Matrix3Xd coils_;        ///< stator frame
  Eigen::Matrix<double, Eigen::Dynamic, 3> coils_by_row_;  ///< the same, for many products at once
  std::vector<Eigen::Matrix<double, 3, 2>> d_pole_;
  std::vector<Eigen::Matrix<double, 3, 2>> d_coil_;
  Eigen::MatrixXd weight_;                        ///< poles × coils
  std::vector<std::vector<Strength>> strengths_;  ///< per pole and coil
  std::vector<Load> loads_;
  std::vector<Eigen::Index> turning_;
  Eigen::Matrix3d inertia_;
};

}  // namespace sac
