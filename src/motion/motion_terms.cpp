#include "motion_terms.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <thread>
#include <utility>

#include <Eigen/Cholesky>

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

/// Those of slices, or cut.
std::vector<MotionWindow> windowsOf(const MotionRecording& recording,
                                    const std::vector<MotionSpan>& spans,
                                    const MotionOptions& options,
                                    std::vector<WindowsLeftOut>& left_out) {
  if (recording.windows.empty()) {
    return cutWindows(spans, options, left_out);
  }
  std::vector<MotionWindow> windows;
  for (std::size_t s = 0; s < spans.size(); ++s) {
    windows.push_back({s, recording.windows[s].first, recording.windows[s].last});
  }
  return windows;
}

/// What the orientations of a window tell together.
struct OrientationSum {
  Eigen::MatrixXd jacobian;
  Eigen::VectorXd residual;
  double count = 0.0;

  void add(const Eigen::MatrixXd& one_jacobian, const Eigen::Vector3d& one_residual) {
    if (count == 0.0) {
      jacobian.setZero(3, one_jacobian.cols());
      residual.setZero(3);
    }
    jacobian += one_jacobian;
    residual += one_residual;
    count += 1.0;
  }
};

}  // namespace

Eigen::MatrixXd whiteningOfMany(const Eigen::MatrixXd& covariance) {
  const Eigen::MatrixXd lower = covariance.llt().matrixL();
  return lower.triangularView<Eigen::Lower>().solve(
      Eigen::MatrixXd::Identity(covariance.rows(), covariance.cols()));
}

double robustWeight(double s) {
  constexpr double kTransition = 4.0;
  return s <= kTransition ? 1.0 : std::sqrt(kTransition / s);
}

std::vector<Eigen::Index> orientingCoordinates(const ParameterSpace& space,
                                               const MotionPlaces& places) {
  std::vector<Eigen::Index> coordinates;
  for (Eigen::Index p = 0; p < space.pole(0); ++p) {
    coordinates.push_back(p);
  }
  for (const PlacedEffect& placed : space.effects().effects()) {
    const bool turns = placed.acts_on == LaboratoryEffect::ActsOn::kOrientations ||
                       placed.acts_on == LaboratoryEffect::ActsOn::kEverything;
    const Eigen::Index first = space.effect() + placed.first;
    for (Eigen::Index n = 0; n < placed.size(); ++n) {
      if (turns || first + n == places.tracker_delay) {
        coordinates.push_back(first + n);
      }
    }
  }
  return coordinates;
}

MotionTerms::MotionTerms(const MotionProblem& problem, const MotionOptions& options)
    : problem_(problem),
      options_(options),
      places_(problem.model->space()),
      spans_(spansOf(*problem.recording)),
      noise_(noiseOf(spans_, *problem.model, problem.prior.x)),
      evaluators_(std::max(1U, std::thread::hardware_concurrency()),
                  BalanceEvaluator(options, noise_.joint)) {
  for (const MotionWindow& window : windowsOf(*problem.recording, spans_, options, left_out_)) {
    WindowTerm term;
    term.window = window;
    windows_.push_back(std::move(term));
  }
  for (std::size_t s = 0; s < spans_.size(); ++s) {
    for (std::size_t n = 0; n < spans_[s].orientation_times.size(); ++n) {
      OrientationTerm term;
      term.span = s;
      term.index = n;
      orientations_.push_back(term);
    }
  }
  holdOut();
  orienting_ = orientingCoordinates(problem.model->space(), places_);
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

void MotionTerms::setScales(double windows, double orientations) {
  window_scale_ = windows;
  orientation_scale_ = orientations;
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
  }
}

void MotionTerms::linearize(const Eigen::VectorXd& x, const TermOrder& order) {
  linearized_at_ = x;
  every_ = order.every;
  linearizeWindows(order);
  if (order.orientations) {
    linearizeOrientations();
  }
}

void MotionTerms::linearizeWindows(const TermOrder& order) {
  const MotionPoint point(*problem_.model, places_, linearized_at_);
  const std::size_t count = (windows_.size() + every_ - 1) / every_;
  const auto threads = static_cast<unsigned>(evaluators_.size());
  parallelFor(count, threads, [&](unsigned worker, std::size_t n) {
    WindowTerm& term = windows_[n * every_];
    BalanceOrder balance = order.balance;
    balance.covariance = balance.covariance || term.whitening.size() == 0;
    const MotionSpan& span = spans_[term.window.span];
    evaluators_[worker].evaluate(span, term.window, point, balance, term.balance);
    if (balance.covariance) {
      term.whitening = whiteningFor(term.balance);
    }
  });
}

