#include "unmodelled_words.hpp"

#include <algorithm>
#include <cmath>

#include "spherical_actuator_calibration/base/text_format.hpp"
#include "spherical_actuator_calibration/estimation/distributions.hpp"

namespace sac {
namespace {

using Kind = UnmodelledError::Kind;

constexpr double kMilli = 1e3;

/// Squared, over what chance makes once in a million times: 1 and more is told.
double sureness(const UnmodelledError& error, double variance) {
  constexpr double kSure = 1e-6;
  const double square = error.value.dot(error.covariance.ldlt().solve(error.value));
  return square / (variance * chiSquareLimit(static_cast<double>(error.value.size()), kSure));
}

/// What matters to no parameter needs no doubt. A drift does where it is told: it comes with a mean
/// that nothing tells from a registration or an offset of a joint.
bool matters(const UnmodelledError& error) {
  constexpr double kMatters = 1.0;  // standard deviations, of all parameters together
  return error.kind == Kind::kTrackerDrift || error.distance >= kMatters;
}

/// Root mean square over a recording of what changes by Legendre's polynomials, `size` values each.
double rootMeanSquare(const Eigen::VectorXd& value, Eigen::Index size) {
  double squares = 0.0;
  for (Eigen::Index n = 0; n * size < value.size(); ++n) {
    const double degree = static_cast<double>(n) + 1.0;
    squares += value.segment(n * size, size).squaredNorm() / (2.0 * degree + 1.0);
  }
  return std::sqrt(squares);
}

std::string errorInWords(const UnmodelledError& error, double scale) {
  const Eigen::VectorXd& value = error.value;
  switch (error.kind) {
    case Kind::kTurn:
      return format("readings of joint %zu that err once a turn, by %.2g mrad",
                    error.joint + 1,
                    kMilli * value.norm());
    case Kind::kScale:
      return format("readings of joint %zu that err by %.2g mrad at the ends of its range",
                    error.joint + 1,
                    kMilli * value.cwiseAbs().sum());
    case Kind::kCurve:
      return format("a torque curve that is wider in angle by %.3f +- %.3f %%",
                    100.0 * value[0],
                    100.0 * scale * std::sqrt(error.covariance(0, 0)));
    case Kind::kTrackerDrift:
      return format("a tracker that drifts, by %.2g mrad rms", kMilli * rootMeanSquare(value, 3));
    case Kind::kCurrentClock:
      return format("stamps of the currents that drift, by %.2g ms rms",
                    kMilli * rootMeanSquare(value, 1));
    case Kind::kTrackerClock:
      return format("stamps of the tracker that drift, by %.2g ms rms",
                    kMilli * rootMeanSquare(value, 1));
  }
  return {};
}

std::string adviceFor(Kind kind) {
  switch (kind) {
    case Kind::kTurn:
      return "centre the encoder, or model encoder_harmonics.";
    case Kind::kScale:
      return "check the sensor's scale, or model tilt_cross_axis.";
    case Kind::kCurve:
      return "measure the curve, or model torque_curve.";
    case Kind::kTrackerDrift:
      return "let it warm up, fix it and its marker, and record anew.";
    case Kind::kCurrentClock:
    case Kind::kTrackerClock:
      return "let one clock make all stamps, and record anew.";
  }
  return {};
}

}  // namespace

double excessVariance(const MotionEstimate& found) {
  return std::max(
      {1.0, std::pow(found.estimate.covariance_scale, 2), found.summary.orientation_chi_square});
}

std::string shiftInWords(const EstimateShift& shift) {
  return format(
      "That puts the parameters together off by %.1f standard deviations, %s by %.1f of its own",
      shift.distance,
      shift.most_shifted.c_str(),
      std::abs(shift.shift));
}

std::string unmodelledInWords(const MotionEstimate& found) {
  const double variance = excessVariance(found);
  const UnmodelledError* surest = nullptr;
  double most = 1.0;
  for (const UnmodelledError& error : found.unmodelled) {
    const double sure = sureness(error, variance);
    if (sure >= most && matters(error)) {
      most = sure;
      surest = &error;
    }
  }
  if (surest == nullptr) {
    return {};
  }
  return "The motion fits better with " + errorInWords(*surest, std::sqrt(variance)) + ". " +
         shiftInWords(*surest) + ": " + adviceFor(surest->kind);
}

}  // namespace sac
