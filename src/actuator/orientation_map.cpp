#include "spherical_actuator_calibration/actuator/orientation_map.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "spherical_actuator_calibration/base/error.hpp"

namespace sac {
namespace {

void requirePositive(const std::array<double, 3>& values, const char* key) {
  for (const double value : values) {
    if (!(std::isfinite(value) && value > 0.0)) {
      throw ConfigError(std::string("orientation_map.") + key + ": every value must be positive.");
    }
  }
}

void requireFinite(const std::vector<Eigen::Vector3d>& points, const char* key) {
  if (!std::all_of(points.begin(), points.end(), [](const auto& p) { return p.allFinite(); })) {
    throw ConfigError(std::string("orientation_map.") + key + ": every number must be finite.");
  }
}

/// 2 sin(Δq/2) of two readings of a joint: their distance, a whole turn apart.
double chordBetween(double a, double b) {
  return 2.0 * std::abs(std::sin(0.5 * (a - b)));
}

/// Share of the map that counts at a reading: 1 where each joint's reading is near to some of the
/// points' (a sixth of their range), and falling to 0 within kFalloff beyond. How far what was seen
/// goes on, points tell little of: their lengths come from within.
double shareAt(const Eigen::Matrix3Xd& points, const Eigen::Vector3d& reading) {
  constexpr double kFalloff = 0.3;  // [rad]
  constexpr double kPartOfRange = 6.0;
  constexpr double kWholeTurn = 2.0;    // as a chord
  constexpr double kLeastReach = 0.05;  // [rad]
  double square = 0.0;
  for (Eigen::Index k = 0; k < points.rows(); ++k) {
    const double range = std::min(kWholeTurn, points.row(k).maxCoeff() - points.row(k).minCoeff());
    double nearest = kWholeTurn;
    for (Eigen::Index n = 0; n < points.cols(); ++n) {
      nearest = std::min(nearest, chordBetween(points(k, n), reading[k]));
    }
    const double beyond = std::max(0.0, nearest - std::max(kLeastReach, range / kPartOfRange));
    square += beyond * beyond / (kFalloff * kFalloff);
  }
  return square < 1.0 ? (1.0 - square) * (1.0 - square) : 0.0;
}

}  // namespace

void validate(const OrientationMapDescription& description) {
  requirePositive(description.length, "length");
  requirePositive(description.amplitude, "amplitude");
  requirePositive(description.noise, "noise");
  if (!std::isfinite(description.tracker_noise) || description.tracker_noise < 0.0) {
    throw ConfigError("orientation_map.tracker_noise: it must be finite, and not negative.");
  }
  const std::size_t points = description.readings.size();
  if (points == 0 || points > kMostMapPoints || description.rotations.size() != points) {
    throw ConfigError("orientation_map: " + std::to_string(points) + " readings and " +
                      std::to_string(description.rotations.size()) +
                      " rotations; as many of both are needed, from 1 to " +
                      std::to_string(kMostMapPoints) + ".");
  }
  requireFinite(description.readings, "readings");
  requireFinite(description.rotations, "rotations");
}

double mapKernel(const std::array<double, 3>& length,
                 const Eigen::Vector3d& a,
                 const Eigen::Vector3d& b) {
  double square = 0.0;
  for (std::size_t k = 0; k < length.size(); ++k) {
    const auto joint = static_cast<Eigen::Index>(k);
    const double chord = 2.0 * std::sin(0.5 * (a[joint] - b[joint])) / length[k];
    square += chord * chord;
  }
  // Matérn's of order 5/2.
  const double root = std::sqrt(5.0 * square);
  return (1.0 + root + root * root / 3.0) * std::exp(-root);
}

OrientationMap::OrientationMap(OrientationMapDescription description)
    : description_(std::move(description)) {
  validate(description_);
  const auto points = static_cast<Eigen::Index>(description_.readings.size());
  readings_.resize(3, points);
  weights_.resize(points, 3);
  Eigen::MatrixXd gram(points, points);
  for (Eigen::Index n = 0; n < points; ++n) {
    readings_.col(n) = description_.readings[static_cast<std::size_t>(n)];
    gram.row(n).head(n + 1) = kernel(readings_.col(n)).head(n + 1).transpose();
    weights_.row(n) = description_.rotations[static_cast<std::size_t>(n)].transpose();
  }
  for (std::size_t c = 0; c < factor_.size(); ++c) {
    Eigen::MatrixXd noisy = gram;
    const double ratio = description_.noise[c] / description_.amplitude[c];
    noisy.diagonal().array() += ratio * ratio;
    factor_[c] = Cholesky(noisy);
    if (!factor_[c].isPositive()) {
      throw ConfigError("orientation_map.noise: it is too small for these readings.");
    }
    const auto column = static_cast<Eigen::Index>(c);
    weights_.col(column) = factor_[c].solve(weights_.col(column));
  }
}

Eigen::VectorXd OrientationMap::kernel(const Eigen::Vector3d& reading) const {
  Eigen::VectorXd values(readings_.cols());
  for (Eigen::Index n = 0; n < readings_.cols(); ++n) {
    values[n] = mapKernel(description_.length, reading, readings_.col(n));
  }
  return values;
}

Eigen::Vector3d OrientationMap::mean(const Eigen::Vector3d& reading) const {
  return shareAt(readings_, reading) * (weights_.transpose() * kernel(reading));
}

OrientationMap::Uncertainty OrientationMap::uncertainty(const Eigen::Vector3d& reading) const {
  const Eigen::VectorXd k = kernel(reading);
  const double share = shareAt(readings_, reading);
  Uncertainty result;
  const double tracker = description_.tracker_noise * description_.tracker_noise;
  double prior = 0.0;
  for (std::size_t c = 0; c < factor_.size(); ++c) {
    const auto component = static_cast<Eigen::Index>(c);
    const double square = description_.amplitude[c] * description_.amplitude[c];
    const double explained = std::clamp(factor_[c].half(k).squaredNorm(), 0.0, 1.0);
    // Of the difference between what is there and a share of what the points say.
    result.variance[component] = square * (1.0 - explained * share * (2.0 - share));
    result.noise[component] = description_.noise[c] * description_.noise[c];
    result.of_rotor[component] =
        result.variance[component] + std::max(0.0, result.noise[component] - tracker);
    prior += square;
  }
  result.support = 1.0 - result.variance.sum() / prior;
  return result;
}

}  // namespace sac
