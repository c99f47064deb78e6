#include "frame_fit.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "covariance_record.hpp"
#include "spherical_actuator_calibration/actuator/spherical_joint.hpp"
#include "spherical_actuator_calibration/base/cholesky.hpp"
#include "spherical_actuator_calibration/base/nearest_rotation.hpp"
#include "spherical_actuator_calibration/base/pi.hpp"
#include "spherical_actuator_calibration/base/rotations.hpp"
#include "spherical_actuator_calibration/base/symmetric_matrix.hpp"
#include "spherical_actuator_calibration/estimation/damped_descent.hpp"

namespace sac {
namespace {

constexpr Eigen::Index kFrames = 6;

CalibrationModel modelOf(const CalibratedDescription& description) {
  return CalibrationModel(ParameterSpace(description.actuator, effectsOf(description.calibration)));
}

/// Of all coordinates: as a calibration left them or as the description states it; the tolerance of
/// manufacture for joints of which it states nothing.
Eigen::MatrixXd machineUncertainty(const ParameterSpace& space,
                                   const CalibratedDescription& description,
                                   const ManufacturingTolerance& tolerance) {
  if (description.calibration && description.calibration->covariance) {
    return machineCovariance(space, description, false);
  }
  Eigen::VectorXd stddev = Eigen::VectorXd::Zero(space.size());
  for (std::size_t k = 0; k < kJoints; ++k) {
    const JointStddev& stated = description.stddevs.joints[k];
    stddev.segment<ParameterSpace::kPerJoint>(space.joint(k)) =
        Eigen::Vector3d(stated.offset.value_or(tolerance.joint_offset),
                        stated.axis_u.value_or(tolerance.joint_axis),
                        stated.axis_v.value_or(tolerance.joint_axis));
  }
  return stddev.cwiseAbs2().asDiagonal();
}

/// L with L Lᵀ the covariance, a column for each direction that is uncertain at all. Poles and
/// coils turn no rotor.
Eigen::MatrixXd rootOf(const ParameterSpace& space, Eigen::MatrixXd covariance) {
  const Eigen::Index magnetic = space.effect() - space.joint(kJoints);
  covariance.middleRows(space.joint(kJoints), magnetic).setZero();
  covariance.middleCols(space.joint(kJoints), magnetic).setZero();
  const SymmetricEigen eigen = symmetricEigen(covariance);
  constexpr double kNothing = 1e-14;  // of the largest variance
  const double least = kNothing * eigen.values.maxCoeff();
  Eigen::Index first = 0;
  while (first < covariance.rows() && eigen.values[first] <= least) {
    ++first;
  }
  const Eigen::Index count = covariance.rows() - first;
  return eigen.vectors.rightCols(count) * eigen.values.tail(count).cwiseSqrt().asDiagonal();
}

/// The pose as a sample, its orientation by the frames.
Sample sampleOf(const TrackedPose& pose, const Frames& frames) {
  Sample sample;
  sample.joint_position = pose.joint_position;
  sample.has_orientation = true;
  sample.R_stator_rotor =
      frames.R_stator_tracker * pose.R_tracker_marker * frames.R_rotor_marker.transpose();
  return sample;
}

}  // namespace

Frames turnedByHalf(const Frames& frames,
                    const Eigen::Vector3d& axis_stator,
                    const Eigen::Matrix3d& R_stator_rotor) {
  const Eigen::Matrix3d half = rotationExp(kPi * axis_stator.normalized());
  return {half * frames.R_stator_tracker,
          R_stator_rotor.transpose() * half * R_stator_rotor * frames.R_rotor_marker};
}

double angleBetween(const Frames& a, const Frames& b) {
  return std::max(rotationLog(a.R_stator_tracker * b.R_stator_tracker.transpose()).norm(),
                  rotationLog(a.R_rotor_marker * b.R_rotor_marker.transpose()).norm());
}

FrameFit::FrameFit(const CalibratedDescription& description,
                   const std::vector<TrackedPose>& poses,
                   const EstimationOptions& options)
    : poses_(poses),
      options_(options),
      model_(modelOf(description)),
      root_(rootOf(model_.space(),
                   machineUncertainty(model_.space(), description, options.tolerance))) {
  const JointGeometry joints = jointGeometry(description.actuator);
  R_stator_rotor_.reserve(poses.size());
  for (const TrackedPose& pose : poses) {
    R_stator_rotor_.push_back(rotorOrientation(joints, pose.joint_position));
  }
}

Frames FrameFit::start(const PoseSelection& used) const {
  RotationPairSum sum;
  for (std::size_t n = 0; n < poses_.size(); ++n) {
    if (used[n]) {
      sum.add(poses_[n].R_tracker_marker, R_stator_rotor_[n]);
    }
  }
  const RotationPair frames = sum.nearest();
  return {frames.X, frames.Z};
}

FrameFit::Row FrameFit::row(const ModelPoint& point,
                            const Frames& frames,
                            std::size_t pose,
                            double noise_scale,
                            Linearized at) const {
  const TrackedPose& measured = poses_[pose];
  Sample sample = sampleOf(measured, frames);
  Row row;
  row.residual = point.orientationResidual(sample);
  const Eigen::Matrix3d R_predicted = rotationExp(row.residual).transpose() * sample.R_stator_rotor;
  if (at == Linearized::kAtPrediction) {
    sample.R_stator_rotor = R_predicted;
  }
  ResidualJacobian d_machine;
  const Eigen::Vector3d y = point.orientationResidual(sample, &d_machine);
  // X → e^{ξ̂}X turns e^{ŷ} into e^{ξ̂}e^{ŷ}; Z → e^{ζ̂}Z turns it into e^{ŷ}e^{−(Rζ)^}.
  Eigen::Matrix3Xd jacobian(3, unknowns());
  jacobian.leftCols<3>() = leftJacobianInverse(y);
  jacobian.middleCols<3>(3) = -leftJacobianInverse(-y) * R_predicted;
  jacobian.rightCols(root_.cols()) = d_machine * root_;

  const double stddev = measured.orientation_stddev > 0.0 ? measured.orientation_stddev
                                                          : options_.default_orientation_stddev;
  Eigen::Matrix3d noise = Eigen::Vector3d::Constant(stddev * stddev).asDiagonal();
  for (std::size_t k = 0; k < kJoints; ++k) {
    // An error of a reading acts as an offset of that joint does.
    const Eigen::Vector3d reading = d_machine.col(model_.space().joint(k)) *
                                    measured.joint_stddev[static_cast<Eigen::Index>(k)];
    noise += reading * reading.transpose();
  }
  if (const auto& map = model_.space().nominal().orientation_map) {
    noise.diagonal() += map->uncertainty(measured.joint_position).of_rotor;
  }
  const Eigen::Matrix3d W = whiteningOf(noise_scale * noise_scale * noise);
  row.whitened.residual = W * row.residual;
  row.whitened.jacobian = W * jacobian;
  row.whitened.columns.resize(static_cast<std::size_t>(unknowns()));
  std::iota(row.whitened.columns.begin(), row.whitened.columns.end(), 0);
  return row;
}

/// χ² of the poses that take part, and of the machine.
class FrameFit::Objective {
 public:
  using Point = Solution;

