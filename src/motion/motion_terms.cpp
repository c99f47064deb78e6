#include "motion_terms.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Cholesky>

namespace sac {
namespace {

/// Weight of a misfit whose square over its scale is s: beyond twice the scale it counts linearly
/// (Huber).
double weightOf(double s) {
  constexpr double kTransition = 4.0;
  return s <= kTransition ? 1.0 : std::sqrt(kTransition / s);
}

std::vector<MotionSpan> spansOf(const MotionRecording& recording) {
  std::vector<MotionSpan> spans;
  spans.reserve(recording.spans.size());
  for (const MotionStreams& streams : recording.spans) {
    spans.emplace_back(streams);
  }
  return spans;
}

void startSum(Eigen::Index size, TermSum& sum) {
  sum.information.setZero(size, size);
  sum.gradient.setZero(size);
}

}  // namespace

Eigen::MatrixXd whiteningOfMany(const Eigen::MatrixXd& covariance) {
  const Eigen::MatrixXd lower = covariance.llt().matrixL();
  return lower.triangularView<Eigen::Lower>().solve(
      Eigen::MatrixXd::Identity(covariance.rows(), covariance.cols()));
}

MotionTerms::MotionTerms(const MotionProblem& problem, const MotionOptions& options)
    : problem_(problem),
      options_(options),
      places_(problem.model->space()),
      spans_(spansOf(*problem.recording)),
      noise_(noiseOf(spans_, *problem.model, problem.prior.x)),
      evaluator_(options, noise_.joint) {
  for (const MotionWindow& window : cutWindows(spans_, options, left_out_)) {
    windows_.push_back({window, {}, {}, {}, {}, 0.0, true});
  }
  for (std::size_t s = 0; s < spans_.size(); ++s) {
    for (std::size_t n = 0; n < spans_[s].orientation_times.size(); ++n) {
      OrientationTerm term;
      term.span = s;
      term.index = n;
      orientations_.push_back(term);
    }
  }
  const ParameterSpace& space = problem.model->space();
  for (Eigen::Index p = 0; p < space.size(); ++p) {
    if (p < space.pole(0) || p >= space.effect()) {
      orienting_.push_back(p);
    }
  }
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

void MotionTerms::setNoiseFactors(double joints, double currents) {
  joint_factor_ = joints;
  current_factor_ = currents;
  const double variance = currents * noise_.current * noise_.current;
  for (WindowTerm& term : windows_) {
    if (term.by_joints.size() > 0) {
      term.whitening = whiteningOfMany(joints * term.by_joints + variance * term.by_currents);
    }
  }
}

void MotionTerms::addWindow(const MotionPoint& point,
                            const TermOrder& order,
                            WindowTerm& term,
                            TermSum& sum) {
  BalanceOrder balance = order.balance;
  balance.covariance = balance.covariance || term.whitening.size() == 0;
  evaluator_.evaluate(spans_[term.window.span], term.window, point, balance, balance_);
  if (balance.covariance) {
    term.by_joints = balance_.by_joints;
    term.by_currents = balance_.by_currents;
    term.whitening =
        whiteningOfMany(joint_factor_ * term.by_joints +
                        current_factor_ * noise_.current * noise_.current * term.by_currents);
  }
  term.residual = term.whitening * balance_.residual;
  term.square = term.residual.squaredNorm() / static_cast<double>(valuesPerWindow());
  if (!term.active) {
    return;
  }
  const double weight = weightOf(term.square / window_scale_);
  const Eigen::MatrixXd jacobian =
      term.whitening.triangularView<Eigen::Lower>() * balance_.jacobian;
  sum.information.selfadjointView<Eigen::Lower>().rankUpdate(jacobian.transpose(), weight);
  sum.gradient.noalias() += weight * (jacobian.transpose() * term.residual);
  sum.misfit += weight * term.residual.squaredNorm();
}

TermSum MotionTerms::balance(const Eigen::VectorXd& x, const TermOrder& order) {
  TermSum sum;
  startSum(x.size(), sum);
  const MotionPoint point(*problem_.model, places_, x);
  for (std::size_t n = 0; n < windows_.size(); n += order.every) {
    addWindow(point, order, windows_[n], sum);
  }
  sum.information = Eigen::MatrixXd(sum.information.selfadjointView<Eigen::Lower>());
  return sum;
}

TermSum MotionTerms::orientation(const Eigen::VectorXd& x, const TermOrder& order) {
  TermSum sum;
  startSum(x.size(), sum);
  TrackerTerm tracker(*problem_.model, places_, x);
  const auto count = static_cast<Eigen::Index>(orienting_.size());
  Eigen::MatrixXd information = Eigen::MatrixXd::Zero(count, count);
  Eigen::VectorXd gradient = Eigen::VectorXd::Zero(count);
  Eigen::Matrix<double, 3, Eigen::Dynamic> jacobian(3, count);
  const double whitening = 1.0 / noise_.orientation;
  for (std::size_t n = 0; n < orientations_.size(); n += order.every) {
    OrientationTerm& term = orientations_[n];
    term.is_known = tracker.evaluate(spans_[term.span], term.index);
    if (!term.is_known) {
      continue;
    }
    term.time = tracker.time();
    term.residual = whitening * tracker.residual();
    term.square = term.residual.squaredNorm() / 3.0;
    if (!term.active) {
      continue;
    }
    const double weight = weightOf(term.square / orientation_scale_);
    for (Eigen::Index c = 0; c < count; ++c) {
      jacobian.col(c) = whitening * tracker.jacobian().col(orienting_[static_cast<std::size_t>(c)]);
    }
    information.selfadjointView<Eigen::Lower>().rankUpdate(jacobian.transpose(), weight);
    gradient.noalias() += weight * (jacobian.transpose() * term.residual);
    sum.misfit += weight * term.residual.squaredNorm();
  }
  sum.information(orienting_, orienting_) =
      Eigen::MatrixXd(information.selfadjointView<Eigen::Lower>());
  sum.gradient(orienting_) = gradient;
  return sum;
}

}  // namespace sac
