#include "motion_doubts.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "spherical_actuator_calibration/base/text_format.hpp"
#include "spherical_actuator_calibration/estimation/distributions.hpp"
#include "unmodelled_words.hpp"

namespace sac {
namespace {

/// What hands do comes now and then. What a model lacks, as the strength of a coil, comes back all
/// the time, and without the windows where it is largest the others may fit; a clock that jumps
/// leaves a part that fits as well as the other.
std::string oftenDisturbed(const std::vector<ObservationResidual>& windows) {
  constexpr double kMany = 0.06;
  constexpr std::size_t kOften = 4;
  constexpr double kMost = 0.25;
  std::size_t count = 0;
  std::size_t times = 0;
  bool was_rejected = false;
  for (const ObservationResidual& window : windows) {
    count += window.rejected ? 1 : 0;
    times += window.rejected && !was_rejected ? 1 : 0;
    was_rejected = window.rejected;
  }
  const double share = static_cast<double>(count) / static_cast<double>(windows.size());
  if (!(share > kMost || (times >= kOften && share >= kMany))) {
    return {};
  }
  const std::string when = times == 1 ? "in a row" : format("at %zu times", times);
  return format(
      "%zu of %zu windows, %s, contradict the others, and that may bias the parameters: "
      "keep hands and cables off the rotor, check the clock that stamps the currents, or model "
      "what "
      "is missing, as coil_gains.",
      count,
      windows.size(),
      when.c_str());
}

/// What the tracker says does not fit, over windows: it drifts, or its clock does.
std::string driftInWords(const WindowMeansMisfit& orientations) {
  if (!orientations.isMisfit()) {
    return {};
  }
  return format(
      "Orientations, in the mean of a window, are %.2f times their noise off: the tracker or its "
      "clock drifts or jumps, or a joint sensor is not as modelled, and that may bias the "
      "parameters: check the tracker's stamps and mounting, and model errors of the joint sensors.",
      std::sqrt(orientations.reduced() / orientations.expected));
}

/// What is counted as larger is no misfit any more.
std::string colourInWords(const MotionEstimate& found) {
  if (!(found.tracker_colour > 1.0)) {
    return {};
  }
  return format(
      "The tracker's noise is not white: orientations, in the mean of a window, are %.1f times as "
      "far off as white noise of %.2g mrad would leave them, and not alike in neighbouring "
      "windows. "
      "It counts as that much larger: look for a filter or a vibration of the tracker, and record "
      "longer where that is too much.",
      std::sqrt(found.tracker_colour),
      1e3 * found.summary.orientation_stddev / std::sqrt(found.tracker_colour));
}

/// Currents that step with their readings look like noise, and hide how large it is: what a model
/// lacks then passes for noise, but for being slow.
std::string slowMisfitInWords(const MotionEstimate& found) {
  constexpr double kSignificance = 1e-3;
  // Of 42 sound recordings by another simulation it is 1.09 at most.
  constexpr double kLeast = 1.15;
  const double ratio = found.pace.slow / found.pace.fast;
  if (!(ratio > kLeast) || found.pace.probability() > kSignificance) {
    return {};
  }
  return format(
      "What is left over changes too slowly for noise: with slow test functions its mean square is "
      "%.2f times that with fast ones. Something is not modelled that passes for noise of the "
      "readings (of currents %.3g mA), as the torque curve, friction or uneven strengths, and may "
      "bias the parameters: check these, or model effects for them.",
      ratio,
      1e3 * found.summary.current_stddev);
}

/// The standard deviations count it, as far as it is like that all the time.
std::string alignmentInWords(const ResidualAlignment& alignment) {
  if (!alignment.isMisfit()) {
    return {};
  }
  return format(
      "What is left over moves the parameters %.2f times as far as noise of single readings would "
      "(told from %.2f times on), and standard deviations count that: currents step between their "
      "readings, a clock jumps, or something is not modelled. Record coil_setpoints, read currents "
      "more often than they are set, and check clocks and joint sensors.",
      std::sqrt(alignment.ratio),
      std::sqrt(alignment.limit()));
}

/// What takes friction for another law shifts friction most, and hardly the axes.
std::string otherFrictionInWords(const MotionEstimate& found) {
  constexpr double kSure = 5.0;  // standard deviations
  const double scale = std::max(1.0, found.estimate.covariance_scale);
  std::string words;
  double most = kSure;
  for (const OtherFriction& one : found.frictions) {
    const double stddev = scale * one.stddev;
    if (std::abs(one.value) > most * stddev) {
      most = std::abs(one.value) / stddev;
      words =
          format("The motion fits better with a friction %s, by %.2g +- %.2g %s: ",
                 one.law,
                 one.value,
                 stddev,
                 one.unit) +
          (one.value > 0.0
               ? "viscous_friction and coulomb_friction take up what they can of it, and may be "
                 "further off than is stated."
               : "no friction gives back, so that torque curve, strengths and clocks are to be "
                 "checked, too.");
    }
  }
  return words;
}

/// Measurements have noise: where most readings of all coils are those before to the last digit,
/// they are setpoints, or one measurement that was told several times.
std::string repetitionInWords(const MotionRecording& recording) {
  constexpr double kMost = 0.5;
  Eigen::Index pairs = 0;
  Eigen::Index equal = 0;
  for (const MotionStreams& streams : recording.spans) {
    for (Eigen::Index n = 1; n < streams.currents.rows(); ++n) {
      ++pairs;
      equal += streams.currents.row(n) == streams.currents.row(n - 1) ? 1 : 0;
    }
  }
  const double share =
      static_cast<double>(equal) / static_cast<double>(std::max<Eigen::Index>(1, pairs));
  if (share < kMost) {
    return {};
  }
  constexpr double kPercent = 100.0;
  return format(
      "%.0f %% of the currents repeat the reading before in all coils to the last digit: "
      "setpoints, or "
      "measurements that were told several times. Inertia, friction and delays may be off by more "
      "than "
      "is stated: record each measured current once.",
      kPercent * share);
}

}  // namespace

std::string skewInWords(const MotionEstimate& found) {
  constexpr double kSure = 1e-6;    // probability that chance makes as much
  constexpr double kMatters = 1.0;  // standard deviations, of all parameters together
  const JointSkew& skew = found.skew;
  const double variance = excessVariance(found);
  if (!skew.isTold() || skew.distance < kMatters ||
      skew.value.dot(skew.covariance.inverse() * skew.value) <
          variance * chiSquareLimit(2.0, kSure)) {
    return {};
  }
  const Eigen::Vector2d stddev = (variance * skew.covariance.diagonal()).cwiseSqrt();
  constexpr double kMilli = 1e3;
  return format(
      "The motion fits better with joints that are not read at once: joint 2 by %.3f +- %.3f ms "
      "and joint 3 by %.3f +- %.3f ms later than joint 1. %s: read all joints at one instant, or "
      "bring each to the time of its stamp by its speed.",
      kMilli * skew.value[0],
      kMilli * stddev[0],
      kMilli * skew.value[1],
      kMilli * stddev[1],
      shiftInWords(skew).c_str());
}

std::vector<std::string> motionDoubts(const MotionEstimate& found,
                                      const MotionRecording& recording) {
  // Sound motions have 0.96 to 1.04; what a hand leaves in most of a motion is no window's alone.
  constexpr double kLarge = 1.1;
  const std::string skew = skewInWords(found);
  // What has a name comes before what may have several.
  std::vector<std::string> words{oftenDisturbed(found.estimate.residuals),
                                 skew.empty() ? unmodelledInWords(found) : skew,
                                 driftInWords(found.orientations),
                                 colourInWords(found),
                                 repetitionInWords(recording),
                                 slowMisfitInWords(found),
                                 alignmentInWords(found.alignment),
                                 otherFrictionInWords(found)};
  if (found.estimate.covariance_scale > 1.0 && found.summary.window_chi_square > kLarge) {
    words.push_back(
        format("Residuals are %.2f times their noise: something acts that is not modelled, as a "
               "hand or a cable, and may bias the parameters.",
               std::sqrt(found.summary.window_chi_square)));
  }
  words.erase(std::remove(words.begin(), words.end(), std::string()), words.end());
  return words;
}

}  // namespace sac
