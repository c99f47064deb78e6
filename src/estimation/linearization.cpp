#include "spherical_actuator_calibration/estimation/linearization.hpp"

#include <algorithm>
#include <cmath>

#include <boost/container/small_vector.hpp>

#include "spherical_actuator_calibration/base/cholesky.hpp"

namespace sac {
namespace {

double orientationStddev(const Sample& sample, const EstimationOptions& options) {
  return sample.orientation_stddev > 0.0 ? sample.orientation_stddev
                                         : options.default_orientation_stddev;
}

/// Of all samples of a problem. Without a map nothing depends on it.
TrackerNoise trackerNoise(const EstimationProblem& problem,
                          const CalibrationModel& model,
                          const EstimationOptions& options) {
  TrackerNoise noise;
  if (model.hasOrientationMap()) {
    for (const Sample& sample : *problem.samples) {
      noise.add(sample, options);
    }
  }
  return noise;
}

}  // namespace

void TrackerNoise::add(const Sample& sample, const EstimationOptions& options) {
  if (sample.has_orientation) {
    sum_ += std::pow(orientationStddev(sample, options), 2);
    count_ += 1.0;
  }
}

ObservationEvaluator::ObservationEvaluator(const EstimationProblem& problem,
                                           const CalibrationModel& model,
                                           const EstimationOptions& options)
    : ObservationEvaluator(problem, model, options, trackerNoise(problem, model, options)) {}

ObservationEvaluator::ObservationEvaluator(const EstimationProblem& problem,
                                           const EstimationOptions& options,
                                           const TrackerNoise& tracker)
    : ObservationEvaluator(problem, *problem.model, options, tracker) {}

ObservationEvaluator::ObservationEvaluator(const EstimationProblem& problem,
                                           const CalibrationModel& model,
                                           const EstimationOptions& options,
                                           const TrackerNoise& tracker)
    : problem_(problem),
      model_(model),
      options_(options),
      uncertain_(static_cast<std::size_t>(problem.prior.covariance.rows())) {
  for (std::size_t p = 0; p < uncertain_.size(); ++p) {
    const auto diagonal = static_cast<Eigen::Index>(p);
    uncertain_[p] = problem.prior.covariance(diagonal, diagonal) > 0.0;
  }
  first_excitation_.reserve(problem.observations.size() + 1);
  first_excitation_.push_back(0);
  for (const Observation& observation : problem.observations) {
    if (observation.quantity == Quantity::kTorque) {
      for (const Excitation& excitation :
           excitedCoils((*problem.samples)[observation.sample], options.current_threshold)) {
        excitations_.push_back(excitation);
      }
    }
    first_excitation_.push_back(static_cast<std::uint32_t>(excitations_.size()));
  }
  excitations_.shrink_to_fit();
  if (model.hasOrientationMap()) {
    joints_ = jointGeometry(model.space().nominal().joints);
    lookUpMap(*model.space().nominal().orientation_map, tracker.variance());
  }
}

/// A map's noise is what poses differ by beside the smooth part, as the tracker told it: its own
/// noise is none of the rotor.
void ObservationEvaluator::lookUpMap(const OrientationMap& map, double tracker_variance) {
  left_open_.reserve(problem_.observations.size());
  const Sample* before = nullptr;
  for (const Observation& observation : problem_.observations) {
    const Sample& sample = (*problem_.samples)[observation.sample];
    if (before != nullptr && before->joint_position == sample.joint_position) {
      left_open_.push_back(left_open_.back());
    } else {
      const OrientationMap::Uncertainty uncertainty = map.uncertainty(sample.joint_position);
      left_open_.push_back(uncertainty.variance +
                           (uncertainty.noise.array() - tracker_variance).max(0.0).matrix());
    }
    before = &sample;
  }
}

Eigen::Vector3d ObservationEvaluator::residual(std::size_t observation,
                                               const ModelPoint& point) const {
  return evaluate(observation, point, nullptr);
}

Eigen::Vector3d ObservationEvaluator::evaluate(std::size_t observation,
                                               const ModelPoint& point,
                                               LinearizedObservation* linear) const {
  const Observation& what = problem_.observations[observation];
  const Sample& sample = (*problem_.samples)[what.sample];
  ResidualJacobian* const jacobian = linear == nullptr ? nullptr : &linear->jacobian;
  PoseDerivatives* const d_pose = linear == nullptr ? nullptr : &linear->d_pose;
  if (what.quantity == Quantity::kTorque) {
    return point.torqueResidual(sample, excitations(observation), jacobian, d_pose);
  }
  return point.orientationResidual(sample, jacobian, d_pose);
}

void ObservationEvaluator::linearize(std::size_t observation,
                                     const ModelPoint& point,
                                     LinearizedObservation& out) const {
  const ParameterSpace& space = model_.space();
  const bool is_torque = problem_.observations[observation].quantity == Quantity::kTorque;
  out.residual = evaluate(observation, point, &out);
  out.columns.clear();
  const auto take = [&out](Eigen::Index first, Eigen::Index last) {
    const Eigen::Index all = out.jacobian.cols();
    const double* const J = out.jacobian.data();
    for (Eigen::Index p = first; p < last; ++p) {
      // Most poles are out of reach of a coil, and most effects act on some observations alone.
      if (J[p] != 0.0 || J[all + p] != 0.0 || J[2 * all + p] != 0.0) {
        out.columns.push_back(p);
      }
    }
  };
  take(0, is_torque ? space.coil(0) : space.pole(0));
  for (const Excitation& excitation : excitations(observation)) {
    take(space.coil(excitation.coil), space.coil(excitation.coil) + ParameterSpace::kPerAxis);
  }
  take(space.effect(), space.size());
}

double ObservationEvaluator::stddev(std::size_t observation) const {
  const Observation& what = problem_.observations[observation];
  const Sample& sample = (*problem_.samples)[what.sample];
  if (what.quantity == Quantity::kOrientation) {
    return orientationStddev(sample, options_);
  }
  return sample.torque_stddev > 0.0 ? sample.torque_stddev : options_.default_torque_stddev;
}

Eigen::Matrix3d ObservationEvaluator::noise(std::size_t observation,
                                            const LinearizedObservation& linear) const {
  const Observation& what = problem_.observations[observation];
  const Sample& sample = (*problem_.samples)[what.sample];
  const double stddev = this->stddev(observation);
  const Eigen::Matrix3d of_reading = linear.d_pose.reading * sample.joint_stddev.asDiagonal();
  Eigen::Matrix3d noise = of_reading * of_reading.transpose();
  if (!left_open_.empty()) {
    const Eigen::Matrix3d& d_rotation = linear.d_pose.rotation;
    noise += d_rotation * left_open_[observation].asDiagonal() * d_rotation.transpose();
  }
  noise.diagonal().array() += stddev * stddev;
  return noise;
}

double ObservationEvaluator::ownVariance(std::size_t observation) const {
  // What is shared can be all of it only by rounding: a weight must stay finite.
  constexpr double kLeastShare = 1e-6;
  const Observation& what = problem_.observations[observation];
  const Sample& sample = (*problem_.samples)[what.sample];
  const double stddev = this->stddev(observation);
  const double all = stddev * stddev;
  const double shared = what.quantity == Quantity::kTorque
                            ? sample.torque_shared_stddev * sample.torque_shared_stddev
                            : 0.0;
  return std::max(all - shared, kLeastShare * all);
}

Eigen::Matrix3d ObservationEvaluator::ownReadingErrors(std::size_t observation,
                                                       const LinearizedObservation& linear) const {
  const Sample& sample = (*problem_.samples)[problem_.observations[observation].sample];
  const Eigen::Vector3d shared = sharedJointStddev(sample);
  const Eigen::Vector3d own =
      (sample.joint_stddev.cwiseAbs2() - shared.cwiseAbs2()).cwiseMax(0.0).cwiseSqrt();
  return linear.d_pose.reading * own.asDiagonal();
}

Eigen::Matrix3d ObservationEvaluator::ownNoise(std::size_t observation,
                                               const LinearizedObservation& linear) const {
  const Eigen::Matrix3d of_readings = ownReadingErrors(observation, linear);
  Eigen::Matrix3d noise = of_readings * of_readings.transpose();
  noise.diagonal().array() += ownVariance(observation);
  return noise;
}

/// L with LLᵀ the covariance of ξ by errors of a reading, `stddevs`, and by what a map leaves open.
/// The readings of a dwell agree, so that its observations share ξ.
Eigen::Matrix3d ObservationEvaluator::rootOfPose(const Eigen::Vector3d& reading,
                                                 const Eigen::Vector3d& stddevs,
                                                 const Eigen::Vector3d& left_open) const {
  const Eigen::Matrix3d of_reading =
      linearizeRotorOrientation(joints_, reading).d_offset * stddevs.asDiagonal();
  Eigen::Matrix3d covariance = of_reading * of_reading.transpose();
  covariance.diagonal() += left_open;
  return Cholesky3(covariance).lower();
}

Eigen::Matrix<double, 3, 6> ObservationEvaluator::sharedErrors(
    std::size_t observation, const LinearizedObservation& linear) const {
  const Observation& what = problem_.observations[observation];
  const Sample& sample = (*problem_.samples)[what.sample];
  Eigen::Matrix<double, 3, 6> result = Eigen::Matrix<double, 3, 6>::Zero();
  const Eigen::Vector3d shared = sharedJointStddev(sample);
  result.leftCols<3>() =
      left_open_.empty()
          ? Eigen::Matrix3d(linear.d_pose.reading * shared.asDiagonal())
          : Eigen::Matrix3d(linear.d_pose.rotation *
                            rootOfPose(sample.joint_position, shared, left_open_[observation]));
  if (what.quantity == Quantity::kTorque) {
    result.rightCols<3>() = sample.torque_shared_stddev * Eigen::Matrix3d::Identity();
  }
  return result;
}

Eigen::Matrix3d ObservationEvaluator::heldCovariance(const LinearizedObservation& linear,
                                                     const std::vector<bool>& held) const {
  boost::container::small_vector<Eigen::Index, 32> columns;
  for (const Eigen::Index a : linear.columns) {
    const auto place = static_cast<std::size_t>(a);
    if (held[place] && uncertain_[place]) {
      columns.push_back(a);
    }
  }
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  for (const Eigen::Index a : columns) {
    Eigen::Vector3d effect = Eigen::Vector3d::Zero();
    for (const Eigen::Index b : columns) {
      effect += linear.jacobian.col(b) * problem_.prior.covariance(b, a);
    }
    covariance += linear.jacobian.col(a) * effect.transpose();
  }
  return covariance;
}

Eigen::Matrix3d ObservationEvaluator::covariance(std::size_t observation,
                                                 const LinearizedObservation& linear,
                                                 const std::vector<bool>& held) const {
  return noise(observation, linear) + heldCovariance(linear, held);
}

}  // namespace sac
