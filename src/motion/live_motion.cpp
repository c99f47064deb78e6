#include "spherical_actuator_calibration/motion/live_motion.hpp"

#include <algorithm>
#include <cmath>
#include <deque>
#include <thread>
#include <utility>

#include <Eigen/Cholesky>

#include "live_window.hpp"
#include "noise_factors.hpp"
#include "spherical_actuator_calibration/base/median.hpp"
#include "spherical_actuator_calibration/base/parallel_for.hpp"
#include "spherical_actuator_calibration/estimation/chi_square_limit.hpp"
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

}  // namespace

class LiveMotion::Work {
 public:
  Work(const CalibrationModel& model,
       ParameterBelief prior,
       std::vector<Eigen::Index> free,
       const EstimationOptions& estimation,
       const MotionOptions& options,
       const LiveMotionOptions& live);

  void add(MotionSlice slice);
  const LiveEstimate& estimate() const { return estimate_; }

 private:
  void begin();
  void take(LiveWindow& window);
  void freezeOldest();
  void linearizeAnew(bool with_noise);
  double linearizeKept(bool with_covariance);
  void takeNoise();
  void findNoise();
  double scaleOf(const std::vector<double>& squares) const;
  double limitFor(std::size_t windows) const;
  void judgeKept();
  void sumUp();
  bool misleads();
  Eigen::VectorXd residualOf(const LiveWindow& window) const { return window.residualAt(x_); }
  bool contradicts(const LiveWindow& window) const;
  void addTo(InformationSum& balance, InformationSum& orientation, const LiveWindow& window) const;
  Eigen::MatrixXd information() const;
  void solve();
  void tell(const Eigen::MatrixXd& inverse);
  double chiSquare() const;
  double orientationChiSquare() const;
  void countServing();

  const CalibrationModel* model_;
  ParameterBelief prior_;
  std::vector<Eigen::Index> free_;
  EstimationOptions estimation_;
  MotionOptions options_;
  LiveMotionOptions live_;
  MotionPlaces places_;
  std::vector<Eigen::Index> orienting_;
  Eigen::MatrixXd prior_information_;  ///< zero where a coordinate is held
  bool holds_uncertain_ = false;       ///< some coordinate that is not free is uncertain

  StreamNoise noise_;
  NoiseFactors factors_;
  std::vector<BalanceEvaluator> evaluators_;  ///< one for each thread
  WindowBalance probe_;
  double scale_ = 1.0;  ///< squared misfit of usual windows, over that of noise

  std::deque<LiveWindow> kept_;  ///< oldest first
  std::size_t next_probe_ = 0;
  std::size_t next_begin_;
  std::size_t next_noise_ = 0;

  // At `anchor_`.
  Eigen::VectorXd anchor_;
  InformationSum balance_;
  InformationSum orientation_;
  // Of windows that are not kept any more, at `frozen_at_`.
  InformationSum frozen_balance_;
  InformationSum frozen_orientation_;
  Eigen::VectorXd frozen_at_;
  std::size_t frozen_serving_ = 0;
  double frozen_duration_ = 0.0;
  std::size_t frozen_orientations_ = 0;

  Eigen::VectorXd x_;
  std::size_t lately_left_out_ = 0;
  LiveEstimate estimate_;
};

LiveMotion::Work::Work(const CalibrationModel& model,
                       ParameterBelief prior,
                       std::vector<Eigen::Index> free,
                       const EstimationOptions& estimation,
                       const MotionOptions& options,
                       const LiveMotionOptions& live)
    : model_(&model),
      prior_(std::move(prior)),
      free_(uncertain(std::move(free), prior_)),
      estimation_(estimation),
      options_(options),
      live_(live),
      places_(model.space()),
      orienting_(orientingCoordinates(model.space(), places_)),
      prior_information_(Eigen::MatrixXd::Zero(prior_.x.size(), prior_.x.size())),
      next_begin_(live.first_windows),
      anchor_(prior_.x),
      balance_(prior_.x.size()),
      orientation_(static_cast<Eigen::Index>(orienting_.size())),
      frozen_balance_(prior_.x.size()),
      frozen_orientation_(static_cast<Eigen::Index>(orienting_.size())),
      frozen_at_(prior_.x),
      x_(prior_.x) {
  // What judges would be missed here.
  options_.hold_out_every = 0;
  const auto count = static_cast<Eigen::Index>(free_.size());
  const Eigen::MatrixXd known = prior_.covariance(free_, free_);
  const Eigen::MatrixXd inverse = known.llt().solve(Eigen::MatrixXd::Identity(count, count));
  prior_information_(free_, free_) = inverse;
  Eigen::VectorXd held = prior_.covariance.diagonal();
  held(free_).setZero();
  holds_uncertain_ = !held.isZero(0.0);
  estimate_.belief = prior_;
}

