#include "spherical_actuator_calibration/estimation/shared_errors.hpp"

#include <algorithm>

#include "spherical_actuator_calibration/base/cholesky.hpp"
#include "spherical_actuator_calibration/estimation/same_dwell.hpp"

namespace sac {
namespace {

/// Readings with independent errors of the stated size agree this well in all three joints once in
/// twenty times; those that share their error always do.
constexpr double kAgreement = 0.7;
constexpr double kRounding = 1e-9;  // [rad]

}  // namespace

bool isSameDwell(const Sample& one, const Sample& other) {
  if (one.dwell != 0 && other.dwell != 0) {
    return one.dwell == other.dwell;
  }
  const Eigen::Vector3d limit =
      (kAgreement * one.joint_stddev).cwiseMin(kAgreement * other.joint_stddev).cwiseMax(kRounding);
  const Eigen::Vector3d apart = (one.joint_position - other.joint_position).cwiseAbs();
  return (apart.array() <= limit.array()).all();
}

bool hasSharedErrors(const Sample& sample, const CalibrationModel& model) {
  return model.hasOrientationMap() || !sharedJointStddev(sample).isZero(0.0) ||
         (sample.has_torque && sample.torque_shared_stddev > 0);
}

SharedErrorModel groupByDwell(const EstimationProblem& problem, const EstimationOptions& options) {
  SharedErrorModel model;
  const std::size_t count = problem.observations.size();
  model.shares.assign(count, false);
  if (!options.shared_errors) {
    return model;
  }
  const std::vector<Sample>& samples = *problem.samples;
  std::vector<std::size_t> dwell;
  const auto close = [&] {
    if (dwell.size() > 1) {
      for (const std::size_t n : dwell) {
        model.shares[n] = true;
      }
      model.dwells.push_back(dwell);
    }
    dwell.clear();
  };
  for (std::size_t n = 0; n < count; ++n) {
    const Sample& sample = samples[problem.observations[n].sample];
    if (!dwell.empty() &&
        !isSameDwell(samples[problem.observations[dwell.front()].sample], sample)) {
      close();
    }
    if (hasSharedErrors(sample, *problem.model)) {
      dwell.push_back(n);
    } else {
      close();
    }
  }
  close();
  if (!model.dwells.empty()) {
    model.loading.assign(count, SharedLoading::Zero());
  }
  return model;
}

DwellElimination::DwellElimination()
    : information_(Eigen::Matrix<double, kSharedErrors, kSharedErrors>::Identity()),
      gradient_(SharedErrors::Zero()) {}

void DwellElimination::add(const SharedLoading& loading,
                           const Eigen::Vector3d& residual,
                           double weight) {
  information_.noalias() += weight * loading.transpose() * loading;
  gradient_.noalias() += weight * loading.transpose() * residual;
  squares_ += weight * residual.squaredNorm();
}

void DwellElimination::remove(const SharedLoading& loading, const Eigen::Vector3d& residual) {
  add(loading, residual, -1.0);
}

SharedErrors DwellElimination::errors() const {
  return Cholesky(information_).solve(gradient_);
}

Eigen::Matrix<double, kSharedErrors, kSharedErrors> DwellElimination::covariance() const {
  return Cholesky(information_).inverse();
}

double DwellElimination::squaredMisfit() const {
  return squares_ - gradient_.dot(errors());
}

void DwellSum::begin() {
  entries_.clear();
  for (const Eigen::Index column : columns_) {
    crossed_.col(column).setZero();
    touched_[static_cast<std::size_t>(column)] = false;
  }
  columns_.clear();
  elimination_ = DwellElimination();
}

void DwellSum::add(const WhitenedObservation& observation,
                   const SharedLoading& loading,
                   double weight) {
  entries_.push_back({observation, loading, weight});
  elimination_.add(loading, observation.residual, weight);
  for (std::size_t k = 0; k < observation.columns.size(); ++k) {
    const Eigen::Index column = observation.columns[k];
    crossed_.col(column) +=
        weight * loading.transpose() * observation.jacobian.col(static_cast<Eigen::Index>(k));
    if (!touched_[static_cast<std::size_t>(column)]) {
      touched_[static_cast<std::size_t>(column)] = true;
      columns_.push_back(column);
    }
  }
}

std::vector<Eigen::Index> DwellSum::touched() const {
  std::vector<Eigen::Index> columns = columns_;
  std::sort(columns.begin(), columns.end());
  return columns;
}

}  // namespace sac