InformationSum MotionTerms::balance(const Eigen::VectorXd& x) {
  InformationSum sum(x.size());
  const Eigen::VectorXd apart = x - linearized_at_;
  Eigen::MatrixXd jacobian;
  for (std::size_t n = 0; n < windows_.size(); n += every_) {
    WindowTerm& term = windows_[n];
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

void MotionTerms::linearizeOrientations() {
  constexpr std::size_t kAtOnce = 200;
  const std::size_t count = orientations_.size();
  orientation_jacobians_.resize(static_cast<Eigen::Index>(orienting_.size()),
                                3 * static_cast<Eigen::Index>(count));
  const double whitening = 1.0 / noise_.orientation;
  const auto threads = static_cast<unsigned>(evaluators_.size());
  parallelFor((count + kAtOnce - 1) / kAtOnce, threads, [&](unsigned, std::size_t part) {
    TrackerTerm tracker(*problem_.model, places_, linearized_at_);
    for (std::size_t n = part * kAtOnce; n < std::min(count, (part + 1) * kAtOnce); ++n) {
      OrientationTerm& term = orientations_[n];
      term.is_known = tracker.evaluate(spans_[term.span], term.index);
      if (!term.is_known) {
        continue;
      }
      term.time = tracker.time();
      term.linearized = whitening * tracker.residual();
      auto columns = orientation_jacobians_.middleCols<3>(3 * static_cast<Eigen::Index>(n));
      for (std::size_t c = 0; c < orienting_.size(); ++c) {
        columns.row(static_cast<Eigen::Index>(c)) =
            whitening * tracker.jacobian().col(orienting_[c]).transpose();
      }
    }
  });
}

void MotionTerms::moveOrientations(const Eigen::VectorXd& x) {
  const Eigen::VectorXd moved = x - linearized_at_;
  const Eigen::VectorXd apart = moved(orienting_);
  for (std::size_t n = 0; n < orientations_.size(); ++n) {
    OrientationTerm& term = orientations_[n];
    if (term.is_known) {
      term.residual = term.linearized + orientationJacobian(n) * apart;
      term.square = term.residual.squaredNorm() / 3.0;
    }
  }
}

InformationSum MotionTerms::orientation(const Eigen::VectorXd& x) {
  moveOrientations(x);
  InformationSum orienting(static_cast<Eigen::Index>(orienting_.size()));
  for (std::size_t n = 0; n < orientations_.size(); ++n) {
    const OrientationTerm& term = orientations_[n];
    if (term.serves()) {
      orienting.addDense(
          orientationJacobian(n), term.residual, robustWeight(term.square / orientation_scale_));
    }
  }
  InformationSum sum(x.size());
  sum.addAt(orienting_, orienting);
  return sum;
}

/// Every so manieth window, and the orientations within it.
void MotionTerms::holdOut() {
  const std::size_t every = options_.hold_out_every;
  if (every < 2 || windows_.size() < options_.least_windows_to_hold_out) {
    return;
  }
  for (std::size_t n = every / 2; n < windows_.size(); n += every) {
    windows_[n].held_out = true;
    const JointTrack& track = spans_[windows_[n].window.span].track;
    const double begin = track.time(windows_[n].window.first);
    const double end = track.time(windows_[n].window.last);
    for (OrientationTerm& term : orientations_) {
      const double time = spans_[term.span].orientation_times[term.index];
      if (term.span == windows_[n].window.span && time >= begin && time <= end) {
        term.held_out = true;
        term.window = n;
      }
    }
  }
}

bool MotionTerms::holdsOut() const {
  return std::any_of(
      windows_.begin(), windows_.end(), [](const WindowTerm& term) { return term.held_out; });
}

void MotionTerms::admitHeldOut() {
  for (WindowTerm& term : windows_) {
    term.held_out = false;
  }
  for (OrientationTerm& term : orientations_) {
    term.held_out = false;
  }
}

InformationSum MotionTerms::heldOut(const Eigen::VectorXd& x, std::size_t& values) {
  InformationSum sum(x.size());
  values = 0;
  const auto add = [&](const Eigen::MatrixXd& jacobian, const Eigen::VectorXd& residual) {
    sum.addDense(jacobian, residual);
    values += static_cast<std::size_t>(residual.size());
  };
  const Eigen::VectorXd apart = x - linearized_at_;
  moveOrientations(x);
  std::map<std::size_t, OrientationSum> means;
  for (std::size_t n = 0; n < orientations_.size(); ++n) {
    const OrientationTerm& term = orientations_[n];
    if (term.held_out && term.active && term.is_known) {
      means[term.window].add(orientationJacobian(n), term.residual);
    }
  }
  for (std::size_t n = 0; n < windows_.size(); ++n) {
    const WindowTerm& term = windows_[n];
    if (!term.held_out || !term.active) {
      continue;
    }
    const auto whitening = term.whitening.triangularView<Eigen::Lower>();
    add(whitening * term.balance.jacobian,
        whitening * (term.balance.residual + term.balance.jacobian * apart));
    const auto mean = means.find(n);
    if (mean != means.end()) {
      Eigen::MatrixXd all = Eigen::MatrixXd::Zero(3, x.size());
      all(Eigen::all, orienting_) = mean->second.jacobian / std::sqrt(mean->second.count);
      add(all, mean->second.residual / std::sqrt(mean->second.count));
    }
  }
  return sum;
}

}  // namespace sac
