#include "motion_probe.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "curve_stretch.hpp"
#include "other_friction.hpp"
#include "reading_errors.hpp"
#include "residual_probe.hpp"
#include "spherical_actuator_calibration/base/cholesky.hpp"

namespace sac {
namespace {

using Kind = UnmodelledError::Kind;

/// How something may change over a recording: by Legendre's polynomials of the first degrees.
constexpr Eigen::Index kShapes = 3;

// Columns of what is neither friction of a known law nor an error of readings.
constexpr auto kFrictions = static_cast<Eigen::Index>(kFrictionLaws);
constexpr Eigen::Index kStretch = kFrictions;
constexpr Eigen::Index kDrift = kStretch + 1;
constexpr Eigen::Index kCurrentClock = kDrift + 3 * kShapes;
constexpr Eigen::Index kTrackerClock = kCurrentClock + kShapes;
constexpr Eigen::Index kOthers = kTrackerClock + kShapes;

/// The time of a recording, all spans by one clock.
class RecordingTime {
 public:
  explicit RecordingTime(const std::vector<MotionSpan>& spans) {
    bool is_first = true;
    for (const MotionSpan& span : spans) {
      if (!span.streams->joint_stamps.empty()) {
        const Stamp begin = span.streams->joint_stamps.front();
        const Stamp end = span.streams->joint_stamps.back();
        begin_ = is_first ? begin : std::min(begin_, begin);
        end_ = is_first ? end : std::max(end_, end);
        is_first = false;
      }
    }
  }

  /// At a time of a span.
  Eigen::Matrix<double, 1, kShapes> shapes(const MotionSpan& span, double time) const {
    const double all = secondsBetween(begin_, end_);
    const double passed = secondsBetween(begin_, span.streams->joint_stamps.front()) + time;
    const double t = all > 0.0 ? 2.0 * passed / all - 1.0 : 0.0;
    return {t, 1.5 * t * t - 0.5, (2.5 * t * t - 1.5) * t};
  }

 private:
  Stamp begin_ = 0;
  Stamp end_ = 0;
};

/// Windows and orientations of one estimate, with what they would be if the model knew more.
class MotionProbe {
 public:
  MotionProbe(const MotionTerms& terms,
              const MotionOptions& options,
              const std::vector<Eigen::Index>& estimated,
              const Eigen::VectorXd& x)
      : terms_(terms),
        options_(options),
        x_(x),
        time_(terms.spans()),
        ranges_(rangesOf(terms.spans())),
        readings_(estimated, kReadingErrors),
        others_(estimated, kOthers) {}

  void addWindows();
  void addOrientations();
  ResidualProbe::Finding friction(Eigen::Index law) const { return others_.find(law, 1); }
  ResidualProbe::Finding skew() const { return readings_.find(0, kSkews); }
  ResidualProbe::Finding readings(std::size_t joint) const {
    const Eigen::Index first = kSkews + static_cast<Eigen::Index>(joint) * kReadingShapes;
    return readings_.find(first, kReadingShapes);
  }
  bool turns(std::size_t joint) const { return ranges_[joint].turns(); }
  ResidualProbe::Finding other(Eigen::Index first, Eigen::Index count) const {
    return others_.find(first, count);
  }

 private:
  Eigen::MatrixXd byOthers(const WindowTerm& term, const MotionPoint& point) const;
  void addOrientations(const OrientationGroup& group, TrackerTerm& tracker);
  void addMean(const OrientationGroup& group);

