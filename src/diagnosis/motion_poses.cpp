#include "motion_poses.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>
#include <utility>

#include <Eigen/Geometry>

#include "orientation_hypotheses.hpp"
#include "spherical_actuator_calibration/measurement/stamp_interval.hpp"

namespace sac {
namespace {

constexpr std::size_t kMost = 120;

/// The reading nearest to a stamp. Precondition: there is one.
std::size_t nearest(const LongSeries<Stamp>& stamps, Stamp stamp) {
  const auto after = std::lower_bound(stamps.begin(), stamps.end(), stamp);
  const auto place = static_cast<std::size_t>(after - stamps.begin());
  if (after == stamps.end()) {
    return place - 1;
  }
  const bool is_before = place > 0 && stamp - stamps[place - 1] < *after - stamp;
  return is_before ? place - 1 : place;
}

/// Speed of the rotor around an orientation [rad/s].
double speedAt(const MotionStreams& streams, std::size_t place) {
  constexpr std::size_t kReach = 5;
  const std::size_t from = place - std::min(place, kReach);
  const std::size_t to = std::min(place + kReach, streams.orientations.size() - 1);
  const double seconds =
      secondsBetween(streams.orientation_stamps[from], streams.orientation_stamps[to]);
  return seconds > 0.0
             ? streams.orientations[from].angularDistance(streams.orientations[to]) / seconds
             : 0.0;
}

/// Nothing without a reading near it.
std::optional<Sample> poseAt(const MotionStreams& streams, std::size_t place, double delay) {
  constexpr double kNear = 0.02;         // [s]
  constexpr double kDelayStddev = 0.01;  // [s]
  constexpr double kLeast = 5e-3;        // [rad]
  const Stamp stamp = streams.orientation_stamps[place] - ticksFromSeconds(delay);
  const std::size_t reading = nearest(streams.joint_stamps, stamp);
  if (std::abs(secondsBetween(stamp, streams.joint_stamps[reading])) > kNear) {
    return std::nullopt;
  }
  Sample pose;
  pose.joint_position = streams.joints[reading];
  pose.has_orientation = true;
  pose.R_stator_rotor = streams.orientations[place].toRotationMatrix();
  pose.orientation_stddev = kLeast + kDelayStddev * speedAt(streams, place);
  return pose;
}

}  // namespace

std::vector<Sample> posesOfMotion(const MotionRecording& recording, double delay) {
  std::size_t all = 0;
  for (const MotionStreams& streams : recording.spans) {
    all += streams.joints.empty() ? 0 : streams.orientations.size();
  }
  const std::size_t step = std::max<std::size_t>(1, (all + kMost - 1) / kMost);
  std::vector<Sample> poses;
  std::size_t count = 0;
  for (const MotionStreams& streams : recording.spans) {
    for (std::size_t n = 0; n < streams.orientations.size() && !streams.joints.empty(); ++n) {
      if (count++ % step != 0) {
        continue;
      }
      if (const std::optional<Sample> pose = poseAt(streams, n, delay)) {
        poses.push_back(*pose);
      }
    }
  }
  return poses;
}

WiringDiagnosis diagnosePosesOfMotion(const Actuator& nominal,
                                      const MotionRecording& recording,
                                      const CalibrationConfig& config) {
  constexpr double kDelays[] = {0.0, 0.015, 0.03, 0.045, 0.06};  // [s]
  WiringDiagnosis best;
  double least = std::numeric_limits<double>::infinity();
  for (const double delay : kDelays) {
    WiringDiagnosis diagnosis = diagnoseWiring(nominal, posesOfMotion(recording, delay), config);
    const double loss = orientationLoss({diagnosis.actuator, diagnosis.samples}, config);
    if (loss < least) {
      least = loss;
      best = std::move(diagnosis);
    }
  }
  // Of streams it is a delay beyond these.
  const bool is_shifted =
      std::any_of(best.mistakes.begin(), best.mistakes.end(), [](const Diagnosis& one) {
        return one.cause == "rows_shifted";
      });
  return is_shifted ? WiringDiagnosis{} : best;
}

}  // namespace sac
