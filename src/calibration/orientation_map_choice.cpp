#include "spherical_actuator_calibration/calibration/orientation_map_choice.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>

#include "spherical_actuator_calibration/base/median.hpp"
#include "spherical_actuator_calibration/base/normal_distribution.hpp"
#include "spherical_actuator_calibration/base/rotations.hpp"
#include "spherical_actuator_calibration/base/text_format.hpp"
#include "spherical_actuator_calibration/calibration/calibration_cycles.hpp"
#include "spherical_actuator_calibration/estimation/model_point.hpp"
#include "spherical_actuator_calibration/estimation/orientation_map_fit.hpp"

namespace sac {
namespace {

constexpr std::size_t kFewestPoses = 30;
constexpr int kRegionDepth = 3;
constexpr double kLeastGain = 10.0;         // [nats] for three amplitudes, noises and lengths
constexpr double kLargestShare = 0.9;       // of the error without the map
constexpr double kLeastSignificance = 2.0;  // standard deviations of the mean gain of a region
constexpr double kMilliradian = 1e3;
/// Of the stated noise, by which axes and corrections are fitted: a bend far beyond it is no reason
/// to look for no map.
constexpr double kNoiseFactors[] = {1.0, 5.0, 25.0};
/// Rotation beyond which no machine bends, root mean square [rad].
constexpr double kLargestBend = 5e-3;

/// Standard deviation of each component by the tracker, as stated [rad].
double statedStddev(const Sample& sample, const EstimationOptions& options) {
  return sample.orientation_stddev > 0.0 ? sample.orientation_stddev
                                         : options.default_orientation_stddev;
}

/// A sample whose orientation serves.
bool serves(const Sample& sample) {
  return sample.has_orientation && !sample.validation;
}

/// Without what lies far beyond most: a measurement, or a sample that the estimate has rejected.
UnexplainedRotations withoutOutliers(const UnexplainedRotations& all) {
  constexpr double kFar = 6.0;  // medians
  std::vector<double> sizes;
  for (const Eigen::Vector3d& rotation : all.rotations) {
    sizes.push_back(rotation.norm());
  }
  if (sizes.empty()) {
    return all;
  }
  const double median = medianOf(sizes);
  UnexplainedRotations kept;
  for (std::size_t n = 0; n < sizes.size(); ++n) {
    if (sizes[n] <= kFar * median) {
      kept.readings.push_back(all.readings[n]);
      kept.rotations.push_back(all.rotations[n]);
      kept.tracker_variances.push_back(all.tracker_variances[n]);
    }
  }
  return kept;
}

/// What a state leaves of the orientations of samples, their nominal map counted in.
UnexplainedRotations unexplained(const CalibrationModel& model,
                                 const std::vector<Sample>& samples,
                                 const Eigen::VectorXd& x,
                                 const EstimationOptions& options) {
  const std::shared_ptr<const OrientationMap>& nominal = model.space().nominal().orientation_map;
  const ModelPoint point(model, x);
  UnexplainedRotations result;
  for (const Sample& sample : samples) {
    if (!serves(sample)) {
      continue;
    }
    Eigen::Vector3d rotation = point.orientationResidual(sample);
    if (nominal) {
      rotation =
          rotationLog(rotationExp(rotation) * rotationExp(nominal->mean(sample.joint_position)));
    }
    result.readings.push_back(sample.joint_position);
    result.rotations.push_back(rotation);
    result.tracker_variances.push_back(std::pow(statedStddev(sample, options), 2));
  }
  return withoutOutliers(result);
}

/// Sums over poses that were predicted from those of other regions.
struct HeldOutErrors {
  std::size_t poses = 0;
  std::size_t inside = 0;  ///< components within their intervals
  double axes = 0.0;       ///< Σ‖rotation error‖² [rad²]
  double map = 0.0;
};

/// What orientations tell by themselves. `samples`: without torques.
CycleOutcome fromOrientations(const CalibrationModel& model,
                              const std::vector<Sample>& samples,
                              const CalibrationState& state,
                              const EstimationOptions& options) {
  return runCycle(model, samples, state, withoutExpectedErrors({Cycle::kRefine}), options);
}

std::vector<Sample> orientationsOf(const std::vector<Sample>& samples) {
  std::vector<Sample> oriented;
  for (const Sample& sample : samples) {
    if (serves(sample)) {
      oriented.push_back(sample);
      oriented.back().has_torque = false;
    }
  }
  return oriented;
}

std::vector<Sample> noisier(std::vector<Sample> samples,
                            double factor,
                            const EstimationOptions& options) {
  for (Sample& sample : samples) {
    sample.orientation_stddev = factor * statedStddev(sample, options);
  }
  return samples;
}

double rmsOf(const std::vector<Eigen::Vector3d>& rotations) {
  double sum = 0.0;
  for (const Eigen::Vector3d& rotation : rotations) {
    sum += rotation.squaredNorm();
  }
  return std::sqrt(sum / static_cast<double>(std::max<std::size_t>(rotations.size(), 1)));
}

/// Predicts regions from the samples of all others.
class RegionJudge {
 public:
  RegionJudge(const CalibrationModel& model,
              const std::vector<Sample>& samples,
              const CalibrationState& state,
              const EstimationOptions& options)
      : model_(model), samples_(samples), state_(state), options_(options) {
    std::vector<Eigen::Vector3d> readings;
    for (std::size_t n = 0; n < samples.size(); ++n) {
      if (!samples[n].validation) {
        places_.push_back(n);
        readings.push_back(samples[n].joint_position);
      }
    }
    regions_ = regionsOf(readings, kRegionDepth);
  }

