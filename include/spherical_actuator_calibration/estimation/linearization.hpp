#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "spherical_actuator_calibration/estimation/estimation_problem.hpp"
#include "spherical_actuator_calibration/estimation/model_point.hpp"

namespace sac {

/// One observation linearised in all coordinates: residual(x + δ) ≈ residual + jacobian δ.
struct LinearizedObservation {
  Eigen::Vector3d residual;
  ResidualJacobian jacobian;          ///< 3×P, zero where unused
  std::vector<Eigen::Index> columns;  ///< those that are not zero, ascending
  PoseDerivatives d_pose;
};

/// What the tracker's noise is on average of samples: an orientation map's own noise has it, too.
class TrackerNoise {
 public:
  void add(const Sample& sample, const EstimationOptions& options);
  /// Mean over the samples with an orientation, per component [rad²]; zero where there is none.
  double variance() const { return count_ > 0.0 ? sum_ / count_ : 0.0; }

 private:
  double sum_ = 0.0;
  double count_ = 0.0;
};

/// Evaluates the observations of one problem: residuals, Jacobians and covariances.
class ObservationEvaluator {
 public:
  /// Keeps references: the problem must outlive the evaluator.
  ObservationEvaluator(const EstimationProblem& problem, const EstimationOptions& options)
      : ObservationEvaluator(problem, *problem.model, options) {}
  /// Where more samples tell the tracker's noise than the problem has.
  ObservationEvaluator(const EstimationProblem& problem,
                       const EstimationOptions& options,
                       const TrackerNoise& tracker);
  /// In the coordinates of another model, whose first ones are those of the problem.
  ObservationEvaluator(const EstimationProblem& problem,
                       const CalibrationModel& model,
                       const EstimationOptions& options);

  Excitations excitations(std::size_t observation) const {
    const std::size_t first = first_excitation_[observation];
    return {excitations_.data() + first, first_excitation_[observation + 1] - first};
  }

  /// The model at coordinates, for the calls below.
  ModelPoint at(const Eigen::VectorXd& x) const { return {model_, x}; }

  Eigen::Vector3d residual(std::size_t observation, const ModelPoint& point) const;

  /// Fills `out`, whose storage is reused.
  void linearize(std::size_t observation,
                 const ModelPoint& point,
                 LinearizedObservation& out) const;

  /// Covariance of an observation from the sensors' noise alone, joint sensors included, and what
  /// an orientation map leaves open of where the rotor is.
  Eigen::Matrix3d noise(std::size_t observation, const LinearizedObservation& linear) const;

  /// Of noise() what the observations of a dwell do not share: of the measured vector itself, per
  /// component, and by the errors of the joints' readings, ∂residual/∂u in standard deviations.
  double ownVariance(std::size_t observation) const;
  Eigen::Matrix3d ownReadingErrors(std::size_t observation,
                                   const LinearizedObservation& linear) const;
  Eigen::Matrix3d ownNoise(std::size_t observation, const LinearizedObservation& linear) const;
  /// ∂residual/∂u for the errors that they share, in standard deviations: where the rotor is (by
  /// the joints' readings and an orientation map), then torque.
  Eigen::Matrix<double, 3, 6> sharedErrors(std::size_t observation,
                                           const LinearizedObservation& linear) const;

  /// What the prior uncertainty of the coordinates marked in `held` adds.
  Eigen::Matrix3d heldCovariance(const LinearizedObservation& linear,
                                 const std::vector<bool>& held) const;

  /// noise() plus what the prior uncertainty of the coordinates marked in `held` adds to it.
  Eigen::Matrix3d covariance(std::size_t observation,
                             const LinearizedObservation& linear,
                             const std::vector<bool>& held) const;

 private:
  ObservationEvaluator(const EstimationProblem& problem,
                       const CalibrationModel& model,
                       const EstimationOptions& options,
                       const TrackerNoise& tracker);
  Eigen::Vector3d evaluate(std::size_t observation,
                           const ModelPoint& point,
                           LinearizedObservation* linear) const;
  double stddev(std::size_t observation) const;
  void lookUpMap(const OrientationMap& map, double tracker_variance);
  Eigen::Matrix3d rootOfPose(const Eigen::Vector3d& reading,
                             const Eigen::Vector3d& stddevs,
                             const Eigen::Vector3d& left_open) const;

  const EstimationProblem& problem_;
  const CalibrationModel& model_;
  const EstimationOptions& options_;
  std::vector<Excitation> excitations_;          ///< of all observations, one after the other
  std::vector<std::uint32_t> first_excitation_;  ///< per observation, and where the last one ends
  std::vector<bool> uncertain_;                  ///< per coordinate: its prior variance is not zero
  /// Per observation: variance of ξ that an orientation map leaves open [rad²]; empty without one.
  std::vector<Eigen::Vector3d> left_open_;
  JointGeometry joints_;  ///< as drawn, without the map; set where there is one
};

}  // namespace sac
