#include "spherical_actuator_calibration/core/current_allocation.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>

#include "spherical_actuator_calibration/core/error.hpp"
#include "spherical_actuator_calibration/core/value_range.hpp"

namespace spherical_actuator_calibration {
namespace {

constexpr int kMostIterations = 200;
constexpr int kMostBisections = 50;
constexpr double kSameTorque = 1e-10;  // relative

/// Currents of least power within limits for one torque per ampere. With λ the multipliers of QI =
/// T, I = clamp(Qᵀλ), and Q clamp(Qᵀλ) = T is the gradient of a convex, piecewise quadratic
/// function: Newton's method with an exact line search ends after finitely many steps.
class LeastPower {
 public:
  LeastPower(const Eigen::Matrix3Xd& Q, double limit) : Q_(Q), limit_(limit) {}

  std::optional<Eigen::VectorXd> solve(const Eigen::Vector3d& torque) const {
    Eigen::Vector3d lambda = (Q_ * Q_.transpose()).ldlt().solve(torque);
    for (int iteration = 0; iteration < kMostIterations; ++iteration) {
      const Eigen::VectorXd currents = clamped(lambda);
      const Eigen::Vector3d misfit = torque - Q_ * currents;
      if (misfit.norm() <= kSameTorque * torque.norm()) {
        return currents;
      }
      const std::optional<Eigen::Vector3d> step = newtonStep(lambda, misfit);
      if (!step) {
        return std::nullopt;
      }
      lambda = descended(lambda, *step, torque);
    }
    return std::nullopt;
  }

 private:
  Eigen::VectorXd clamped(const Eigen::Vector3d& lambda) const {
    return (Q_.transpose() * lambda).cwiseMax(-limit_).cwiseMin(limit_);
  }

  /// Nothing when the coils below their limit make no torque in some direction.
  std::optional<Eigen::Vector3d> newtonStep(const Eigen::Vector3d& lambda,
                                            const Eigen::Vector3d& misfit) const {
    Eigen::Matrix3d curvature = Eigen::Matrix3d::Zero();
    for (const auto& column : Q_.colwise()) {
      if (std::abs(column.dot(lambda)) < limit_) {
        curvature += column * column.transpose();
      }
    }
    // A little of the whole keeps the step finite near the edge of what can be reached.
    constexpr double kRegularisation = 1e-9;
    curvature += kRegularisation * (Q_ * Q_.transpose());
    const Eigen::LLT<Eigen::Matrix3d> factor(curvature);
    if (factor.info() != Eigen::Success) {
      return std::nullopt;
    }
    return factor.solve(misfit);
  }

  /// Minimum of the dual along a step: where its slope, which grows along it, changes sign.
  Eigen::Vector3d descended(const Eigen::Vector3d& lambda,
                            const Eigen::Vector3d& step,
                            const Eigen::Vector3d& torque) const {
    const auto slope = [&](double length) {
      return (Q_ * clamped(lambda + length * step) - torque).dot(step);
    };
    constexpr double kLongest = 1e6;
    double low = 0.0;
    double high = 1.0;
    while (slope(high) < 0.0 && high < kLongest) {
      low = high;
      high *= 2.0;
    }
    for (int n = 0; n < kMostBisections; ++n) {
      const double middle = 0.5 * (low + high);
      (slope(middle) < 0.0 ? low : high) = middle;
    }
    return lambda + high * step;
  }

  const Eigen::Matrix3Xd& Q_;
  double limit_;
};

/// Largest share of a torque that the limits allow, and its currents.
AllocatedCurrents largestShare(const LeastPower& problem,
                               const Eigen::Vector3d& torque,
                               Eigen::Index coils) {
  AllocatedCurrents result;
  result.outcome = Allocation::kLimited;
  result.currents = Eigen::VectorXd::Zero(coils);
  double unreachable = 1.0;
  for (int n = 0; n < kMostBisections; ++n) {
    const double share = 0.5 * (result.share + unreachable);
    if (const auto currents = problem.solve(share * torque)) {
      result.share = share;
      result.currents = *currents;
    } else {
      unreachable = share;
    }
  }
  return result;
}

}  // namespace

AllocatedCurrents allocateCurrents(const Eigen::Matrix3Xd& torque_per_ampere,
                                   const Eigen::Vector3d& torque,
                                   const AllocationOptions& options) {
  requireInRange("current limit", options.current_limit, ValueRange::positive("A"));
  requireInRange(
      "least singular value", options.least_singular_value, ValueRange::positive("N m/A"));
  if (!torque.allFinite() || !torque_per_ampere.allFinite()) {
    throw DataError("The torque to be made is not finite.");
  }
  const Eigen::Matrix3d gram = torque_per_ampere * torque_per_ampere.transpose();
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen(gram, Eigen::EigenvaluesOnly);
  const double smallest = std::sqrt(std::max(0.0, eigen.eigenvalues()[0]));
  AllocatedCurrents result;
  result.currents = Eigen::VectorXd::Zero(torque_per_ampere.cols());
  if (smallest >= options.least_singular_value) {
    const LeastPower problem(torque_per_ampere, options.current_limit);
    if (torque.isZero(0.0)) {
      result.outcome = Allocation::kReached;
      result.share = 1.0;
    } else if (const auto currents = problem.solve(torque)) {
      result.outcome = Allocation::kReached;
      result.share = 1.0;
      result.currents = *currents;
    } else {
      result = largestShare(problem, torque, torque_per_ampere.cols());
    }
  }
  result.smallest_singular_value = smallest;
  return result;
}

}  // namespace spherical_actuator_calibration
