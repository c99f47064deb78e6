#include "spherical_actuator_calibration/calibration/frame_registration.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>
#include <utility>

#include <Eigen/SVD>

#include "frame_fit.hpp"
#include "spherical_actuator_calibration/actuator/spherical_joint.hpp"
#include "spherical_actuator_calibration/base/error.hpp"
#include "spherical_actuator_calibration/base/median.hpp"
#include "spherical_actuator_calibration/base/normal_distribution.hpp"
#include "spherical_actuator_calibration/base/numbering.hpp"
#include "spherical_actuator_calibration/base/pi.hpp"
#include "spherical_actuator_calibration/base/rotations.hpp"
#include "spherical_actuator_calibration/base/symmetric_matrix.hpp"
#include "spherical_actuator_calibration/base/text_format.hpp"
#include "spherical_actuator_calibration/estimation/distributions.hpp"

namespace sac {
namespace {

constexpr double kComponents = 3.0;
constexpr double kUnknownFrames = 6.0;
constexpr double kMilliradian = 1e-3;

/// A joint that was turned by a degree more than another is no better advice [rad].
constexpr double kSlightTurn = 0.02;

/// The axis, in the stator, about which alone the poses are turned against each other, and how far
/// they are turned about others (root mean square) [rad].
struct Spread {
  Eigen::Vector3d axis_stator;
  double across = 0.0;
};

Spread spreadOf(const std::vector<Eigen::Matrix3d>& orientations, const PoseSelection& used) {
  Eigen::Matrix3d mean = Eigen::Matrix3d::Zero();
  double count = 0.0;
  for (std::size_t n = 0; n < orientations.size(); ++n) {
    if (used[n]) {
      mean += orientations[n];
      count += 1.0;
    }
  }
  // A small turn by ρ across an axis shortens its mean to 1 − ρ²/2.
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(mean / count, Eigen::ComputeFullU);
  return {svd.matrixU().col(0), std::sqrt(2.0 * std::max(0.0, 1.0 - svd.singularValues()[0]))};
}

/// The joint to turn further: about an axis across the one of all turns, and little so far.
std::string jointAdvice(const CalibratedDescription& description,
                        const std::vector<TrackedPose>& poses,
                        const Eigen::Vector3d& axis_stator) {
  const JointGeometry joints = jointGeometry(description.actuator);
  const JointLinearization here = linearizeRotorOrientation(joints, poses.front().joint_position);
  std::size_t best = 0;
  double best_worth = -1.0;
  double best_range = 0.0;
  for (std::size_t k = 0; k < kJoints; ++k) {
    const auto at = static_cast<Eigen::Index>(k);
    const auto [low, high] = std::minmax_element(
        poses.begin(), poses.end(), [at](const TrackedPose& a, const TrackedPose& b) {
          return a.joint_position[at] < b.joint_position[at];
        });
    const double range = high->joint_position[at] - low->joint_position[at];
    const double worth = here.d_offset.col(at).cross(axis_stator).norm() / (kSlightTurn + range);
    if (worth > best_worth) {
      best = k;
      best_worth = worth;
      best_range = range;
    }
  }
  return format("turn joint %zu (%s) further: so far it was turned by %.0f degrees",
                numberOf(best),
                description.actuator.joints[best].name.c_str(),
                best_range / kOneDegree);
}

/// A mistake of wiring that would explain poses which fit nothing.
struct Mistake {
  std::string words;
  std::function<void(TrackedPose&)> undo;
};

std::vector<Mistake> mistakes() {
  // Of q = w + x i + y j + z k, the components w, x, y, z in the places of x, y, z, w make r q* k
  // r* with r = (1 + j)/√2: the inverse between two fixed turns, which the frames take up.
  std::vector<Mistake> all = {
      {"the tracker publishes the pose of its base in the marker: invert it; they would fit as "
       "well if it puts w, x, y, z of its quaternion in the places of x, y, z, w: look which it is",
       [](TrackedPose& pose) { pose.R_tracker_marker.transposeInPlace(); }},
      {"the joints are read in degrees: publish radians",
       [](TrackedPose& pose) { pose.joint_position *= kOneDegree; }}};
  // Two reversed joints look like half a turn of both frames, so that one is as good as another.
  all.push_back({"one joint counts the wrong way round",
                 [](TrackedPose& pose) { pose.joint_position[2] *= -1.0; }});
  for (Eigen::Index k = 0; k < 3; ++k) {
    const Eigen::Index next = (k + 1) % 3;
    all.push_back({format("joints %zu and %zu are interchanged",
                          numberOf(static_cast<std::size_t>(k)),
                          numberOf(static_cast<std::size_t>(next))),
                   [k, next](TrackedPose& pose) {
                     std::swap(pose.joint_position[k], pose.joint_position[next]);
                   }});
  }
  return all;
}

/// Registers one set of poses, step by step.
class Registrar {
 public:
  Registrar(const CalibratedDescription& description,
            const std::vector<TrackedPose>& poses,
            const EstimationOptions& options)
      : description_(description),
        poses_(poses),
        options_(options),
        fit_(description, poses, options),
        used_(poses.size(), true) {}