  /// One per region whose others suffice for an estimate.
  std::vector<HeldOutErrors> judge(const OrientationMapDescription& start) const {
    std::vector<HeldOutErrors> errors;
    for (std::size_t region = 0; region < (std::size_t{1} << kRegionDepth); ++region) {
      std::vector<Sample> others = samples_;
      std::vector<Sample> held;
      for (std::size_t n = 0; n < places_.size(); ++n) {
        if (regions_[n] == region) {
          others[places_[n]].validation = true;
          held.push_back(samples_[places_[n]]);
        }
      }
      const CycleOutcome outcome = fromOrientations(model_, others, state_, options_);
      const UnexplainedRotations known =
          mergedPoses(unexplained(model_, others, outcome.state.belief.x, options_));
      const UnexplainedRotations tested =
          mergedPoses(unexplained(model_, held, outcome.state.belief.x, options_));
      if (outcome.report.success && !known.readings.empty() && !tested.readings.empty()) {
        errors.push_back(errorsOf(OrientationMap(fitOrientationMap(known, &start).map), tested));
      }
    }
    return errors;
  }

 private:
  static HeldOutErrors errorsOf(const OrientationMap& map, const UnexplainedRotations& tested) {
    HeldOutErrors errors;
    for (std::size_t n = 0; n < tested.readings.size(); ++n) {
      const Eigen::Vector3d& rotation = tested.rotations[n];
      const Eigen::Vector3d left = rotation - map.mean(tested.readings[n]);
      const OrientationMap::Uncertainty uncertainty = map.uncertainty(tested.readings[n]);
      const double stddev = std::sqrt((uncertainty.variance + uncertainty.noise).mean());
      errors.axes += rotation.squaredNorm();
      errors.map += left.squaredNorm();
      errors.inside +=
          static_cast<std::size_t>((left.array().abs() < kTwoSided95 * stddev).count());
      ++errors.poses;
    }
    return errors;
  }

