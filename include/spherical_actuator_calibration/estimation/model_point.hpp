#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include <Eigen/Core>

#include "spherical_actuator_calibration/estimation/calibration_model.hpp"

namespace sac {

/// Excitations of one sample, wherever they are kept: they must outlive this.
class Excitations {
 public:
  Excitations(const std::vector<Excitation>& kept)  // NOLINT(google-explicit-constructor)
      : Excitations(kept.data(), kept.size()) {}
  Excitations(const Excitation* first, std::size_t count) : first_(first), count_(count) {}

  const Excitation* begin() const { return first_; }
  const Excitation* end() const { return first_ + count_; }
  std::size_t size() const { return count_; }
  const Excitation& operator[](std::size_t n) const { return first_[n]; }

 private:
  const Excitation* first_;
  std::size_t count_;
};

/// ∂residual/∂errors of where the rotor is at a sample.
struct PoseDerivatives {
  /// Column k: by the error of the reading whose standard deviation is joint_stddev[k].
  Eigen::Matrix3d reading = Eigen::Matrix3d::Zero();
  /// By ξ, R → e^{ξ̂}R in the stator frame, as an orientation map turns it; without joints zero.
  Eigen::Matrix3d rotation = Eigen::Matrix3d::Zero();
};

/// A model at one point x of its coordinates: what depends on them alone (joint axes, poles and
/// coils with their derivatives, effects, the torque curve) is worked out once for all samples.
class ModelPoint {
 public:
  /// Keeps a reference to the model.
  ModelPoint(const CalibrationModel& model, const Eigen::VectorXd& x);

  /// R_stator_rotor of a sample by its reading. Without joints the reading is the tracker's, R_a:
  /// the rotor is at exp(t)ᵀ R_a exp(m)ᵀ, see LaboratoryEffect.
  Eigen::Matrix3d orientation(const Sample& sample) const;

  /// See CalibrationModel::orientationResidual(), with its precondition. `d_pose` is written where
  /// `jacobian` is.
  Eigen::Vector3d orientationResidual(const Sample& sample,
                                      ResidualJacobian* jacobian = nullptr,
                                      PoseDerivatives* d_pose = nullptr) const;
  /// See CalibrationModel::torqueResidual(), with its precondition. `d_pose` as above.
  Eigen::Vector3d torqueResidual(const Sample& sample,
                                 Excitations excitations,
                                 ResidualJacobian* jacobian = nullptr,
                                 PoseDerivatives* d_pose = nullptr) const;

 private:
  struct Parts;
  std::shared_ptr<const Parts> parts_;
};

}  // namespace sac
