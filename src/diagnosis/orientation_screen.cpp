#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "orientation_hypotheses.hpp"
#include "posterior_fit.hpp"
#include "spherical_actuator_calibration/actuator/spherical_joint.hpp"
#include "spherical_actuator_calibration/base/pi.hpp"
#include "spherical_actuator_calibration/base/rotations.hpp"

namespace sac {
namespace {

/// More than so many orientations tell nothing more to a screening.
constexpr std::size_t kMostScreened = 30;
constexpr std::size_t kMostFitted = 10;
constexpr std::size_t kMostShifts = 3;

/// Evenly chosen orientations, without torques.
WiringCase orientationsOf(const WiringCase& described) {
  WiringCase few;
  few.actuator = described.actuator;
  std::vector<std::size_t> places;
  for (std::size_t n = 0; n < described.samples.size(); ++n) {
    if (described.samples[n].has_orientation) {
      places.push_back(n);
    }
  }
  const std::size_t step = std::max<std::size_t>(1, places.size() / kMostScreened);
  for (std::size_t n = 0; n < places.size(); n += step) {
    Sample sample = described.samples[places[n]];
    sample.has_torque = false;
    sample.current.resize(0);
    few.samples.push_back(sample);
  }
  return few;
}

double lossOf(const WiringCase& few, const Candidate& candidate, const CalibrationConfig& config) {
  return orientationLoss(corrected(few, candidate, startOf(candidate)), config);
}

/// Moves the start of a single continuous value to the best of a grid.
void scan(Hypothesis& hypothesis,
          const std::vector<double>& grid,
          const WiringCase& few,
          const CalibrationConfig& config) {
  double best = lossOf(few, {hypothesis}, config);
  const Hypothesis original = hypothesis;
  for (const double value : grid) {
    Hypothesis trial = original;
    trial.start[0] = value;
    const double loss = lossOf(few, {trial}, config);
    if (loss < best) {
      best = loss;
      hypothesis = trial;
    }
  }
}

std::vector<double> scaleGrid() {
  std::vector<double> grid = {0.01, kOneDegree, 1.0 / kOneDegree, 10.0, 100.0};
  constexpr double kStep = 0.04;
  for (double scale = -2.5; scale < 4.5; scale += kStep) {
    grid.push_back(scale);
  }
  return grid;
}

std::vector<double> angleGrid() {
  constexpr int kSteps = 36;
  std::vector<double> grid;
  grid.reserve(kSteps);
  for (int n = 0; n < kSteps; ++n) {
    grid.push_back(2.0 * kPi * n / kSteps - kPi);
  }
  return grid;
}

/// Moves the start of a rotation to the best of those that single orientations ask for.
void scanRotation(Hypothesis& hypothesis,
                  const WiringCase& few,
                  bool is_tracker,
                  const CalibrationConfig& config) {
  const JointGeometry joints = jointGeometry(few.actuator);
  double best = lossOf(few, {hypothesis}, config);
  const Hypothesis original = hypothesis;
  for (const Sample& sample : few.samples) {
    const Eigen::Matrix3d R = rotorOrientation(joints, sample.joint_position);
    const Eigen::Matrix3d& measured = sample.R_stator_rotor;
    Hypothesis trial = original;
    const Eigen::Matrix3d correction = is_tracker ? Eigen::Matrix3d(R * measured.transpose())
                                                  : Eigen::Matrix3d(measured.transpose() * R);
    trial.start = rotationLog(correction);
    const double loss = lossOf(few, {trial}, config);
    if (loss < best) {
      best = loss;
      hypothesis = trial;
    }
  }
}

std::vector<Hypothesis> singles(const WiringCase& few, const CalibrationConfig& config) {
  std::vector<Hypothesis> all = jointHypotheses(few.actuator, config.tolerance);
  for (Hypothesis& hypothesis : all) {
    if (hypothesis.cause.rfind("joint_scale", 0) == 0) {
      scan(hypothesis, scaleGrid(), few, config);
    } else if (hypothesis.cause.rfind("joint_index", 0) == 0) {
      scan(hypothesis, angleGrid(), few, config);
    }
  }
  for (Hypothesis& hypothesis : trackerHypotheses()) {
    all.push_back(std::move(hypothesis));
  }
  for (Hypothesis& hypothesis : shiftHypotheses(Quantity::kOrientation)) {
    all.push_back(std::move(hypothesis));
  }
  all.push_back(trackerRotation(config.tolerance.joint_axis));
  scanRotation(all.back(), few, true, config);
  all.push_back(markerRotation(config.tolerance.joint_axis));
  scanRotation(all.back(), few, false, config);
  return all;
}

}  // namespace

double orientationLoss(const WiringCase& given, const CalibrationConfig& config) {
  const JointGeometry joints = jointGeometry(given.actuator);
  const ManufacturingTolerance& tolerance = config.tolerance;
  double loss = 0.0;
  for (const Sample& sample : given.samples) {
    if (!sample.has_orientation) {
      continue;
    }
    const Eigen::Matrix3d R = rotorOrientation(joints, sample.joint_position);
    // An offset turns the rotor by itself, a tangential error δ of an axis by 2 sin(q/2) δ.
    const double sines = (0.5 * sample.joint_position).array().sin().square().sum();
    const double variance = std::pow(tolerance.joint_offset, 2) +
                            8.0 / 3.0 * std::pow(tolerance.joint_axis, 2) * sines +
                            std::pow(sample.orientation_stddev, 2) +
                            std::pow(ModelAllowance{}.orientation, 2);
    loss +=
        studentLoss(rotationLog(sample.R_stator_rotor * R.transpose()).squaredNorm() / variance);
  }
  return loss;
}

std::vector<ScreenedCandidate> screenOrientations(const WiringCase& described,
                                                  const CalibrationConfig& config) {
  const WiringCase few = orientationsOf(described);
  const double unchanged = lossOf(few, {}, config);
  std::vector<ScreenedCandidate> candidates;
  std::vector<ScreenedCandidate> shifts;  // by all orientations: they must not crowd others out
  for (const Hypothesis& hypothesis : singles(few, config)) {
    const bool is_shift = hypothesis.cause == "rows_shifted";
    const double gain = is_shift
                            ? orientationLoss(described, config) -
                                  orientationLoss(corrected(described, {hypothesis}, {}), config)
                            : unchanged - lossOf(few, {hypothesis}, config);
    if (gain > 0.0) {
      (is_shift ? shifts : candidates).push_back({{hypothesis}, gain});
    }
  }
  keepBest(shifts, kMostShifts);
  for (ScreenedCandidate& shift : shifts) {
    candidates.push_back(std::move(shift));
  }
  keepBest(candidates, kMostFitted);
  return candidates;
}

std::vector<ScreenedCandidate> screenOrientationPairs(const WiringCase& described,
                                                      const CalibrationConfig& config) {
  const WiringCase few = orientationsOf(described);
  const double unchanged = lossOf(few, {}, config);
  std::vector<Hypothesis> joints;
  for (const Hypothesis& hypothesis : jointHypotheses(described.actuator, config.tolerance)) {
    if (hypothesis.start.size() == 0) {
      joints.push_back(hypothesis);
    }
  }
  const std::vector<Hypothesis> tracker = trackerHypotheses();
  std::vector<ScreenedCandidate> candidates;
  const auto add = [&](const Hypothesis& first, const Hypothesis& second) {
    const double gain = unchanged - lossOf(few, {first, second}, config);
    if (gain > 0.0) {
      candidates.push_back({{first, second}, gain});
    }
  };
  for (const Hypothesis& first : joints) {
    for (const Hypothesis& second : joints) {
      if (first.cause != second.cause) {
        add(first, second);
      }
    }
    for (const Hypothesis& second : tracker) {
      add(first, second);
    }
  }
  for (const Hypothesis& first : tracker) {
    for (const Hypothesis& second : tracker) {
      if (first.cause != second.cause) {
        add(first, second);
      }
    }
  }
  keepBest(candidates, kMostFitted);
  return candidates;
}

}  // namespace sac
