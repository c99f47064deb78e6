#include "spherical_actuator_calibration/control/current_allocation.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include <Eigen/Geometry>

#include "spherical_actuator_calibration/base/cholesky.hpp"
#include "spherical_actuator_calibration/base/error.hpp"
#include "spherical_actuator_calibration/base/symmetric_matrix.hpp"
#include "spherical_actuator_calibration/base/value_range.hpp"

namespace sac {
namespace {

constexpr int kMostIterations = 200;
constexpr int kMostBisections = 50;
constexpr double kSameTorque = 1e-10;  // relative
constexpr double kGoodStep = 0.5;      // by which a whole step lessens the misfit

/// Currents of least power within limits for one torque per ampere. With λ the multipliers of QI =
/// T, I = clamp(Qᵀλ), and Q clamp(Qᵀλ) = T is the gradient of a convex, piecewise quadratic
/// function: Newton's method with an exact line search ends after finitely many steps.
class LeastPower {
 public:
  LeastPower(const Eigen::Matrix3Xd& Q, double limit) : Q_(Q), limit_(limit) {}

  std::optional<Eigen::VectorXd> solve(const Eigen::Vector3d& torque) const {
    Eigen::Vector3d lambda = solveSemidefinite3(Q_ * Q_.transpose(), torque);
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
      const Eigen::Vector3d whole = lambda + *step;
      const bool is_good = (torque - Q_ * clamped(whole)).norm() < kGoodStep * misfit.norm();
      lambda = is_good ? whole : descended(lambda, *step, torque);
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
    for (Eigen::Index j = 0; j < Q_.cols(); ++j) {
      const Eigen::Vector3d column = Q_.col(j);
      if (std::abs(column.dot(lambda)) < limit_) {
        curvature += column * column.transpose();
      }
    }
    // A little of the whole keeps the step finite near the edge of what can be reached.
    constexpr double kRegularisation = 1e-9;
    curvature += kRegularisation * (Q_ * Q_.transpose());
    const Cholesky3 factor(curvature);
    if (!factor.isPositive()) {
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

/// Largest share of a torque that currents within the limits can make, above 1 as well. What they
/// can make is a zonotope: the intersection of the slabs |n·T| ≤ limit Σ|q·n| over the normals n =
/// q_i × q_j of its faces.
double reachableShare(const Eigen::Matrix3Xd& Q, const Eigen::Vector3d& torque, double limit) {
  double share = std::numeric_limits<double>::infinity();
  for (Eigen::Index i = 0; i < Q.cols(); ++i) {
    const Eigen::Vector3d q_i = Q.col(i);
    for (Eigen::Index j = i + 1; j < Q.cols(); ++j) {
      const Eigen::Vector3d normal = q_i.cross(Eigen::Vector3d(Q.col(j)));
      const double wanted = std::abs(torque.dot(normal));
      const double most = limit * (normal.transpose() * Q).cwiseAbs().sum();
      if (most < share * wanted) {
        share = most / wanted;
      }
    }
  }
  return share;
}

/// Currents of least power for the largest share of a torque that the limits allow.
AllocatedCurrents limitedCurrents(const Eigen::Matrix3Xd& Q,
                                  const Eigen::Vector3d& torque,
                                  double limit,
                                  const Eigen::VectorXd& minimum_norm) {
  // At the very edge of what can be reached the solution has no interior to be found in.
  constexpr double kInside = 1.0 - 1e-3;
  AllocatedCurrents result;
  result.share = std::min(1.0, kInside * reachableShare(Q, torque, limit));
  result.outcome = result.share < 1.0 ? Allocation::kLimited : Allocation::kReached;
  const auto currents = LeastPower(Q, limit).solve(result.share * torque);
  if (currents) {
    result.currents = *currents;
    return result;
  }
  // So close to the edge that it was not found: less torque, in the same direction.
  result.outcome = Allocation::kLimited;
  result.share = limit / minimum_norm.cwiseAbs().maxCoeff();
  result.currents = result.share * minimum_norm;
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
  const double smallest = std::sqrt(std::max(0.0, symmetricEigenvalues(gram)[0]));
  AllocatedCurrents result;
  result.currents = Eigen::VectorXd::Zero(torque_per_ampere.cols());
  if (smallest >= options.least_singular_value) {
    const Eigen::VectorXd minimum_norm =
        torque_per_ampere.transpose() * solveSemidefinite3(gram, torque);
    if (minimum_norm.cwiseAbs().maxCoeff() <= options.current_limit) {
      result.outcome = Allocation::kReached;
      result.share = 1.0;
      result.currents = minimum_norm;
    } else {
      result = limitedCurrents(torque_per_ampere, torque, options.current_limit, minimum_norm);
    }
  }
  result.smallest_singular_value = smallest;
  return result;
}

}  // namespace sac
