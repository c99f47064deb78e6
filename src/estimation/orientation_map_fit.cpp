#include "spherical_actuator_calibration/estimation/orientation_map_fit.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <numeric>

#include "spherical_actuator_calibration/base/symmetric_matrix.hpp"

namespace sac {
namespace {

constexpr double kUsualLength = 0.5;        // [rad]
constexpr double kLengthSpread = 1.0;       // standard deviation of the logarithm of a length
constexpr double kShortest = 0.05;          // [rad]
constexpr double kLongest = 10.0;           // [rad]
constexpr double kLeastMotion = 0.05;       // [rad] of a joint whose length can be told
constexpr std::size_t kMostSearched = 150;  ///< poses that tell lengths: a step costs their cube
constexpr double kSmallestSquare = 1e-18;   // [rad²] of rotations without any error

/// Amplitude and noise of one component at given lengths.
struct ComponentFit {
  double cost = 0.0;  ///< negative log likelihood, but for a constant [nats]
  double amplitude = 0.0;
  double noise = 0.0;
};

/// Minimum of a function of one variable on [low, high]: a grid, then golden sections.
double minimumOf(const std::function<double(double)>& cost, double low, double high) {
  constexpr int kSteps = 32;
  constexpr int kSections = 30;
  constexpr double kGolden = 0.6180339887498949;
  const double step = (high - low) / kSteps;
  double best = low;
  for (int n = 1; n <= kSteps; ++n) {
    const double at = low + n * step;
    best = cost(at) < cost(best) ? at : best;
  }
  double a = std::max(low, best - step);
  double b = std::min(high, best + step);
  for (int n = 0; n < kSections; ++n) {
    const double c = b - kGolden * (b - a);
    const double d = a + kGolden * (b - a);
    (cost(c) < cost(d) ? b : a) = cost(c) < cost(d) ? d : c;
  }
  return 0.5 * (a + b);
}

/// With K = U S Uᵀ and z = Uᵀy, the covariance of z is amplitude² (S + λ), λ = noise²/amplitude²;
/// the best amplitude has a closed form, and λ is searched.
ComponentFit fitComponent(const Eigen::VectorXd& spectrum, const Eigen::VectorXd& z) {
  constexpr double kLogRange = 10.0;
  const auto count = static_cast<double>(z.size());
  const auto square = [&](double lambda) {
    return (z.array().square() / (spectrum.array() + lambda)).mean() + kSmallestSquare;
  };
  const auto cost = [&](double log_lambda) {
    const double lambda = std::exp(log_lambda);
    return 0.5 * (count * std::log(square(lambda)) + (spectrum.array() + lambda).log().sum());
  };
  const double log_lambda = minimumOf(cost, -kLogRange, kLogRange);
  ComponentFit fit;
  fit.cost = cost(log_lambda);
  fit.amplitude = std::sqrt(square(std::exp(log_lambda)));
  fit.noise = fit.amplitude * std::exp(0.5 * log_lambda);
  return fit;
}

/// The negative log posterior of lengths, with all else at its best.
class MapLikelihood {
 public:
  explicit MapLikelihood(const UnexplainedRotations& poses) : poses_(poses) {
    const auto count = static_cast<Eigen::Index>(poses.rotations.size());
    rotations_.resize(count, 3);
    for (Eigen::Index n = 0; n < count; ++n) {
      rotations_.row(n) = poses.rotations[static_cast<std::size_t>(n)].transpose();
    }
    for (Eigen::Index k = 0; k < 3; ++k) {
      double motion = 0.0;
      for (const Eigen::Vector3d& reading : poses.readings) {
        motion = std::max(motion,
                          2.0 * std::abs(std::sin(0.5 * (reading[k] - poses.readings.front()[k]))));
      }
      if (motion > kLeastMotion) {
        moved_.push_back(static_cast<std::size_t>(k));
      }
    }
  }

  /// Joints whose lengths are searched.
  const std::vector<std::size_t>& moved() const { return moved_; }

  double operator()(const std::array<double, 3>& length,
                    OrientationMapDescription* map = nullptr) const {
    const auto count = rotations_.rows();
    Eigen::MatrixXd gram(count, count);
    for (Eigen::Index a = 0; a < count; ++a) {
      for (Eigen::Index b = 0; b <= a; ++b) {
        gram(a, b) = mapKernel(length,
                               poses_.readings[static_cast<std::size_t>(a)],
                               poses_.readings[static_cast<std::size_t>(b)]);
      }
    }
    const SymmetricEigen eigen = symmetricEigen(gram);
    const Eigen::VectorXd spectrum = eigen.values.cwiseMax(0.0);
    double cost = 0.0;
    for (const std::size_t k : moved_) {
      cost += 0.5 * std::pow(std::log(length[k] / kUsualLength) / kLengthSpread, 2);
    }
    for (std::size_t c = 0; c < 3; ++c) {
      const ComponentFit fit = fitComponent(
          spectrum, eigen.vectors.transpose() * rotations_.col(static_cast<Eigen::Index>(c)));
      cost += fit.cost;
      if (map != nullptr) {
        map->amplitude[c] = fit.amplitude;
        map->noise[c] = fit.noise;
      }
    }
    return cost;
  }

  /// The same of white noise alone.
  double ofNoise() const {
    const auto count = static_cast<double>(rotations_.rows());
    double cost = 0.0;
    for (Eigen::Index c = 0; c < 3; ++c) {
      cost += 0.5 * count * std::log(rotations_.col(c).squaredNorm() / count + kSmallestSquare);
    }
    return cost;
  }