  Objective(const FrameFit& fit, const PoseSelection& used, double noise_scale)
      : fit_(fit), used_(used), noise_scale_(noise_scale) {}

  double cost(const Solution& at) const { return normalEquations(at).cost; }

  NormalEquations normalEquations(const Solution& at) const {
    const ModelPoint point = fit_.pointOf(at);
    InformationSum sum(fit_.unknowns());
    for (std::size_t n = 0; n < used_.size(); ++n) {
      if (used_[n]) {
        sum.add(fit_.row(point, at.frames, n, noise_scale_, Linearized::kAtMeasurement).whitened);
      }
    }
    const Eigen::Index machine = at.w.size();
    sum.addDense(Eigen::MatrixXd::Identity(fit_.unknowns(), fit_.unknowns()).bottomRows(machine),
                 at.w);
    return {sum.squaredMisfit(), sum.gradient(), sum.information()};
  }

  Solution moved(Solution at, const Eigen::VectorXd& step) const {
    at.frames.R_stator_tracker = rotationExp(step.head<3>()) * at.frames.R_stator_tracker;
    at.frames.R_rotor_marker = rotationExp(step.segment<3>(3)) * at.frames.R_rotor_marker;
    at.w += step.tail(at.w.size());
    return at;
  }

  static double nothing(const Solution& /*at*/) {
    return 1e-11;  // [rad], and standard deviations of the machine
  }

 private:
  const FrameFit& fit_;
  const PoseSelection& used_;
  const double noise_scale_;
};

FrameFit::Solution FrameFit::solve(const Frames& start,
                                   const PoseSelection& used,
                                   double noise_scale) const {
  DescentOptions options;
  options.max_iterations = options_.max_iterations;
  options.first_damping = 1e-6;
  std::vector<Solution> path{{start, Eigen::VectorXd::Zero(root_.cols()), 0.0}};
  Objective objective(*this, used, noise_scale);
  descend(objective, options, path);
  Solution solution = path.back();
  solution.cost = objective.cost(solution);
  return solution;
}

FrameFit::Judgement FrameFit::judge(const Solution& solution,
                                    const PoseSelection& used,
                                    double noise_scale) const {
  InformationSum sum(unknowns());
  const ModelPoint point = pointOf(solution);
  std::vector<Row> rows;
  rows.reserve(poses_.size());
  for (std::size_t n = 0; n < poses_.size(); ++n) {
    rows.push_back(row(point, solution.frames, n, noise_scale, Linearized::kAtPrediction));
    if (used[n]) {
      sum.add(rows.back().whitened);
    }
  }
  const Eigen::MatrixXd measured = sum.information();
  Eigen::MatrixXd information = measured;
  information.diagonal().tail(root_.cols()).array() += 1.0;
  const Eigen::MatrixXd covariance =
      solveSemidefinite(information, Eigen::MatrixXd::Identity(unknowns(), unknowns()));
  Judgement judgement;
  judgement.covariance = covariance.topLeftCorner<kFrames, kFrames>();
  judgement.noise_covariance =
      (covariance * measured * covariance).topLeftCorner<kFrames, kFrames>();
  for (std::size_t n = 0; n < poses_.size(); ++n) {
    const Row& each = rows[n];
    // What the pose itself did not pull: the residual's covariance is smaller where it took part.
    const double sign = used[n] ? -1.0 : 1.0;
    const Eigen::Matrix3d spread =
        Eigen::Matrix3d::Identity() +
        sign * each.whitened.times(each.whitened.timesTransposed(covariance));
    const Eigen::Vector3d weighed = solveSemidefinite3(spread, each.whitened.residual);
    const double squared = each.whitened.residual.dot(weighed);
    judgement.poses.push_back(
        {poses_[n].id, each.residual, std::sqrt(std::max(0.0, squared) / 3.0), !used[n]});
    judgement.gain.push_back(used[n] ? squared : 0.0);
  }
  return judgement;
}

}  // namespace sac