  FrameRegistration run() {
    if (!refuseFew() && !refuseSimilar()) {
      solution_ = bestOf(fit_.start(used_));
      rejectOutliers();
      if (!refuseContradiction() && !refuseSimilar() && !refuseAmbiguous()) {
        conclude();
      }
    }
    return std::move(result_);
  }

 private:
  bool refuse(const std::string& message) {
    result_.message = message;
    return true;
  }

  std::size_t count() const {
    return static_cast<std::size_t>(std::count(used_.begin(), used_.end(), true));
  }

  double degreesOfFreedom() const {
    return kComponents * static_cast<double>(count()) - kUnknownFrames;
  }

  bool refuseFew() {
    const std::size_t different = differentPoses(description_, poses_);
    return different < kLeastRegistrationPoses &&
           refuse(format("There are %zu different poses; at least %zu are needed: let the rotor "
                         "rest in further ones, turned about every joint.",
                         different,
                         kLeastRegistrationPoses));
  }

  bool refuseSimilar() {
    const Spread spread = spreadOf(fit_.orientations(), used_);
    return spread.across < options_.min_joint_motion &&
           refuse(
               format("The poses are turned about one axis alone, by %.1f degrees across it, and "
                      "leave a turn about it open: %s.",
                      spread.across / kOneDegree,
                      jointAdvice(description_, poses_, spread.axis_stator).c_str()));
  }

  /// Solutions that a start by half a turn about each axis of the poses' scatter leads to.
  std::vector<FrameFit::Solution> halfTurns(const Frames& frames) const {
    Eigen::Matrix3d scatter = Eigen::Matrix3d::Zero();
    const Eigen::Matrix3d& first = fit_.orientations().front();
    for (const Eigen::Matrix3d& each : fit_.orientations()) {
      const Eigen::Vector3d turn = rotationLog(each * first.transpose());
      scatter += turn * turn.transpose();
    }
    const Eigen::Matrix3d axes = symmetricEigen(scatter).vectors;
    std::vector<FrameFit::Solution> solutions;
    solutions.reserve(3);
    for (Eigen::Index k = 0; k < 3; ++k) {
      const Frames turned = turnedByHalf(frames, axes.col(k), first);
      solutions.push_back(fit_.solve(turned, used_, noise_scale_));
    }
    return solutions;
  }

  FrameFit::Solution bestOf(const Frames& start) const {
    FrameFit::Solution best = fit_.solve(start, used_, noise_scale_);
    for (FrameFit::Solution& other : halfTurns(start)) {
      if (other.cost < best.cost) {
        best = std::move(other);
      }
    }
    return best;
  }

  /// The worst one at a time, as long as it stands out of the others.
  void rejectOutliers() {
    const auto most = static_cast<std::size_t>(options_.max_rejected_fraction *
                                               static_cast<double>(poses_.size()));
    const double probability =
        options_.false_alarm_probability / static_cast<double>(poses_.size());
    for (std::size_t rejected = 0; rejected < most && count() > kLeastRegistrationPoses;
         ++rejected) {
      const std::vector<double> gain = fit_.judge(solution_, used_, noise_scale_).gain;
      std::vector<double> of_used;
      for (std::size_t n = 0; n < gain.size(); ++n) {
        if (used_[n]) {
          of_used.push_back(gain[n]);
        }
      }
      // Noise that is larger than stated makes no pose an outlier.
      const double scale = std::max(1.0, medianOf(of_used) / kMedianOfChiSquare3);
      const auto worst = std::max_element(gain.begin(), gain.end());
      if (*worst <= scale * chiSquareLimit(kComponents, probability)) {
        return;
      }
      used_[static_cast<std::size_t>(worst - gain.begin())] = false;
      solution_ = fit_.solve(solution_.frames, used_, noise_scale_);
    }
  }

  bool refuseContradiction() {
    result_.reduced_chi_square = solution_.cost / degreesOfFreedom();
    if (result_.reduced_chi_square <= options_.max_reduced_chi_square) {
      return false;
    }
    const std::optional<std::string> mistake = mistakeThatFits();
    return refuse(
        format("The poses contradict the mechanism (reduced chi-square %s, at most %s): ",
               shortNumber(result_.reduced_chi_square).c_str(),
               shortNumber(options_.max_reduced_chi_square).c_str()) +
        (mistake
             ? "they would fit if " + *mistake + "."
             : "check that the marker sits firmly on the rotor, that the rotor rested, that the "
               "tracker is as exact as stated, signs and order of the joints, and the "
               "quaternion's order."));
  }

