#include "motion_terms.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <thread>
#include <utility>

#include "saturated_readings.hpp"
#include "spherical_actuator_calibration/base/cholesky.hpp"
#include "spherical_actuator_calibration/base/parallel_for.hpp"

namespace sac {
namespace {

std::vector<MotionSpan> spansOf(const MotionRecording& recording) {
  std::vector<MotionSpan> spans;
  spans.reserve(recording.spans.size());
  for (const MotionStreams& streams : recording.spans) {
    spans.emplace_back(streams);
  }
  return spans;
}

/// So many of them, evenly; 0: all.
std::vector<MotionWindow> thinned(const std::vector<MotionWindow>& windows, std::size_t most) {
  if (most == 0 || windows.size() <= most) {
    return windows;
  }
  std::vector<MotionWindow> some;
  for (std::size_t n = 0; n < most; ++n) {
    some.push_back(windows[n * windows.size() / most]);
  }
  return some;
}

/// Those of slices, or cut.
std::vector<MotionWindow> windowsOf(const MotionRecording& recording,
                                    const std::vector<MotionSpan>& spans,
                                    const MotionOptions& options,
                                    std::vector<WindowsLeftOut>& left_out) {
  if (recording.windows.empty()) {
    return drivenWindows(spans, cutWindows(spans, options, left_out), left_out);
  }
  std::vector<MotionWindow> windows;
  for (std::size_t s = 0; s < spans.size(); ++s) {
    windows.push_back({s, recording.windows[s].first, recording.windows[s].last});
  }
  return drivenWindows(spans, windows, left_out);
}

/// They judge before they serve: every so manieth, where there are enough.
bool areHeldOut(std::size_t windows, const MotionOptions& options) {
  return options.hold_out_every >= 2 && windows >= options.least_windows_to_hold_out;
}

std::vector<WindowTerm> termsOf(const std::vector<MotionWindow>& windows,
                                const MotionOptions& options) {
  std::vector<WindowTerm> terms(windows.size());
  const bool some_are_held_out = areHeldOut(windows.size(), options);
  for (std::size_t n = 0; n < windows.size(); ++n) {
    terms[n].window = windows[n];
    terms[n].held_out =
        some_are_held_out && n % options.hold_out_every == options.hold_out_every / 2;
  }
  return terms;
}

/// Windows that are held out, with the orientations within them.
std::vector<HeldOutStretch> heldOutOf(const std::vector<WindowTerm>& windows,
                                      const std::vector<MotionSpan>& spans) {
  std::vector<HeldOutStretch> stretches;
  for (std::size_t n = 0; n < windows.size(); ++n) {
    if (windows[n].held_out) {
      const MotionWindow& window = windows[n].window;
      const JointTrack& track = spans[window.span].track;
      stretches.push_back({window.span, track.time(window.first), track.time(window.last), n});
    }
  }
  return stretches;
}

/// Of a window whose derivatives are there. A steady torque acts by the first test function: the
/// integral of all others is zero.
TorqueEvidence evidenceOf(const WindowTerm& term, const JointTrack& track) {
  const TestFunctions functions(track.time(term.window.first), track.time(term.window.last), 1);
  const Eigen::Matrix<double, Eigen::Dynamic, 3> by_torque =
      functions.integralOfFirst() * term.whitening.leftCols<3>();
  return {by_torque.transpose() * by_torque, by_torque.transpose() * term.residual};
}

/// To a sum of as many coordinates.
void addAll(const InformationSum& other, InformationSum& sum) {
  std::vector<Eigen::Index> all(static_cast<std::size_t>(other.gradient().size()));
  std::iota(all.begin(), all.end(), 0);
  sum.addAt(all, other);
}

}  // namespace

Eigen::MatrixXd whiteningOfMany(const Eigen::MatrixXd& covariance) {
  return Cholesky(covariance).half(Eigen::MatrixXd::Identity(covariance.rows(), covariance.cols()));
}

std::size_t keptStride(std::size_t windows) {
  constexpr std::size_t kEnough = 60;
  return std::max<std::size_t>(1, windows / kEnough);
}

MotionTerms::MotionTerms(const MotionProblem& problem, const MotionOptions& options)
    : problem_(problem),
      options_(options),
      places_(problem.model->space()),
      tabulated_(problem.model->curve()),
      spans_(spansOf(*problem.recording)),
      noise_(noiseOf(spans_, *problem.model, problem.prior.x)),
      windows_(termsOf(
          thinned(windowsOf(*problem.recording, spans_, options, left_out_), options.most_windows),
          options)),
      orientations_(*problem.model, places_, spans_, options, heldOutOf(windows_, spans_)),
      sums_(problem.prior.x.size()),
      evaluators_(std::max(1U, std::thread::hardware_concurrency()),
                  BalanceEvaluator(options, noise_.joint)) {
  const SaturatedReadings saturated(spans_);
  for (WindowTerm& term : windows_) {
    term.at_end = saturated.within(term.window, options.largest_delay);
  }
}

std::size_t MotionTerms::servingWindows() const {
  std::size_t count = 0;
  for (std::size_t n = 0; n < windows_.size(); n += every_) {
    count += windows_[n].serves() ? 1 : 0;
  }
  return std::max<std::size_t>(1, count);
}

std::size_t MotionTerms::coarseStride() const {
  constexpr double kEnoughInWindow = 50.0;
  double step = options_.window / kEnoughInWindow;
  for (const MotionSpan& span : spans_) {
    step = std::max(step, span.current_step);
  }
  double finest = step;
  for (const MotionSpan& span : spans_) {
    finest = std::min(finest, span.current_step);
  }
  return std::max<std::size_t>(1, static_cast<std::size_t>(step / std::max(finest, 1e-6)));
}

void MotionTerms::findTrackerNoise(const Eigen::VectorXd& x) {
  constexpr std::size_t kEnough = 3000;
  constexpr double kLess = 0.9;  // the smaller of two that chance has made would be too small
  const double found = trackerNoise(spans_, *problem_.model, x, kEnough);
  if (found < kLess * noise_.orientation) {
    noise_.orientation = found;
  }
}

void MotionTerms::setScales(double windows, double orientations) {
  window_scale_ = windows;
  orientations_.setScale(orientations);
}

Eigen::MatrixXd MotionTerms::whiteningFor(const WindowBalance& balance) const {
  const double variance = current_factor_ * noise_.current * noise_.current;
  return whiteningOfMany(joint_factor_ * balance.by_joints + variance * balance.by_currents);
}

void MotionTerms::setNoiseFactors(double joints, double currents) {
  joint_factor_ = joints;
  current_factor_ = currents;
  for (WindowTerm& term : windows_) {
    if (term.balance.by_joints.size() > 0) {
      term.whitening = whiteningFor(term.balance);
    }
    sums_are_old_ = sums_are_old_ || term.is_summed;
  }
}

void MotionTerms::linearize(const Eigen::VectorXd& x, const TermOrder& order) {
  linearized_at_ = x;
  every_ = order.every;
  linearizeWindows(order.balance);
  if (order.orientations) {
    orientations_.linearize(x, noise_.orientation, static_cast<unsigned>(evaluators_.size()));
  }
}

/// In a long recording the derivatives of few windows are kept.
void MotionTerms::linearizeWindows(const BalanceOrder& order) {
  constexpr std::size_t kChunks = 16;
  const MotionPoint point(*problem_.model, places_, linearized_at_, &tabulated_);
  const auto threads = static_cast<unsigned>(evaluators_.size());
  const std::size_t count = (windows_.size() + every_ - 1) / every_;
  order_ = order;
  summed_scale_ = window_scale_;
  sums_are_old_ = false;
  sums_ = WindowSums(linearized_at_.size());
  if (every_ > 1 || windows_.size() <= options_.most_kept_windows) {
    parallelFor(count, threads, [&](unsigned worker, std::size_t n) {
      keep(windows_[n * every_], point, evaluators_[worker]);
    });
    return;
  }
  // Each in its own order: what is summed up must not depend on who does it.
  std::vector<WindowSums> sums(kChunks, sums_);
  parallelFor(kChunks, threads, [&](unsigned worker, std::size_t chunk) {
    for (std::size_t n = count * chunk / kChunks; n < count * (chunk + 1) / kChunks; ++n) {
      if (n % keptStride(count) == 0) {
        keep(windows_[n], point, evaluators_[worker]);
      } else {
        sumUp(windows_[n], point, evaluators_[worker], sums[chunk]);
      }
    }
  });
  for (const WindowSums& sum : sums) {
    addAll(sum.serving, sums_.serving);
    addAll(sum.held_out, sums_.held_out);
  }
}

void MotionTerms::keep(WindowTerm& term, const MotionPoint& point, BalanceEvaluator& evaluator) {
  BalanceOrder order = order_;
  order.covariance = order.covariance || !term.isKept();
  evaluator.evaluate(spans_[term.window.span], term.window, point, order, term.balance);
  if (order.covariance) {
    term.whitening = whiteningFor(term.balance);
  }
  term.is_summed = false;
}

/// Unless it stands out: then its weight may have to be another.
void MotionTerms::sumUp(WindowTerm& term,
                        const MotionPoint& point,
                        BalanceEvaluator& evaluator,
                        WindowSums& sums) {
  constexpr double kUsual = 2.5;
  term.whitening.resize(0, 0);
  keep(term, point, evaluator);
  term.residual = term.whitening.triangularView<Eigen::Lower>() * term.balance.residual;
  term.square = term.residual.squaredNorm() / static_cast<double>(valuesPerWindow());
  if (term.serves() && term.square > kUsual * window_scale_) {
    return;
  }
  term.steady = evidenceOf(term, spans_[term.window.span].track);
  term.noise = noiseEvidenceOf(term);
  term.is_summed = true;
  term.is_in_sum = term.isSound();
  if (term.is_in_sum) {
    addToSums(term, 1.0, sums);
  }
  WindowBalance rest;
  rest.residual = term.balance.residual;
  term.balance = std::move(rest);
  term.whitening.resize(0, 0);
}

void MotionTerms::addToSums(const WindowTerm& term, double weight, WindowSums& sums) {
  const Eigen::MatrixXd jacobian =
      term.whitening.triangularView<Eigen::Lower>() * term.balance.jacobian;
  (term.held_out ? sums.held_out : sums.serving).addDense(jacobian, term.residual, weight);
}

bool MotionTerms::areSummed() const {
  return std::any_of(
      windows_.begin(), windows_.end(), [](const WindowTerm& term) { return term.is_summed; });
}

/// What is summed up stays so as long as the windows in it serve, and count in full.
void MotionTerms::sumUpWhatChanged() {
  constexpr double kSame = 1.5;
  if (!areSummed()) {
    return;
  }
  if (sums_are_old_ || kSame * window_scale_ < summed_scale_) {
    linearizeWindows(order_);
    return;
  }
  const MotionPoint point(*problem_.model, places_, linearized_at_, &tabulated_);
  for (WindowTerm& term : windows_) {
    if (!term.is_summed || term.isSound() == term.is_in_sum) {
      continue;
    }
    keep(term, point, evaluators_.front());
    if (term.is_in_sum) {
      addToSums(term, -1.0, sums_);
    }
  }
}

InformationSum MotionTerms::balance(const Eigen::VectorXd& x) {
  sumUpWhatChanged();
  const Eigen::VectorXd apart = x - linearized_at_;
  InformationSum sum = sums_.serving;
  sum.moveBy(apart);
  Eigen::MatrixXd jacobian;
  for (std::size_t n = 0; n < windows_.size(); n += every_) {
    WindowTerm& term = windows_[n];
    if (!term.isKept()) {
      continue;
    }
    const auto whitening = term.whitening.triangularView<Eigen::Lower>();
    term.residual = whitening * (term.balance.residual + term.balance.jacobian * apart);
    term.square = term.residual.squaredNorm() / static_cast<double>(valuesPerWindow());
    if (!term.serves()) {
      continue;
    }
    jacobian = whitening * term.balance.jacobian;
    sum.addDense(jacobian, term.residual, robustWeight(term.square / window_scale_));
  }
  return sum;
}

TorqueEvidence MotionTerms::steadyTorque(std::size_t window) const {
  const WindowTerm& term = windows_[window];
  return term.isKept() ? evidenceOf(term, spans_[term.window.span].track) : term.steady;
}

NoiseEvidence MotionTerms::noiseEvidenceOf(const WindowTerm& term) const {
  const double variance = noise_.current * noise_.current;
  return sac::noiseEvidence(term.balance, variance, term.whitening, term.residual);
}

std::vector<NoiseEvidence> MotionTerms::noiseEvidence() const {
  std::vector<NoiseEvidence> all;
  for (const WindowTerm& term : windows_) {
    if (term.serves()) {
      all.push_back(term.isKept() ? noiseEvidenceOf(term) : term.noise);
    }
  }
  return all;
}

double MotionTerms::squares(const Eigen::VectorXd& x) const {
  InformationSum summed = sums_.serving;
  summed.moveBy(x - linearized_at_);
  double squares = summed.squaredMisfit();
  for (const WindowTerm& term : windows_) {
    const bool counts = term.serves() && term.isKept();
    squares += counts ? term.square * static_cast<double>(valuesPerWindow()) : 0.0;
  }
  return squares;
}

InformationSum MotionTerms::orientation(const Eigen::VectorXd& x) {
  InformationSum sum(x.size());
  sum.addAt(orientations_.coordinates(), orientations_.sum(x));
  return sum;
}

bool MotionTerms::holdsOut() const {
  return std::any_of(
      windows_.begin(), windows_.end(), [](const WindowTerm& term) { return term.held_out; });
}

void MotionTerms::admitHeldOut() {
  sumUpWhatChanged();
  for (WindowTerm& term : windows_) {
    term.held_out = false;
  }
  addAll(sums_.held_out, sums_.serving);
  sums_.held_out = InformationSum(sums_.serving.gradient().size());
  orientations_.admitHeldOut();
}

InformationSum MotionTerms::heldOut(const Eigen::VectorXd& x, std::size_t& values) {
  sumUpWhatChanged();
  const Eigen::VectorXd apart = x - linearized_at_;
  InformationSum sum = sums_.held_out;
  sum.moveBy(apart);
  values = 0;
  const std::map<std::size_t, OrientationMean> means = orientations_.heldOut(x);
  for (std::size_t n = 0; n < windows_.size(); ++n) {
    const WindowTerm& term = windows_[n];
    if (!term.held_out || !term.isSound()) {
      continue;
    }
    values += static_cast<std::size_t>(valuesPerWindow());
    if (term.isKept()) {
      const auto whitening = term.whitening.triangularView<Eigen::Lower>();
      const Eigen::MatrixXd jacobian = whitening * term.balance.jacobian;
      const Eigen::VectorXd residual = term.balance.residual + term.balance.jacobian * apart;
      sum.addDense(jacobian, whitening * residual);
    }
    const auto mean = means.find(n);
    if (mean != means.end()) {
      const double root = std::sqrt(mean->second.count);
      Eigen::MatrixXd all = Eigen::MatrixXd::Zero(3, x.size());
      all(Eigen::all, orientations_.coordinates()) = mean->second.jacobian / root;
      sum.addDense(all, mean->second.residual / root);
      values += 3;
    }
  }
  return sum;
}

}  // namespace sac
