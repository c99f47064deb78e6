#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <utility>

#include "orientation_hypotheses.hpp"
#include "posterior_fit.hpp"
#include "spherical_actuator_calibration/actuator/spherical_joint.hpp"
#include "spherical_actuator_calibration/base/nearest_rotation.hpp"
#include "spherical_actuator_calibration/base/pi.hpp"
#include "spherical_actuator_calibration/base/rotations.hpp"

namespace sac {
namespace {

/// More than so many orientations tell nothing more to a screening.
constexpr std::size_t kMostScreened = 30;
constexpr std::size_t kMostFitted = 10;

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

/// Moves the start of a turn of readings to where the orientations fit best: Σ tr(R R_measuredᵀ) is
/// a sine of it, which three values tell.
void turnToBest(Hypothesis& hypothesis, const WiringCase& few) {
  const JointGeometry joints = jointGeometry(few.actuator);
  double cosine = 0.0;
  double sine = 0.0;
  for (const double angle : {0.0, 2.0 * kPi / 3.0, 4.0 * kPi / 3.0}) {
    double trace = 0.0;
    const WiringCase turned = corrected(few, {hypothesis}, Eigen::VectorXd::Constant(1, angle));
    for (const Sample& sample : turned.samples) {
      trace +=
          rotorOrientation(joints, sample.joint_position).cwiseProduct(sample.R_stator_rotor).sum();
    }
    cosine += trace * std::cos(angle);
    sine += trace * std::sin(angle);
  }
  hypothesis.start[0] = std::atan2(sine, cosine);
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

/// Two mistakes at once, of which at most the second has continuous values unless both are scales
/// or both are frames.
class PairScreen {
 public:
  PairScreen(const WiringCase& few, const CalibrationConfig& config)
      : few_(few),
        config_(config),
        unchanged_(lossOf(few, {}, config)),
        joints_(jointHypotheses(few.actuator, config.tolerance)),
        tracker_(trackerHypotheses()) {}

  std::vector<ScreenedCandidate> run() {
    addDiscrete();
    keepBest(candidates_, kMostFitted);
    std::vector<ScreenedCandidate> discrete = std::exchange(candidates_, {});
    addContinuous();
    addScales();
    addFrames();
    keepBest(candidates_, kMostFitted);
    for (ScreenedCandidate& candidate : discrete) {
      candidates_.push_back(std::move(candidate));
    }
    return std::move(candidates_);
  }

 private:
  static bool isOf(const Hypothesis& hypothesis, const std::string& kind) {
    return hypothesis.cause.rfind(kind, 0) == 0;
  }

  void add(const Hypothesis& first, const Hypothesis& second) {
    const double gain = unchanged_ - lossOf(few_, {first, second}, config_);
    if (gain > 0.0) {
      candidates_.push_back({{first, second}, gain});
    }
  }

  std::vector<Hypothesis> discreteJoints() const {
    std::vector<Hypothesis> discrete;
    for (const Hypothesis& one : joints_) {
      if (one.start.size() == 0) {
        discrete.push_back(one);
      }
    }
    return discrete;
  }

  void addDiscrete() {
    std::vector<Hypothesis> all = discreteJoints();
    const std::size_t joints = all.size();
    all.insert(all.end(), tracker_.begin(), tracker_.end());
    for (std::size_t a = 0; a < all.size(); ++a) {
      for (std::size_t b = 0; b < all.size(); ++b) {
        const bool is_tracker_first = a >= joints && b < joints;
        if (!is_tracker_first && all[a].cause != all[b].cause) {
          add(all[a], all[b]);
        }
      }
    }
  }

  /// An index mark or a frame that is off beside a discrete mistake, or a second index mark.
  void addContinuous() {
    std::vector<Hypothesis> firsts = discreteJoints();
    for (const Hypothesis& one : tracker_) {
      if (!isOf(one, "tracker_frame") && !isOf(one, "marker_frame")) {
        firsts.push_back(one);
      }
    }
    for (const Hypothesis& first : firsts) {
      const WiringCase mended = corrected(few_, {first}, {});
      for (Hypothesis second : joints_) {
        if (isOf(second, "joint_index")) {
          turnToBest(second, mended);
          add(first, second);
        }
      }
      for (const bool is_tracker : {true, false}) {
        const double tolerance = config_.tolerance.joint_axis;
        Hypothesis second = is_tracker ? trackerRotation(tolerance) : markerRotation(tolerance);
        scanRotation(second, mended, is_tracker, config_);
        add(first, second);
      }
    }
    for (Hypothesis first : joints_) {
      if (!isOf(first, "joint_index")) {
        continue;
      }
      for (const double angle : angleGrid()) {
        first.start[0] = angle;
        addBestIndexAfter(first);
      }
    }
  }

  void addBestIndexAfter(const Hypothesis& first) {
    const WiringCase mended = corrected(few_, {first}, first.start);
    for (Hypothesis second : joints_) {
      if (isOf(second, "joint_index") && second.cause > first.cause) {
        turnToBest(second, mended);
        add(first, second);
      }
    }
  }

  /// Two of three joints in degrees, as where one reads another device than the others.
  void addScales() {
    for (Hypothesis first : joints_) {
      for (Hypothesis second : joints_) {
        if (!isOf(first, "joint_scale") || !isOf(second, "joint_scale") ||
            second.cause <= first.cause) {
          continue;
        }
        for (const double factor : {kOneDegree, 1.0 / kOneDegree}) {
          first.start[0] = factor;
          second.start[0] = factor;
          add(first, second);
        }
      }
    }
  }

  /// Tracker and marker that nobody registered, in closed form (Shah 2013): the rotations A and B
  /// that maximise Σ tr(R(q)ᵀ A R_measured B).
  void addFrames() {
    const JointGeometry joints = jointGeometry(few_.actuator);
    RotationPairSum sum;
    for (const Sample& sample : few_.samples) {
      sum.add(sample.R_stator_rotor, rotorOrientation(joints, sample.joint_position));
    }
    const RotationPair frames = sum.nearest();
    Hypothesis tracker = trackerRotation(config_.tolerance.joint_axis);
    Hypothesis marker = markerRotation(config_.tolerance.joint_axis);
    tracker.start = rotationLog(frames.X);
    marker.start = rotationLog(frames.Z.transpose());
    add(tracker, marker);
  }

  const WiringCase few_;
  const CalibrationConfig& config_;
  const double unchanged_;
  const std::vector<Hypothesis> joints_;
  const std::vector<Hypothesis> tracker_;
  std::vector<ScreenedCandidate> candidates_;
};

}  // namespace

double orientationLoss(const Eigen::Matrix3d& turn,
                       const Eigen::Vector3d& joint_position,
                       double orientation_stddev,
                       const CalibrationConfig& config) {
  const ManufacturingTolerance& tolerance = config.tolerance;
  // An offset turns the rotor by itself, a tangential error δ of an axis by 2 sin(q/2) δ.
  const double sines = 0.5 * (1.0 - joint_position.array().cos()).sum();
  constexpr double kAxes = 8.0 / 3.0;
  const double variance = tolerance.joint_offset * tolerance.joint_offset +
                          kAxes * tolerance.joint_axis * tolerance.joint_axis * sines +
                          orientation_stddev * orientation_stddev +
                          std::pow(ModelAllowance{}.orientation, 2);
  return studentLoss(rotationLog(turn).squaredNorm() / variance);
}

double orientationLoss(const WiringCase& given, const CalibrationConfig& config) {
  const JointGeometry joints = jointGeometry(given.actuator);
  double loss = 0.0;
  for (const Sample& sample : given.samples) {
    if (sample.has_orientation) {
      const Eigen::Matrix3d R = rotorOrientation(joints, sample.joint_position);
      loss += orientationLoss(sample.R_stator_rotor * R.transpose(),
                              sample.joint_position,
                              sample.orientation_stddev,
                              config);
    }
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
  return PairScreen(orientationsOf(described), config).run();
}

}  // namespace sac