 private:
  const UnexplainedRotations& poses_;
  Eigen::MatrixX3d rotations_;
  std::vector<std::size_t> moved_;
};

/// Lengths by their logarithms, those of joints that move.
class LengthSearch {
 public:
  explicit LengthSearch(const MapLikelihood& likelihood) : likelihood_(likelihood) {}

  /// Compass search: along each length in turn, with steps that halve where nothing is gained.
  std::array<double, 3> search(std::array<double, 3> length, double step, double smallest_step) {
    double cost = likelihood_(length);
    while (step > smallest_step && !likelihood_.moved().empty()) {
      bool has_gained = false;
      for (const std::size_t k : likelihood_.moved()) {
        for (const double factor : {std::exp(step), std::exp(-step)}) {
          std::array<double, 3> tried = length;
          tried[k] = std::clamp(factor * length[k], kShortest, kLongest);
          const double there = likelihood_(tried);
          if (there < cost) {
            cost = there;
            length = tried;
            has_gained = true;
            break;
          }
        }
      }
      step = has_gained ? step : 0.5 * step;
    }
    return length;
  }

  /// The best of some lengths that are the same for all joints that move.
  std::array<double, 3> best() const {
    std::array<double, 3> best = {kUsualLength, kUsualLength, kUsualLength};
    double least = likelihood_(best);
    for (const double length : {0.2, 1.0, 2.0}) {
      std::array<double, 3> tried = best;
      for (const std::size_t k : likelihood_.moved()) {
        tried[k] = length;
      }
      const double cost = likelihood_(tried);
      if (cost < least) {
        least = cost;
        best = tried;
      }
    }
    return best;
  }

 private:
  const MapLikelihood& likelihood_;
};

/// At most so many, evenly chosen among the poses.
UnexplainedRotations chosenPoses(const UnexplainedRotations& poses, std::size_t most) {
  const std::size_t count = poses.readings.size();
  if (count <= most) {
    return poses;
  }
  UnexplainedRotations points;
  for (std::size_t n = 0; n < most; ++n) {
    const std::size_t from = n * count / most;
    points.readings.push_back(poses.readings[from]);
    points.rotations.push_back(poses.rotations[from]);
  }
  return points;
}

/// The stated noise of the tracker, root mean square, or 0 where the poses differ by less than it
/// says: what it is then nobody knows.
double believedTrackerNoise(const std::vector<double>& variances,
                            const std::array<double, 3>& noise) {
  constexpr double kContradicted = 0.7;  // of the stated one: two standard deviations of 30 poses
  if (variances.empty()) {
    return 0.0;
  }
  const double stated = std::sqrt(std::accumulate(variances.begin(), variances.end(), 0.0) /
                                  static_cast<double>(variances.size()));
  const double found = Eigen::Vector3d(noise[0], noise[1], noise[2]).norm() / std::sqrt(3.0);
  return found < kContradicted * stated ? 0.0 : stated;
}

}  // namespace

UnexplainedRotations mergedPoses(const UnexplainedRotations& all) {
  constexpr double kSamePose = 1e-3;  // [rad]
  UnexplainedRotations merged;
  const bool has_variances = !all.tracker_variances.empty();
  std::vector<double> counts;
  for (std::size_t n = 0; n < all.readings.size(); ++n) {
    const auto found = std::find_if(
        merged.readings.begin(), merged.readings.end(), [&](const Eigen::Vector3d& reading) {
          return (reading - all.readings[n]).cwiseAbs().maxCoeff() < kSamePose;
        });
    if (found == merged.readings.end()) {
      merged.readings.push_back(all.readings[n]);
      merged.rotations.push_back(all.rotations[n]);
      counts.push_back(1.0);
      if (has_variances) {
        merged.tracker_variances.push_back(all.tracker_variances[n]);
      }
      continue;
    }
    const auto place = static_cast<std::size_t>(found - merged.readings.begin());
    counts[place] += 1.0;
    merged.rotations[place] += (all.rotations[n] - merged.rotations[place]) / counts[place];
    if (has_variances) {
      merged.tracker_variances[place] += all.tracker_variances[n];
    }
  }
  for (std::size_t n = 0; n < merged.tracker_variances.size(); ++n) {
    merged.tracker_variances[n] /= counts[n] * counts[n];  // of a mean: Σσ²/n²
  }
  return merged;
}

OrientationMapFit fitOrientationMap(const UnexplainedRotations& poses,
                                    const OrientationMapDescription* start) {
  constexpr double kFirstStep = 0.4;  // of the logarithm of a length
  constexpr double kLastStep = 0.04;
  constexpr double kShortStep = 0.2;
  const UnexplainedRotations points = chosenPoses(poses, kMostMapPoints);
  const UnexplainedRotations searched = chosenPoses(poses, kMostSearched);
  const MapLikelihood likelihood(searched);
  LengthSearch lengths(likelihood);
  OrientationMapFit fit;
  fit.map.length = start != nullptr ? lengths.search(start->length, kShortStep, kShortStep / 2.0)
                                    : lengths.search(lengths.best(), kFirstStep, kLastStep);
  fit.gain = likelihood.ofNoise() - likelihood(fit.map.length, &fit.map);
  fit.map.readings = points.readings;
  fit.map.rotations = points.rotations;
  fit.map.tracker_noise = believedTrackerNoise(poses.tracker_variances, fit.map.noise);
  return fit;
}

}  // namespace sac
