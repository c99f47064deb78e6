#pragma once

#include <memory>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "spherical_actuator_calibration/actuator/description_file.hpp"
#include "spherical_actuator_calibration/estimation/calibration_model.hpp"
#include "spherical_actuator_calibration/estimation/model_point.hpp"

namespace sac {

/// What a description says of the rotor at joint readings and coil currents, and how certain it is.
class Predictor {
 public:
  struct Orientation {
    Eigen::Matrix3d R_stator_rotor;
    /// Of a component of the rotation error (1 σ) [rad]: from the parameters' covariance and, with
    /// an orientation map, its uncertainty and the scatter that no map tells.
    double stddev = 0.0;
    /// False where there is an orientation map, but none of its points is near: axes and
    /// corrections alone tell the orientation there.
    bool is_supported = true;
  };

  struct Torque {
    Eigen::Vector3d torque;  ///< of the coils on the rotor, rotor frame [N·m]
    double stddev = 0.0;     ///< of a component (1 σ) [N·m]
    /// Of its components [N²·m²]: they are rarely known equally well, and `stddev` is the root mean
    /// square over them.
    Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  };

  /// Throws ConfigError when the description is not valid, or its covariance is not of its
  /// parameters.
  explicit Predictor(const CalibratedDescription& description);

  bool hasTorqueModel() const { return model_->hasTorqueModel(); }
  std::size_t coils() const { return model_->space().coils(); }
  /// Whether the description states any uncertainty: a nominal one does not.
  bool hasUncertainty() const { return !covariance_.isZero(0.0); }

  /// At raw sensor angles [rad]. Without joints: that of the reading, which no parameter changes.
  Orientation orientation(const Eigen::Vector3d& reading) const;
  /// Also at coil currents [A]. Precondition: hasTorqueModel() and one current per coil.
  Torque torque(const Eigen::Vector3d& reading, const Eigen::VectorXd& current) const;
  /// The same with the weight of an unbalanced rotor, as a force/torque sensor feels it whose
  /// torque without current was not taken off.
  Torque loadedTorque(const Eigen::Vector3d& reading, const Eigen::VectorXd& current) const;

 private:
  Torque torqueOfCoils(const Eigen::Vector3d& reading,
                       const Eigen::VectorXd& current,
                       const Eigen::MatrixXd& covariance) const;

  std::shared_ptr<const CalibrationModel> model_;  ///< where the point finds it, also after a copy
  ModelPoint point_;  ///< all coordinates zero: the description is the nominal one of its model
  Eigen::MatrixXd covariance_;  ///< of the coordinates; zero for those of load and laboratory
  Eigen::MatrixXd loaded_covariance_;  ///< the same with those of the load
};

}  // namespace sac
