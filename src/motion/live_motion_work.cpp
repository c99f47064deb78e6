#include "live_motion_work.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <thread>
#include <utility>

#include "spherical_actuator_calibration/base/cholesky.hpp"
#include "spherical_actuator_calibration/base/median.hpp"
#include "spherical_actuator_calibration/base/parallel_for.hpp"
#include "spherical_actuator_calibration/estimation/distributions.hpp"
#include "spherical_actuator_calibration/motion/motion_estimator.hpp"

namespace sac {
namespace {

/// Coordinates of these that are not exact beforehand.
std::vector<Eigen::Index> uncertain(std::vector<Eigen::Index> coordinates,
                                    const ParameterBelief& prior) {
  coordinates.erase(std::remove_if(coordinates.begin(),
                                   coordinates.end(),
                                   [&](Eigen::Index p) { return !(prior.covariance(p, p) > 0.0); }),
                    coordinates.end());
  return coordinates;
}

/// Always of the same readings, or their noise would look like an error of derivatives.
BalanceOrder orderOf(bool with_covariance) {
  BalanceOrder order;
  order.covariance = with_covariance;
  order.at_nodes = true;
  return order;
}

}  // namespace

LiveMotionWork::LiveMotionWork(const CalibrationModel& model,
                               ParameterBelief prior,
                               std::vector<Eigen::Index> free,
                               const EstimationOptions& estimation,
                               const MotionOptions& options,
                               const LiveMotionOptions& live)
    : model_(&model),
      prior_(std::move(prior)),
      asked_(uncertain(std::move(free), prior_)),
      estimation_(estimation),
      options_(options),
      live_(live),
      places_(model.space()),
      tabulated_(model.curve()),
      orienting_(orientingCoordinates(model.space(), places_)),
      prior_information_(Eigen::MatrixXd::Zero(prior_.x.size(), prior_.x.size())),
      next_begin_(live.first_windows),
      anchor_(prior_.x),
      balance_(prior_.x.size()),
      orientation_(static_cast<Eigen::Index>(orienting_.size())),
      means_(orientation_),
      frozen_balance_(prior_.x.size()),
      frozen_orientation_(static_cast<Eigen::Index>(orienting_.size())),
      frozen_at_(prior_.x),
      x_(prior_.x) {
  // What judges would be missed here.
  options_.hold_out_every = 0;
  chooseFree();
  estimate_.belief = prior_;
}

/// All that is asked for, but what silent coils would tell of: that stays at the prior.
void LiveMotionWork::chooseFree() {
  const std::vector<Eigen::Index> untold = coordinatesOfCoils(model_->space(), silent_);
  for (const Eigen::Index p : untold) {
    x_[p] = prior_.x[p];
  }
  free_.clear();
  std::set_difference(
      asked_.begin(), asked_.end(), untold.begin(), untold.end(), std::back_inserter(free_));
  const Eigen::MatrixXd inverse = Cholesky(prior_.covariance(free_, free_)).inverse();
  prior_information_.setZero();
  prior_information_(free_, free_) = inverse;
  Eigen::VectorXd held = prior_.covariance.diagonal();
  held(free_).setZero();
  holds_uncertain_ = !held.isZero(0.0);
}

/// The first estimate, of the newer half of the windows, where they are enough for one. Where
/// nothing fits, as long as a fixture turns the rotor, it is tried in vain: it must stay short, and
/// seldom.
void LiveMotionWork::begin() {
  constexpr int kMostIterations = 8;  // a motion that fits takes two or three
  const std::size_t few = live_.first_windows;
  const std::size_t newest = std::clamp(estimate_.windows / 2, few, 2 * few);
  MotionRecording recording;
  for (std::size_t n = kept_.size() - std::min(newest, kept_.size()); n < kept_.size(); ++n) {
    recording.spans.push_back(kept_[n].streams());
    recording.windows.push_back(kept_[n].range());
  }
  MotionProblem problem;
  problem.model = model_;
  problem.recording = &recording;
  problem.free = free_;
  problem.prior = prior_;
  EstimationOptions brief = estimation_;
  brief.max_iterations = std::min(brief.max_iterations, kMostIterations);
  const MotionEstimate found = estimateMotion(problem, brief, options_);
  if (found.estimate.termination != Termination::kConverged) {
    const std::size_t further = std::min(estimate_.windows, live_.kept_windows) / 2;
    next_begin_ = estimate_.windows + std::max<std::size_t>(1, further);
    return;
  }
  // What was before may have been driven by something else: among many such the others would be
  // the outliers.
  kept_.erase(kept_.begin(), kept_.end() - static_cast<std::ptrdiff_t>(recording.windows.size()));
  x_ = found.estimate.belief.x;
  estimate_.is_told = true;
  linearizeAnew(true);
}

/// Noise of the streams, by windows from all over what is kept.
void LiveMotionWork::takeNoise() {
  constexpr std::size_t kEnough = 40;
  std::vector<MotionSpan> spans;
  const std::size_t stride = std::max<std::size_t>(1, kept_.size() / kEnough);
  for (std::size_t n = 0; n < kept_.size(); n += stride) {
    spans.push_back(kept_[n].span());
  }
  noise_ = noiseOf(spans, *model_, x_);
  evaluators_ = std::vector<BalanceEvaluator>(std::max(1U, std::thread::hardware_concurrency()),
                                              BalanceEvaluator(options_, noise_.joint));
}

/// By how much the noise is smaller than the streams say, by the likelihood of the residuals.
void LiveMotionWork::findNoise() {
  constexpr std::size_t kEnough = 60;
  const double variance = noise_.current * noise_.current;
  std::vector<NoiseEvidence> evidence;
  const std::size_t stride = std::max<std::size_t>(1, kept_.size() / kEnough);
  for (std::size_t n = 0; n < kept_.size(); n += stride) {
    const WindowTerm& term = kept_[n].term;
    if (term.active) {
      evidence.push_back(
          noiseEvidence(term.balance, variance, term.whitening, residualOf(kept_[n])));
    }
  }
  const double values = 3.0 * options_.test_functions * static_cast<double>(kept_.size());
  const double share = std::max(0.1, 1.0 - static_cast<double>(free_.size()) / values);
  factors_ = likelyFactors(evidence, noise_.chance, share);
  for (LiveWindow& window : kept_) {
    window.whiten(factors_.joints, factors_.currents * variance);
  }
}

/// Linearises what is kept where the estimate is; the squared whitened misfit that the derivatives
/// of before have got wrong.
double LiveMotionWork::linearizeKept(bool with_covariance) {
  const MotionPoint point(*model_, places_, x_, &tabulated_);
  std::vector<double> wrong(kept_.size(), 0.0);
  const auto threads = static_cast<unsigned>(evaluators_.size());
  parallelFor(kept_.size(), threads, [&](unsigned worker, std::size_t n) {
    LiveWindow& window = kept_[n];
    const bool is_first = window.linearizedAt().size() == 0;
    const Eigen::VectorXd expected = is_first ? Eigen::VectorXd() : window.balanceAt(x_);
    const BalanceOrder order = orderOf(with_covariance || is_first);
    window.linearize(point, order, evaluators_[worker]);
    if (order.covariance) {
      window.whiten(factors_.joints, factors_.currents * noise_.current * noise_.current);
    }
    window.linearizeOrientations(*model_, places_, orienting_, x_, noise_.orientation);
    const Eigen::VectorXd& residual = window.term.balance.residual;
    wrong[n] = window.whitened(is_first ? residual : residual - expected).squaredNorm();
  });
  double sum = 0.0;
  for (const double one : wrong) {
    sum += one;
  }
  return sum;
}

double LiveMotionWork::limitFor(std::size_t windows) const {
  const double freedom = 3.0 * options_.test_functions;
  const double probability = estimation_.false_alarm_probability / static_cast<double>(windows);
  return chiSquareLimit(freedom, probability) / freedom;
}

double LiveMotionWork::scaleOf(const std::vector<double>& squares) const {
  const double freedom = 3.0 * options_.test_functions;
  return std::max(1.0, medianOf(squares) / (chiSquareLimit(freedom, 0.5) / freedom));
}

/// Which windows contradict the others, with the estimate of now.
void LiveMotionWork::judgeKept() {
  std::vector<double> squares;
  for (LiveWindow& window : kept_) {
    const Eigen::VectorXd residual = residualOf(window);
    window.term.square = residual.squaredNorm() / static_cast<double>(residual.size());
    squares.push_back(window.term.square);
  }
  scale_ = scaleOf(squares);
  const double limit = scale_ * limitFor(kept_.size());
  for (LiveWindow& window : kept_) {
    window.term.active = window.term.square <= limit;
  }
}

void LiveMotionWork::addTo(InformationSum& balance,
                           InformationSum& orientation,
                           const LiveWindow& window) const {
  if (window.term.active) {
    const Eigen::MatrixXd jacobian = window.whitenedJacobian();
    balance.addDense(
        jacobian, window.residualAt(anchor_), robustWeight(window.term.square / scale_));
  }
  InformationSum moved = window.orientation;
  const Eigen::VectorXd apart = anchor_ - window.linearizedAt();
  moved.moveBy(apart(orienting_));
  std::vector<Eigen::Index> all(orienting_.size());
  for (std::size_t n = 0; n < all.size(); ++n) {
    all[n] = static_cast<Eigen::Index>(n);
  }
  orientation.addAt(all, moved);
}

void LiveMotionWork::addMean(const LiveWindow& window, double weight) {
  window.addMeanTo(means_, anchor_(orienting_), weight);
}

/// All that is kept and all that was, at the estimate of now.
void LiveMotionWork::sumUp() {
  anchor_ = x_;
  const Eigen::VectorXd apart = anchor_ - frozen_at_;
  balance_ = frozen_balance_;
  balance_.moveBy(apart);
  orientation_ = frozen_orientation_;
  orientation_.moveBy(apart(orienting_));
  means_ = InformationSum(orientation_.gradient().size());
  for (const LiveWindow& window : kept_) {
    addTo(balance_, orientation_, window);
    addMean(window, 1.0);
  }
}

void LiveMotionWork::linearizeAnew(bool with_noise) {
  constexpr int kMostRounds = 6;
  if (with_noise) {
    takeNoise();
    // What many windows have told of the noise, more do not tell better.
    next_noise_ = estimate_.windows < live_.kept_windows / 2
                      ? 2 * estimate_.windows
                      : std::numeric_limits<std::size_t>::max();
  }
  for (int round = 0; round < kMostRounds; ++round) {
    const double wrong = linearizeKept(with_noise && round == 0);
    ++estimate_.linearizations;
    judgeKept();
    if (with_noise && round == 0) {
      findNoise();
      judgeKept();
    }
    sumUp();
    solve();
    if (!(wrong > live_.tolerance * live_.tolerance)) {
      break;
    }
  }
  lately_left_out_ = 0;
}

/// Whether the derivatives of where kept windows were linearised mislead the estimate, as one of
/// them tells: all others may be wrong in the same way.
bool LiveMotionWork::misleads() {
  const LiveWindow& window = kept_[next_probe_ % kept_.size()];
  next_probe_ += 7;
  window.evaluate(
      MotionPoint(*model_, places_, x_, &tabulated_), orderOf(false), evaluators_, [] {}, probe_);
  const double wrong = window.whitened(probe_.residual - window.balanceAt(x_)).squaredNorm();
  return wrong * static_cast<double>(kept_.size()) > live_.tolerance * live_.tolerance;
}

/// Whether a window is farther off than its noise and the uncertainty of the estimate allow.
bool LiveMotionWork::contradicts(const LiveWindow& window) const {
  const Eigen::VectorXd residual = residualOf(window);
  const double limit = scale_ * limitFor(kept_.size()) * static_cast<double>(residual.size());
  if (residual.squaredNorm() <= limit) {
    return false;
  }
  const Eigen::MatrixXd jacobian = window.whitenedJacobian();
  Eigen::MatrixXd spread = jacobian * estimate_.belief.covariance * jacobian.transpose();
  if (by_steps_ > 0.0) {
    // The delay that is estimated takes up what this tells of.
    const Eigen::VectorXd delay = jacobian.col(places_.current_delay);
    spread.noalias() -= by_steps_ * (delay * delay.transpose());
  }
  spread.diagonal().array() += 1.0;
  return residual.dot(Cholesky(spread).solve(residual)) > limit;
}

/// A window that just came.
void LiveMotionWork::take(LiveWindow& window) {
  const MotionPoint point(*model_, places_, x_, &tabulated_);
  window.linearize(point, orderOf(true), evaluators_, [&] {
    window.linearizeOrientations(*model_, places_, orienting_, x_, noise_.orientation);
    steps_.add(window.streams());
    silent_coils_.add(window.streams());
    freezeOldest();
  });
  window.whiten(factors_.joints, factors_.currents * noise_.current * noise_.current);
  const Eigen::VectorXd residual = residualOf(window);
  window.term.square = residual.squaredNorm() / static_cast<double>(residual.size());
  window.term.active = !contradicts(window);
  lately_left_out_ += window.term.active ? 0 : 1;
  addTo(balance_, orientation_, window);
  addMean(window, 1.0);
}

/// Where more than the last ones are kept.
void LiveMotionWork::freezeOldest() {
  if (kept_.size() <= live_.kept_windows) {
    return;
  }
  const LiveWindow& oldest = kept_.front();
  if (estimate_.is_told) {
    addMean(oldest, -1.0);
    std::swap(anchor_, frozen_at_);
    addTo(frozen_balance_, frozen_orientation_, oldest);
    std::swap(anchor_, frozen_at_);
    frozen_serving_ += oldest.term.active ? 1 : 0;
    frozen_duration_ += oldest.term.active ? oldest.duration() : 0.0;
    frozen_orientations_ += oldest.orientations;
  }
  kept_.pop_front();
}

void LiveMotionWork::add(MotionSlice slice) {
  constexpr std::size_t kProbeEvery = 8;
  // So many that contradict an estimate put it into doubt.
  constexpr std::size_t kManyLeftOut = 8;
  ++estimate_.windows;
  kept_.emplace_back(std::move(slice));
  if (!estimate_.is_told) {
    steps_.add(kept_.back().streams());
    silent_coils_.add(kept_.back().streams());
    freezeOldest();
    if (estimate_.windows >= next_begin_) {
      silent_ = silent_coils_.found();
      chooseFree();
      begin();
    }
    return;
  }
  take(kept_.back());
  std::vector<std::size_t> silent = silent_coils_.found();
  const bool changes = silent != silent_;
  if (changes) {
    silent_ = std::move(silent);
    chooseFree();
  } else {
    solve();
  }
  if (estimate_.windows >= next_noise_) {
    linearizeAnew(true);
  } else if (changes || lately_left_out_ >= kManyLeftOut ||
             (estimate_.windows % kProbeEvery == 0 && misleads())) {
    linearizeAnew(false);
  }
}

}  // namespace sac