  const CalibrationModel& model_;
  const std::vector<Sample>& samples_;  ///< without torques
  const CalibrationState& state_;
  const EstimationOptions& options_;
  std::vector<std::size_t> places_;   ///< of samples that serve
  std::vector<std::size_t> regions_;  ///< of each of them
};

MapRecord recordOf(const std::vector<HeldOutErrors>& regions) {
  HeldOutErrors sum;
  for (const HeldOutErrors& region : regions) {
    sum.poses += region.poses;
    sum.inside += region.inside;
    sum.axes += region.axes;
    sum.map += region.map;
  }
  const auto poses = static_cast<double>(std::max<std::size_t>(sum.poses, 1));
  constexpr double kComponents = 3.0;
  return {static_cast<std::uint32_t>(regions.size()),
          std::sqrt(sum.axes / poses),
          std::sqrt(sum.map / poses),
          static_cast<double>(sum.inside) / (kComponents * poses)};
}

/// Mean gain of the regions over its standard deviation.
double significance(const std::vector<HeldOutErrors>& regions) {
  const auto count = static_cast<double>(regions.size());
  double mean = 0.0;
  for (const HeldOutErrors& region : regions) {
    mean += (region.axes - region.map) / count;
  }
  double variance = 0.0;
  for (const HeldOutErrors& region : regions) {
    variance += std::pow(region.axes - region.map - mean, 2) / (count * (count - 1.0));
  }
  return mean / std::sqrt(std::max(variance, 1e-300));
}

std::string tooFew(std::size_t poses) {
  return format("Orientation map: none; %zu poses with an orientation are too few, %zu are needed.",
                poses,
                kFewestPoses);
}

std::string inWords(const MapRecord& record, bool is_chosen) {
  return format(
      "Orientation map%s: %u regions, each predicted from the others, are met to %.3g mrad rms "
      "with it and to %.3g mrad by axes and corrections alone; %.0f %% within the 95 %% intervals.",
      is_chosen ? "" : " (not taken)",
      static_cast<unsigned>(record.regions),
      kMilliradian * record.map_rms,
      kMilliradian * record.axes_rms,
      100.0 * record.inside);
}

}  // namespace

std::vector<std::size_t> regionsOf(const std::vector<Eigen::Vector3d>& readings, int depth) {
  Eigen::Array3d low = Eigen::Array3d::Constant(1e300);
  Eigen::Array3d high = -low;
  for (const Eigen::Vector3d& reading : readings) {
    low = low.min(reading.array());
    high = high.max(reading.array());
  }
  const Eigen::Array3d widths = (high - low).max(1e-6);
  std::vector<std::size_t> order(readings.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::vector<std::size_t> regions(readings.size(), 0);
  using Place = std::vector<std::size_t>::iterator;
  const std::function<void(Place, Place, int)> split = [&](Place begin, Place end, int left) {
    if (left == 0 || end - begin < 2) {
      return;
    }
    Eigen::Array3d from = Eigen::Array3d::Constant(1e300);
    Eigen::Array3d to = -from;
    for (auto n = begin; n != end; ++n) {
      from = from.min(readings[*n].array());
      to = to.max(readings[*n].array());
    }
    Eigen::Index joint = 0;
    ((to - from) / widths).maxCoeff(&joint);
    std::stable_sort(begin, end, [&](std::size_t a, std::size_t b) {
      return readings[a][joint] < readings[b][joint];
    });
    const Place middle = begin + (end - begin) / 2;
    for (auto n = middle; n != end; ++n) {
      regions[*n] += std::size_t{1} << static_cast<unsigned>(left - 1);
    }
    split(begin, middle, left - 1);
    split(middle, end, left - 1);
  };
  split(order.begin(), order.end(), depth);
  return regions;
}

OrientationMapChoice chooseOrientationMap(const CalibrationModel& model,
                                          const std::vector<Sample>& samples,
                                          const CalibrationState& start,
                                          const EstimationOptions& options,
                                          MapUse use) {
  OrientationMapChoice choice;
  if (use == MapUse::kNever || model.space().joints() == 0) {
    return choice;
  }
  const std::vector<Sample> oriented = orientationsOf(samples);
  if (oriented.empty()) {
    return choice;
  }
  if (oriented.size() < kFewestPoses) {
    choice.sentence = tooFew(oriented.size());
    return choice;
  }
  std::vector<Sample> fitted;
  CycleOutcome outcome;
  for (const double factor : kNoiseFactors) {
    fitted = noisier(oriented, factor, options);
    outcome = fromOrientations(model, fitted, start, options);
    if (outcome.report.success) {
      break;
    }
  }
  if (!outcome.report.success) {
    return choice;
  }
  const UnexplainedRotations poses =
      mergedPoses(unexplained(model, oriented, outcome.state.belief.x, options));
  if (rmsOf(poses.rotations) > kLargestBend) {
    return choice;
  }
  if (poses.readings.size() < kFewestPoses) {
    choice.sentence = tooFew(poses.readings.size());
    return choice;
  }
  const OrientationMapFit fit = fitOrientationMap(poses);
  if (use == MapUse::kAuto && fit.gain < kLeastGain) {
    choice.sentence =
        "Orientation map: none; what axes and corrections leave of the orientations is not smooth "
        "over the joint angles.";
    return choice;
  }
  const std::vector<HeldOutErrors> regions =
      RegionJudge(model, fitted, start, options).judge(fit.map);
  const MapRecord record = recordOf(regions);
  const bool is_better = regions.size() > 2 && record.map_rms < kLargestShare * record.axes_rms &&
                         significance(regions) > kLeastSignificance;
  choice.record = record;
  if (is_better || use == MapUse::kAlways) {
    choice.map = std::make_shared<OrientationMap>(fit.map);
  }
  choice.sentence = inWords(record, choice.map != nullptr);
  return choice;
}

}  // namespace sac