  std::optional<std::string> mistakeThatFits() const {
    for (const Mistake& mistake : mistakes()) {
      std::vector<TrackedPose> undone = poses_;
      std::for_each(undone.begin(), undone.end(), mistake.undo);
      const FrameFit fit(description_, undone, options_);
      const double cost = fit.solve(fit.start(used_), used_, noise_scale_).cost;
      if (cost / degreesOfFreedom() <= options_.max_reduced_chi_square) {
        return mistake.words;
      }
    }
    return std::nullopt;
  }

  bool refuseAmbiguous() {
    constexpr double kClearlyWorse = 25.0;  // of χ²: five standard deviations
    constexpr double kAnother = 0.5;        // [rad]
    for (const FrameFit::Solution& other : halfTurns(solution_.frames)) {
      const bool is_another = angleBetween(other.frames, solution_.frames) > kAnother;
      if (is_another &&
          other.cost - solution_.cost < kClearlyWorse * std::max(1.0, result_.reduced_chi_square)) {
        return refuse(
            "Two registrations, half a turn apart, fit these poses alike: add poses that are "
            "turned "
            "by less than half a turn, about every joint.");
      }
    }
    return false;
  }

  void conclude() {
    const double limit = chiSquareLimit(degreesOfFreedom(), options_.false_alarm_probability);
    if (solution_.cost > limit) {
      noise_scale_ = std::sqrt(result_.reduced_chi_square);
      solution_ = fit_.solve(solution_.frames, used_, noise_scale_);
      result_.notes.push_back(
          format("The poses scatter %.2f times as much as stated; their noise counts as so much "
                 "larger.",
                 noise_scale_));
    }
    FrameFit::Judgement judgement = fit_.judge(solution_, used_, noise_scale_);
    result_.success = true;
    result_.R_stator_tracker = solution_.frames.R_stator_tracker;
    result_.R_rotor_marker = solution_.frames.R_rotor_marker;
    result_.covariance = judgement.covariance;
    result_.noise_covariance = judgement.noise_covariance;
    result_.poses = std::move(judgement.poses);
    result_.poses_used = count();
    double sum = 0.0;
    for (const RegisteredPose& pose : result_.poses) {
      if (pose.rejected) {
        result_.notes.push_back(
            format("Pose %u contradicts the others by %.1f mrad and was left "
                   "out.",
                   pose.id,
                   pose.residual.norm() / kMilliradian));
      } else {
        sum += pose.residual.squaredNorm();
      }
    }
    result_.residual_rms = std::sqrt(sum / static_cast<double>(count()));
    result_.message = format(
        "Tracker and marker are registered from %zu poses, which fit to %s "
        "mrad.",
        count(),
        shortNumber(result_.residual_rms / kMilliradian).c_str());
  }

  const CalibratedDescription& description_;
  const std::vector<TrackedPose>& poses_;
  const EstimationOptions& options_;
  FrameFit fit_;
  PoseSelection used_;
  FrameFit::Solution solution_;
  double noise_scale_ = 1.0;
  FrameRegistration result_;
};

}  // namespace

std::vector<TrackedPose> trackedPoses(const std::vector<Sample>& samples) {
  std::vector<TrackedPose> poses;
  for (const Sample& sample : samples) {
    if (sample.has_orientation) {
      poses.push_back({sample.id,
                       sample.joint_position,
                       sample.joint_stddev,
                       sample.R_stator_rotor,
                       sample.orientation_stddev});
    }
  }
  return poses;
}

std::size_t differentPoses(const CalibratedDescription& description,
                           const std::vector<TrackedPose>& poses) {
  const JointGeometry joints = jointGeometry(description.actuator);
  std::vector<Eigen::Matrix3d> different;
  for (const TrackedPose& pose : poses) {
    const Eigen::Matrix3d here = rotorOrientation(joints, pose.joint_position);
    const bool is_known =
        std::any_of(different.begin(), different.end(), [&](const Eigen::Matrix3d& other) {
          return rotationLog(here * other.transpose()).norm() <= kSamePose;
        });
    if (!is_known) {
      different.push_back(here);
    }
  }
  return different.size();
}

void requireJoints(const CalibratedDescription& description) {
  if (!description.actuator.has_joints) {
    throw ConfigError(
        "joints: the description has none, and only their readings can tell where "
        "tracker and marker are; state both registrations.");
  }
}

FrameRegistration registerFrames(const CalibratedDescription& description,
                                 const std::vector<TrackedPose>& poses,
                                 const EstimationOptions& options) {
  validate(options);
  validate(options.tolerance);
  requireJoints(description);
  return Registrar(description, poses, options).run();
}

}  // namespace sac
