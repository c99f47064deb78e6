#pragma once

#include <optional>
#include <string>

#include <Eigen/Core>

#include "spherical_actuator_calibration/actuator/description_file.hpp"
#include "spherical_actuator_calibration/actuator/torque_model.hpp"
#include "spherical_actuator_calibration/calibration/prediction.hpp"
#include "spherical_actuator_calibration/control/current_allocation.hpp"

namespace sac {

/// A calibrated actuator for those who use it: where the rotor is, what torque currents make, and
/// which currents make a torque, each with its uncertainty by the calibration. With everything that
/// the description says: corrections of the joints' readings, gains, torque curve, orientation map.
/// Joint angles are raw readings [rad]. May be called from several threads at a time.
class CalibratedActuator {
 public:
  struct Currents {
    Allocation outcome = Allocation::kSingular;
    Eigen::VectorXd currents;  ///< of every coil [A]
    /// Of each coil [A] (1 σ): by how much it would have to change, least for all coils together,
    /// for the torque to be made in truth.
    Eigen::VectorXd stddev;
    Eigen::Vector3d torque = Eigen::Vector3d::Zero();  ///< that they make, rotor frame [N·m]
    double torque_stddev = 0.0;                        ///< of a component of it (1 σ) [N·m]
  };

  /// Throws ConfigError when the description is not valid, or its covariance is not of its
  /// parameters.
  explicit CalibratedActuator(CalibratedDescription description);
  /// From a file; throws ConfigError as loadDescription() besides.
  static CalibratedActuator load(const std::string& path);

  const CalibratedDescription& description() const { return description_; }
  bool hasJoints() const { return description_.actuator.has_joints; }
  bool hasTorqueModel() const { return curve_.has_value(); }
  std::size_t coils() const { return predictor_.coils(); }
  /// Whether the description states any uncertainty: a nominal one does not, and all standard
  /// deviations are zero then.
  bool hasUncertainty() const { return predictor_.hasUncertainty(); }

  /// Whether it is not told how well each angle of its axes is known: see isAsDrawn().
  bool isAsDrawn() const { return sac::isAsDrawn(description_); }

  /// Whether samples that were held out contradicted the description when it was made: its numbers
  /// and their standard deviations are not to be trusted.
  bool isContradicted() const { return sac::isContradicted(description_); }

  /// Rotor orientation. Throws DataError when a reading is not finite, and for a rotor without
  /// joints, whose orientation is measured.
  Predictor::Orientation orientation(const Eigen::Vector3d& reading) const;

  /// Torque of the coils on the rotor, rotor frame [N·m]. Throws DataError without a torque model,
  /// when there is not one current per coil, or a number is not finite.
  Predictor::Torque torque(const Eigen::Vector3d& reading, const Eigen::VectorXd& currents) const;

  /// Currents of least power for a torque [N·m, rotor frame], see allocateCurrents(). Throws
  /// DataError as torque(), ConfigError when an option is not valid.
  Currents currents(const Eigen::Vector3d& torque,
                    const Eigen::Vector3d& reading,
                    const AllocationOptions& options = {}) const;

 private:
  void requireTorqueModel() const;

  CalibratedDescription description_;
  Predictor predictor_;
  std::optional<TorqueCurve> curve_;  ///< none without a torque model
  TorqueGeometry geometry_;
};

}  // namespace sac
