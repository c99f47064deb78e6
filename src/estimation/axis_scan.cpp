#include "axis_scan.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

#include <Eigen/Geometry>
#include <Eigen/LU>

#include "spherical_actuator_calibration/actuator/torque_model.hpp"
#include "spherical_actuator_calibration/base/symmetric_matrix.hpp"

namespace sac {
namespace {

/// The basins of a torque curve are wider than a step for ranges of up to 0.2 rad.
constexpr int kCoarseSteps = 4;
/// Few torques fit in many places, on both sides of the curve's peak: looked for more closely.
constexpr std::size_t kFewTorques = 3;
constexpr int kFineSteps = 18;
/// What an axis's torques leave open of it, in χ²: six standard deviations.
constexpr double kWithin = 36.0;

}  // namespace

double AxisScan::reach(double range) {
  // To the corners, a step beyond the edge; angles and coordinates differ by less than a tenth.
  return 1.1 * std::sqrt(2.0) * (range + range / kCoarseSteps);
}

AxisScan::AxisScan(const TorqueCurve& curve,
                   const TabulatedCurve& tabulated_curve,
                   const AxisChart& chart,
                   bool is_pole,
                   ScannedTorques torques,
                   double range,
                   double transition)
    : curve_(curve),
      tabulated_curve_(tabulated_curve),
      chart_(chart),
      is_pole_(is_pole),
      scanned_(std::move(torques)),
      limit_(transition * transition),
      range_(range),
      steps_(scanned_.torques.size() <= kFewTorques ? kFineSteps : kCoarseSteps),
      step_(range / steps_) {}

/// Of a place of the grid: what decides where to look closely.
double AxisScan::coarseMisfit(const Eigen::Vector2d& place) const {
  constexpr double kLarge = 1e100;
  const Eigen::Vector3d axis = chart_.axis(place[0], place[1]);
  const double sign = is_pole_ ? 1.0 : -1.0;
  double sum = 0.0;
  double product = 1.0;  // of what the logarithms would be summed up of
  for (const ScannedTorque& torque : scanned_.torques) {
    const Eigen::Vector3d own = torque.to_rotor * axis;
    Eigen::Vector3d rest = torque.rest;
    for (const ScannedPartner& partner : torque.partners) {
      if (interacts(curve_, partner.axis_rotor, own)) {
        const double h = tabulated_curve_.at(own.dot(partner.axis_rotor)).h;
        rest -= sign * partner.weight * h * own.cross(partner.axis_rotor);
      }
    }
    product *= 1.0 + (torque.whitening * rest).squaredNorm() / limit_;
    if (product > kLarge) {
      sum += std::log(product);
      product = 1.0;
    }
  }
  return limit_ * (sum + std::log(product));
}

AxisScan::Normal AxisScan::linearized(const Eigen::Vector2d& place) const {
  Eigen::Vector3d axis;
  Eigen::Matrix<double, 3, 2> d_axis;
  chart_.evaluate(place[0], place[1], axis, d_axis);
  Normal normal;
  WhitenedObservation whitened;
  whitened.columns = {0, 1};
  for (const ScannedTorque& torque : scanned_.torques) {
    const Eigen::Vector3d own = torque.to_rotor * axis;
    Eigen::Vector3d rest = torque.rest;
    Eigen::Matrix3d d_own = Eigen::Matrix3d::Zero();
    for (const ScannedPartner& partner : torque.partners) {
      if (interacts(curve_, partner.axis_rotor, own)) {
        const PairTorque pair = is_pole_ ? linearizePairTorque(curve_, own, partner.axis_rotor)
                                         : linearizePairTorque(curve_, partner.axis_rotor, own);
        rest -= partner.weight * pair.torque;
        d_own -= partner.weight * (is_pole_ ? pair.d_pole : pair.d_coil);
      }
    }
    whitened.residual = torque.whitening * rest;
    whitened.jacobian = torque.whitening * d_own * torque.to_rotor * d_axis;
    const double square = whitened.residual.squaredNorm() / limit_;
    normal.misfit += limit_ * std::log1p(square);
    normal.sum.add(whitened, 1.0 / (1.0 + square));
  }
  return normal;
}

/// The minimum below a place of the scan, among those that the projection `allowed` leads to.
Eigen::Vector2d AxisScan::descended(Eigen::Vector2d place, const Eigen::Matrix2d& allowed) const {
  constexpr int kMaxIterations = 20;
  constexpr double kNothing = 1e-5;  // [rad]: the estimator goes on from there
  double damping = 1e-3;
  Normal here = linearized(place);
  for (int iteration = 0; iteration < kMaxIterations; ++iteration) {
    Eigen::Matrix2d damped = allowed * here.sum.information() * allowed;
    damped.diagonal() *= 1.0 + damping;
    damped.diagonal().array() += 1e-6;
    Eigen::Vector2d step = damped.inverse() * (allowed * -here.sum.gradient());
    // Beyond one step of the scan is another place of it.
    step *= std::min(1.0, step_ / std::max(step.norm(), kNothing));
    const Normal there = linearized(place + step);
    if (there.misfit < here.misfit) {
      place += step;
      here = there;
      damping *= 0.1;
      if (step.norm() < kNothing) {
        break;
      }
    } else {
      damping *= 10.0;
      if (step.norm() < kNothing) {
        break;
      }
    }
  }
  return place;
}

/// Places of the scan that no neighbour is better than, best first.
std::vector<Eigen::Vector2d> AxisScan::localMinima() const {
  const int width = 2 * steps_ + 1;
  const auto place = [this](int row, int column) {
    return Eigen::Vector2d(step_ * (row - steps_), step_ * (column - steps_));
  };
  Eigen::MatrixXd misfits(width, width);
  for (int row = 0; row < width; ++row) {
    for (int column = 0; column < width; ++column) {
      misfits(row, column) = coarseMisfit(place(row, column));
    }
  }
  std::vector<std::pair<double, Eigen::Vector2d>> minima;
  for (int row = 0; row < width; ++row) {
    for (int column = 0; column < width; ++column) {
      const int top = std::max(row - 1, 0);
      const int left = std::max(column - 1, 0);
      const double least = misfits
                               .block(top,
                                      left,
                                      std::min(row + 1, width - 1) - top + 1,
                                      std::min(column + 1, width - 1) - left + 1)
                               .minCoeff();
      if (misfits(row, column) <= least) {
        minima.emplace_back(misfits(row, column), place(row, column));
      }
    }
  }
  std::sort(
      minima.begin(), minima.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  std::vector<Eigen::Vector2d> places;
  places.reserve(minima.size());
  for (const auto& [value, where] : minima) {
    places.push_back(where);
  }
  return places;
}

/// Places along the direction in which the torques tell least of an axis, beyond what they leave
/// open of it, each the best one across. Where torques are few they lie in a valley that is thinner
/// than a step of the scan, and bent, as the torque curve is nearly the same on both sides of its
/// peak.
std::vector<Eigen::Vector2d> AxisScan::alongValley(const Eigen::Vector2d& present,
                                                   const Eigen::Matrix2d& information) const {
  std::vector<Eigen::Vector2d> places;
  const SymmetricEigen spectrum = symmetricEigen(information);
  const double weakest = spectrum.values[0];
  if (weakest <= 0.0) {
    return places;
  }
  const Eigen::Vector2d along = spectrum.vectors.col(0);
  const Eigen::Vector2d across = spectrum.vectors.col(1);
  for (double far = std::sqrt(kWithin / weakest); far < range_; far *= 2.0) {
    places.push_back(descended(present + far * along, across * across.transpose()));
    places.push_back(descended(present - far * along, across * across.transpose()));
  }
  return places;
}

std::vector<ScannedPlace> AxisScan::others(const Eigen::Vector2d& present) const {
  constexpr std::size_t kMostStarts = 4;
  constexpr std::size_t kMostFineStarts = 64;
  constexpr double kFarBetter = 16.0;  // of χ²
  constexpr double kSamePlace = 1e-3;  // [rad]
  std::vector<ScannedPlace> found;
  if (scanned_.torques.empty()) {
    return found;
  }
  const Normal here = linearized(present);
  const Eigen::Matrix2d information = here.sum.information();
  const auto is_known = [&](const ScannedPlace& there) {
    const Eigen::Vector2d apart = there.place - present;
    const bool is_within = apart.dot(information * apart) < kWithin && there.gain < kFarBetter;
    return is_within || apart.norm() < kSamePlace ||
           std::any_of(found.begin(), found.end(), [&](const ScannedPlace& other) {
             return (other.place - there.place).norm() < kSamePlace;
           });
  };
  const auto add = [&](const Eigen::Vector2d& place) {
    const ScannedPlace there{place, here.misfit - linearized(place).misfit};
    if (isWithin(place) && !is_known(there)) {
      found.push_back(there);
    }
  };
  const Eigen::Matrix2d all = Eigen::Matrix2d::Identity();
  std::vector<Eigen::Vector2d> starts = localMinima();
  starts.resize(std::min(starts.size(), steps_ == kCoarseSteps ? kMostStarts : kMostFineStarts));
  for (const Eigen::Vector2d& start : starts) {
    add(descended(start, all));
  }
  if (steps_ == kFineSteps) {
    for (const Eigen::Vector2d& place : alongValley(present, information)) {
      add(descended(place, all));
      add(place);
    }
  }
  for (ScannedPlace& there : found) {
    there.gain *= scanned_.each_stands_for;
  }
  return found;
}

}  // namespace sac