/// The first estimate, where the windows are enough for one.
void LiveMotion::Work::begin() {
  MotionRecording recording;
  for (const LiveWindow& window : kept_) {
    recording.spans.push_back(window.streams());
    recording.windows.push_back(window.range());
  }
  MotionProblem problem;
  problem.model = model_;
  problem.recording = &recording;
  problem.free = free_;
  problem.prior = prior_;
  const MotionEstimate found = estimateMotion(problem, estimation_, options_);
  if (found.estimate.termination != Termination::kConverged) {
    next_begin_ = estimate_.windows + std::max<std::size_t>(1, live_.first_windows / 2);
    return;
  }
  x_ = found.estimate.belief.x;
  estimate_.is_told = true;
  linearizeAnew(true);
}

/// Noise of the streams, by windows from all over what is kept.
void LiveMotion::Work::takeNoise() {
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
void LiveMotion::Work::findNoise() {
  constexpr std::size_t kEnough = 60;
  std::vector<WindowTerm> terms;
  const std::size_t stride = std::max<std::size_t>(1, kept_.size() / kEnough);
  for (std::size_t n = 0; n < kept_.size(); n += stride) {
    WindowTerm term;
    term.whitening = kept_[n].term.whitening;
    term.balance.by_joints = kept_[n].term.balance.by_joints;
    term.balance.by_currents = kept_[n].term.balance.by_currents;
    term.residual = residualOf(kept_[n]);
    term.active = kept_[n].term.active;
    terms.push_back(std::move(term));
  }
  const double values = 3.0 * options_.test_functions * static_cast<double>(kept_.size());
  const double share = std::max(0.1, 1.0 - static_cast<double>(free_.size()) / values);
  const double variance = noise_.current * noise_.current;
  factors_ = likelyFactors(terms, variance, share);
  for (LiveWindow& window : kept_) {
    window.whiten(factors_.joints, factors_.currents * variance);
  }
}

/// Linearises what is kept where the estimate is; the squared whitened misfit that the derivatives
/// of before have got wrong.
double LiveMotion::Work::linearizeKept(bool with_covariance) {
  const MotionPoint point(*model_, places_, x_);
  std::vector<double> wrong(kept_.size(), 0.0);
  const auto threads = static_cast<unsigned>(evaluators_.size());
  parallelFor(kept_.size(), threads, [&](unsigned worker, std::size_t n) {
    LiveWindow& window = kept_[n];
    const bool is_first = window.linearizedAt().size() == 0;
    const Eigen::VectorXd expected =
        is_first || with_covariance ? Eigen::VectorXd() : residualOf(window);
    BalanceOrder order;
    order.covariance = with_covariance || is_first;
    window.linearize(point, order, evaluators_[worker]);
    if (order.covariance) {
      window.whiten(factors_.joints, factors_.currents * noise_.current * noise_.current);
    }
    window.linearizeOrientations(*model_, places_, orienting_, x_, noise_.orientation);
    const Eigen::VectorXd residual = residualOf(window);
    wrong[n] = expected.size() == 0 ? residual.squaredNorm() : (residual - expected).squaredNorm();
  });
  double sum = 0.0;
  for (const double one : wrong) {
    sum += one;
  }
  return sum;
}

double LiveMotion::Work::limitFor(std::size_t windows) const {
  const double freedom = 3.0 * options_.test_functions;
  const double probability = estimation_.false_alarm_probability / static_cast<double>(windows);
  return chiSquareLimit(freedom, probability) / freedom;
}

double LiveMotion::Work::scaleOf(const std::vector<double>& squares) const {
  const double freedom = 3.0 * options_.test_functions;
  return std::max(1.0, medianOf(squares) / (chiSquareLimit(freedom, 0.5) / freedom));
}

/// Which windows contradict the others, with the estimate of now.
void LiveMotion::Work::judgeKept() {
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

void LiveMotion::Work::addTo(InformationSum& balance,
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

/// All that is kept and all that was, at the estimate of now.
void LiveMotion::Work::sumUp() {
  anchor_ = x_;
  const Eigen::VectorXd apart = anchor_ - frozen_at_;
  balance_ = frozen_balance_;
  balance_.moveBy(apart);
  orientation_ = frozen_orientation_;
  orientation_.moveBy(apart(orienting_));
  for (const LiveWindow& window : kept_) {
    addTo(balance_, orientation_, window);
  }
}

void LiveMotion::Work::linearizeAnew(bool with_noise) {
  constexpr int kMostRounds = 6;
  if (with_noise) {
    takeNoise();
    next_noise_ = 2 * estimate_.windows;
  }
  for (int round = 0; round < kMostRounds; ++round) {
    const double wrong = linearizeKept(with_noise && round == 0);
    ++estimate_.linearizations;
    if (with_noise && round == 0) {
      findNoise();
    }
    judgeKept();
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
bool LiveMotion::Work::misleads() {
  const LiveWindow& window = kept_[next_probe_ % kept_.size()];
  next_probe_ += 7;
  const MotionPoint point(*model_, places_, x_);
  evaluators_.front().evaluate(window.span(), window.term.window, point, {}, probe_);
  const Eigen::VectorXd residual =
      window.term.whitening.triangularView<Eigen::Lower>() * probe_.residual;
  const double wrong = (residual - residualOf(window)).squaredNorm();
  return wrong * static_cast<double>(kept_.size()) > live_.tolerance * live_.tolerance;
}

/// Whether a window is farther off than its noise and the uncertainty of the estimate allow.
bool LiveMotion::Work::contradicts(const LiveWindow& window) const {
  const Eigen::VectorXd residual = residualOf(window);
  const double limit = scale_ * limitFor(kept_.size()) * static_cast<double>(residual.size());
  if (residual.squaredNorm() <= limit) {
    return false;
  }
  const Eigen::MatrixXd jacobian = window.whitenedJacobian();
  Eigen::MatrixXd spread = jacobian * estimate_.belief.covariance * jacobian.transpose();
  spread.diagonal().array() += 1.0;
  return residual.dot(spread.llt().solve(residual)) > limit;
}

/// A window that just came.
void LiveMotion::Work::take(LiveWindow& window) {
  const MotionPoint point(*model_, places_, x_);
  BalanceOrder order;
  order.covariance = true;
  window.linearize(point, order, evaluators_.front());
  window.whiten(factors_.joints, factors_.currents * noise_.current * noise_.current);
  window.linearizeOrientations(*model_, places_, orienting_, x_, noise_.orientation);
  const Eigen::VectorXd residual = residualOf(window);
  window.term.square = residual.squaredNorm() / static_cast<double>(residual.size());
  window.term.active = !contradicts(window);
  lately_left_out_ += window.term.active ? 0 : 1;
  addTo(balance_, orientation_, window);
}

void LiveMotion::Work::freezeOldest() {
  const LiveWindow& oldest = kept_.front();
  if (estimate_.is_told) {
    std::swap(anchor_, frozen_at_);
    addTo(frozen_balance_, frozen_orientation_, oldest);
    std::swap(anchor_, frozen_at_);
    frozen_serving_ += oldest.term.active ? 1 : 0;
    frozen_duration_ += oldest.term.active ? oldest.duration() : 0.0;
    frozen_orientations_ += oldest.orientations;
  }
  kept_.pop_front();
}

Eigen::MatrixXd LiveMotion::Work::information() const {
  InformationSum sum = balance_;
  sum.addAt(orienting_, orientation_);
  return sum.information();
}

void LiveMotion::Work::solve() {
  const Eigen::MatrixXd told = information();
  const Eigen::MatrixXd all = (told + prior_information_)(free_, free_);
  Eigen::VectorXd slope = balance_.gradient() + prior_information_ * (anchor_ - prior_.x);
  slope(orienting_) += orientation_.gradient();
  const Eigen::LLT<Eigen::MatrixXd> factor(all);
  const Eigen::VectorXd step = factor.solve(slope(free_));
  if (factor.info() != Eigen::Success || !step.allFinite()) {
    return;
  }
  x_ = anchor_;
  x_(free_) -= step;
  const auto count = static_cast<Eigen::Index>(free_.size());
  Eigen::MatrixXd root = Eigen::MatrixXd::Identity(count, count);
  factor.matrixLLT().triangularView<Eigen::Lower>().solveInPlace(root);
  Eigen::MatrixXd inverse = Eigen::MatrixXd::Zero(count, count);
  inverse.selfadjointView<Eigen::Lower>().rankUpdate(root.transpose());
  tell(Eigen::MatrixXd(inverse.selfadjointView<Eigen::Lower>()));
}

double LiveMotion::Work::chiSquare() const {
  const std::size_t serving = estimate_.windows - estimate_.left_out;
  const double freedom = 3.0 * options_.test_functions * static_cast<double>(serving) -
                         static_cast<double>(free_.size());
  InformationSum here = balance_;
  here.moveBy(x_ - anchor_);
  return freedom > 0.0 ? here.squaredMisfit() / freedom : 0.0;
}

/// Reduced, of the tracker's means over the windows that are kept.
double LiveMotion::Work::orientationChiSquare() const {
  const Eigen::VectorXd x = x_(orienting_);
  double squares = 0.0;
  double freedom = -static_cast<double>(model_->space().pole(0));
  for (const LiveWindow& window : kept_) {
    squares += window.meanSquare(x);
    freedom += window.orientations > 0 ? 3.0 : 0.0;
  }
  return freedom > 2.0 ? squares / freedom : 0.0;
}

void LiveMotion::Work::countServing() {
  estimate_.duration = frozen_duration_;
  estimate_.orientations = frozen_orientations_;
  std::size_t serving = frozen_serving_;
  for (const LiveWindow& window : kept_) {
    estimate_.duration += window.term.active ? window.duration() : 0.0;
    estimate_.orientations += window.orientations;
    serving += window.term.active ? 1 : 0;
  }
  estimate_.left_out = estimate_.windows - serving;
}

/// What is known now, with noise as large as both kinds of residuals say. `inverse`: of the
/// information of what is free.
void LiveMotion::Work::tell(const Eigen::MatrixXd& inverse) {
  constexpr double kSignificance = 1e-3;
  countServing();
  estimate_.chi_square = chiSquare();
  const double freedom =
      3.0 * options_.test_functions * static_cast<double>(estimate_.windows - estimate_.left_out);
  const bool is_misfit = estimate_.chi_square * freedom > chiSquareLimit(freedom, kSignificance);
  const double windows = is_misfit ? estimate_.chi_square : 1.0;
  const double orientations = std::max(1.0, orientationChiSquare());
  Eigen::MatrixXd own = windows * inverse;
  Eigen::MatrixXd by_orientations =
      Eigen::MatrixXd::Zero(inverse.rows(), orientation_.gradient().size());
  for (std::size_t n = 0; n < orienting_.size(); ++n) {
    const auto place = std::lower_bound(free_.begin(), free_.end(), orienting_[n]);
    if (place != free_.end() && *place == orienting_[n]) {
      by_orientations.col(static_cast<Eigen::Index>(n)) = inverse.col(place - free_.begin());
    }
  }
  own += (orientations - windows) *
         (by_orientations * orientation_.information() * by_orientations.transpose());
  ParameterBelief& belief = estimate_.belief;
  belief.x = x_;
  belief.covariance = prior_.covariance;
  for (const Eigen::Index p : free_) {
    belief.covariance.row(p).setZero();
    belief.covariance.col(p).setZero();
  }
  if (!holds_uncertain_) {
    belief.covariance(free_, free_) = own;
    return;
  }
  // What is held is as uncertain as before, and what is estimated because of it, too.
  Eigen::MatrixXd others = information()(free_, Eigen::all);
  others(Eigen::all, free_).setZero();
  const Eigen::MatrixXd gain = -inverse * others;
  const Eigen::MatrixXd with_held = gain * belief.covariance;
  belief.covariance(free_, Eigen::all) += with_held;
  belief.covariance(Eigen::all, free_) += with_held.transpose();
  belief.covariance(free_, free_) = own + with_held * gain.transpose();
}

void LiveMotion::Work::add(MotionSlice slice) {
  constexpr std::size_t kProbeEvery = 8;
  // So many that contradict an estimate put it into doubt.
  constexpr std::size_t kManyLeftOut = 8;
  ++estimate_.windows;
  kept_.emplace_back(std::move(slice));
  if (kept_.size() > live_.kept_windows) {
    freezeOldest();
  }
  if (!estimate_.is_told) {
    if (estimate_.windows >= next_begin_) {
      begin();
    }
    return;
  }
  take(kept_.back());
  solve();
  if (estimate_.windows >= next_noise_) {
    linearizeAnew(true);
  } else if (lately_left_out_ >= kManyLeftOut ||
             (estimate_.windows % kProbeEvery == 0 && misleads())) {
    linearizeAnew(false);
  }
}

LiveMotion::LiveMotion(const CalibrationModel& model,
                       ParameterBelief prior,
                       std::vector<Eigen::Index> free,
                       const EstimationOptions& estimation,
                       const MotionOptions& options,
                       const LiveMotionOptions& live)
    : work_(std::make_unique<Work>(
          model, std::move(prior), std::move(free), estimation, options, live)) {}

LiveMotion::LiveMotion(LiveMotion&& other) noexcept = default;
LiveMotion& LiveMotion::operator=(LiveMotion&& other) noexcept = default;
LiveMotion::~LiveMotion() = default;

void LiveMotion::add(MotionSlice slice) {
  work_->add(std::move(slice));
}

const LiveEstimate& LiveMotion::estimate() const {
  return work_->estimate();
}

}  // namespace sac