  const MotionTerms& terms_;
  const MotionOptions& options_;
  const Eigen::VectorXd& x_;
  RecordingTime time_;
  JointRanges ranges_;
  ResidualProbe readings_;  ///< by some windows: each has to be evaluated anew
  ResidualProbe others_;
};

Eigen::MatrixXd MotionProbe::byOthers(const WindowTerm& term, const MotionPoint& point) const {
  const MotionSpan& span = terms_.spans()[term.window.span];
  const int functions = options_.test_functions;
  Eigen::MatrixXd columns = Eigen::MatrixXd::Zero(terms_.valuesPerWindow(), kOthers);
  columns.leftCols<kFrictions>() = balanceByFrictions(term.window, span.track, point, functions);
  columns.col(kStretch) =
      balanceByStretch(span, term.window, point, functions, terms_.coarseStride());
  const Eigen::Index delay = terms_.places().current_delay;
  if (delay >= 0) {
    const double middle =
        0.5 * (span.track.time(term.window.first) + span.track.time(term.window.last));
    columns.middleCols<kShapes>(kCurrentClock) =
        term.balance.jacobian.col(delay) / point.scaleAt(delay) * time_.shapes(span, middle);
  }
  return columns;
}

void MotionProbe::addWindows() {
  const MotionPoint point = terms_.pointAt(x_);
  ReadingErrorEvaluator readings(options_, ranges_);
  const std::size_t stride = keptStride(terms_.windowCount());
  for (std::size_t n = 0; n < terms_.windowCount(); ++n) {
    const WindowTerm& term = terms_.windows()[n];
    const bool is_some = n % stride == 0;
    // Of a sum, others are kept because they stand out.
    if (!term.serves() || !term.isKept() || (terms_.areSummed() && !is_some)) {
      continue;
    }
    const MotionSpan& span = terms_.spans()[term.window.span];
    const auto whitening = term.whitening.triangularView<Eigen::Lower>();
    const Eigen::MatrixXd by_coordinates = whitening * term.balance.jacobian;
    others_.add(by_coordinates, whitening * byOthers(term, point), term.residual);
    if (is_some) {
      readings_.add(
          by_coordinates, whitening * readings.evaluate(span, term.window, point), term.residual);
    }
  }
}

void MotionProbe::addOrientations() {
  const std::vector<OrientationGroup>& groups = terms_.orientations().groups();
  const std::size_t stride = keptStride(groups.size());
  TrackerTerm tracker(terms_.orientations().model(), terms_.places(), x_);
  for (std::size_t n = 0; n < groups.size(); n += stride) {
    addOrientations(groups[n], tracker);
  }
  // What is taken of the windows is taken of these.
  const std::size_t every = terms_.areSummed() ? stride : 1;
  for (std::size_t n = 0; n < groups.size(); n += every) {
    addMean(groups[n]);
  }
}

void MotionProbe::addOrientations(const OrientationGroup& group, TrackerTerm& tracker) {
  const double whitening = 1.0 / terms_.noise().orientation;
  const MotionSpan& span = terms_.spans()[group.span];
  const ParameterSpace& space = terms_.orientations().model().space();
  const auto most = 3 * static_cast<Eigen::Index>(group.count);
  Eigen::MatrixXd by_coordinates(most, x_.size());
  Eigen::MatrixXd by_errors(most, kReadingErrors);
  Eigen::VectorXd residual(most);
  Eigen::Index rows = 0;
  for (std::size_t n = 0; n < group.count; ++n) {
    const bool serves = terms_.orientations().terms()[group.term + n].active;
    if (!serves || !tracker.evaluate(span, group.first + n)) {
      continue;
    }
    by_coordinates.middleRows<3>(rows) = whitening * tracker.jacobian();
    for (Eigen::Index k = 0; k < kSkews; ++k) {
      by_errors.block<3, 1>(rows, k) = -whitening * tracker.byTime(static_cast<std::size_t>(k) + 1);
    }
    for (std::size_t k = 0; k < kJoints; ++k) {
      const auto joint = static_cast<Eigen::Index>(k);
      by_errors.block<3, kReadingShapes>(rows, kSkews + kReadingShapes * joint) =
          -whitening * tracker.jacobian().col(space.joint(k)) *
          ranges_[k].shapes(tracker.reading()[joint]).transpose();
    }
    residual.segment<3>(rows) = whitening * tracker.residual();
    rows += 3;
  }
  readings_.add(by_coordinates.topRows(rows), by_errors.topRows(rows), residual.head(rows));
}

/// What drifts hardly changes within a window: the mean over it tells of it.
void MotionProbe::addMean(const OrientationGroup& group) {
  const OrientationMean& mean = group.mean;
  if (!(mean.count > 0.0)) {
    return;
  }
  const double root = std::sqrt(mean.count);
  const MotionSpan& span = terms_.spans()[group.span];
  const double time = span.orientation_times[group.first + group.count / 2];
  const Eigen::Matrix<double, 1, kShapes> shapes = time_.shapes(span, time);
  Eigen::MatrixXd by_coordinates = Eigen::MatrixXd::Zero(3, x_.size());
  by_coordinates(Eigen::all, terms_.orientations().coordinates()) = mean.jacobian / root;
  Eigen::MatrixXd by_others = Eigen::MatrixXd::Zero(3, kOthers);
  for (Eigen::Index n = 0; n < kShapes; ++n) {
    by_others.middleCols<3>(kDrift + 3 * n)
        .diagonal()
        .setConstant(-root * shapes[n] / terms_.noise().orientation);
  }
  const Eigen::Index delay = terms_.places().tracker_delay;
  if (delay >= 0) {
    const ParameterSpace& space = terms_.orientations().model().space();
    const double scale = space.effects().scale(delay - space.effect());
    by_others.middleCols<kShapes>(kTrackerClock) = by_coordinates.col(delay) / scale * shapes;
  }
  others_.add(by_coordinates, by_others, terms_.orientations().residualAt(x_, mean) / root);
}

/// Of what geometry tells, by its covariance.
double distanceOf(const Eigen::VectorXd& bias, const Eigen::MatrixXd& covariance) {
  const Cholesky factor(covariance);
  return factor.isPositive() ? factor.half(bias).norm() : 0.0;
}

EstimateShift shiftOf(const ResidualProbe::Finding& finding,
                      const std::vector<Eigen::Index>& estimated,
                      const ParameterSpace& space,
                      const Eigen::MatrixXd& covariance) {
  EstimateShift most;
  std::vector<Eigen::Index> geometry;
  for (std::size_t n = 0; n < estimated.size() && estimated[n] < space.effect(); ++n) {
    geometry.push_back(estimated[n]);
    const double variance = covariance(estimated[n], estimated[n]);
    const double shift =
        variance > 0.0 ? finding.bias[static_cast<Eigen::Index>(n)] / std::sqrt(variance) : 0.0;
    if (std::abs(shift) > std::abs(most.shift)) {
      most.shift = shift;
      most.most_shifted = space.name(estimated[n]);
    }
  }
  const auto count = static_cast<Eigen::Index>(geometry.size());
  most.distance = distanceOf(finding.bias.head(count), covariance(geometry, geometry));
  return most;
}

}  // namespace

void probeMotion(const MotionTerms& terms,
                 const MotionOptions& options,
                 const std::vector<Eigen::Index>& estimated,
                 MotionEstimate& found) {
  const ParameterBelief& belief = found.estimate.belief;
  const ParameterSpace& space = terms.orientations().model().space();
  MotionProbe probe(terms, options, estimated, belief.x);
  probe.addWindows();
  for (std::size_t k = 0; k < kFrictionLaws; ++k) {
    const ResidualProbe::Finding one = probe.friction(static_cast<Eigen::Index>(k));
    if (one.is_told) {
      const FrictionLaw& law = kFrictionLawsInWords[k];
      found.frictions.push_back(
          {law.words, law.unit, one.value[0], std::sqrt(one.covariance(0, 0))});
    }
  }
  probe.addOrientations();
  const ResidualProbe::Finding skew = probe.skew();
  if (skew.is_told) {
    static_cast<EstimateShift&>(found.skew) = shiftOf(skew, estimated, space, belief.covariance);
    found.skew.value = skew.value;
    found.skew.covariance = skew.covariance;
  }
  const auto keep = [&](Kind kind, std::size_t joint, const ResidualProbe::Finding& one) {
    if (one.is_told) {
      found.unmodelled.push_back({shiftOf(one, estimated, space, belief.covariance),
                                  kind,
                                  joint,
                                  one.value,
                                  one.covariance});
    }
  };
  for (std::size_t k = 0; k < kJoints; ++k) {
    keep(probe.turns(k) ? Kind::kTurn : Kind::kScale, k, probe.readings(k));
  }
  keep(Kind::kCurve, 0, probe.other(kStretch, 1));
  keep(Kind::kTrackerDrift, 0, probe.other(kDrift, 3 * kShapes));
  keep(Kind::kCurrentClock, 0, probe.other(kCurrentClock, kShapes));
  keep(Kind::kTrackerClock, 0, probe.other(kTrackerClock, kShapes));
}

}  // namespace sac
