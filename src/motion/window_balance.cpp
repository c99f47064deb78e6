#include "window_balance.hpp"

#include <algorithm>
#include <cmath>

#include "interval_momentum.hpp"
#include "node_currents.hpp"
#include "spherical_actuator_calibration/base/rotations.hpp"

namespace sac {
namespace {

// Rows of the sum over intervals, behind those of what turns the rotor.
constexpr Eigen::Index kInertia = 0;
constexpr Eigen::Index kViscous = 18;
constexpr Eigen::Index kCoulomb = 21;
constexpr Eigen::Index kResidual = 24;
constexpr Eigen::Index kBehind = 27;

}  // namespace

void BalanceEvaluator::ColumnSum::start(Eigen::Index rows, Eigen::Index functions) {
  sum_.setZero(rows, functions);
  batch_.setZero(rows, kBatch);
  factors_.resize(kBatch, functions);
  batched_ = 0;
}

void BalanceEvaluator::ColumnSum::next() {
  if (++batched_ == kBatch) {
    flush();
  }
}

void BalanceEvaluator::ColumnSum::flush() {
  sum_.noalias() += batch_.leftCols(batched_) * factors_.topRows(batched_);
  batched_ = 0;
}

Eigen::MatrixXd& BalanceEvaluator::ColumnSum::result() {
  flush();
  return sum_;
}

void BalanceEvaluator::start(const MotionSpan& span,
                             const MotionWindow& window,
                             const MotionPoint& point,
                             const WindowPart& part) {
  window_ = window;
  count_ = options_.test_functions;
  turning_ = 3 * static_cast<Eigen::Index>(point.turning().size());
  const std::size_t readings = window.last - window.first + 3;
  turned_.resize(readings);
  const TestFunctions functions(
      span.track.time(window.first), span.track.time(window.last), options_.test_functions);
  lengths_.resize(readings - 1);
  for (std::size_t n = 0; n + 1 < readings; ++n) {
    const std::size_t reading = window.first - 1 + n;
    lengths_[n] = span.track.time(reading + 1) - span.track.time(reading);
  }
  middle_.resize(readings - 1);
  bends_.resize(readings - 1);
  // Of those around its intervals alone a part asks.
  const std::size_t reach = std::max<std::size_t>(span.track.rateReach(), 1);
  const std::size_t begin = beginOf(readings - 1, part);
  const std::size_t end = endOf(readings - 1, part) + reach + 1;
  for (std::size_t n = 0; n < readings; ++n) {
    const std::size_t reading = window.first - 1 + n;
    if (n + reach < begin || n >= end) {
      continue;
    }
    point.turn(span.track.reading(reading), turned_[n]);
    if (n == 0 || n + 2 >= readings) {
      continue;
    }
    const double middle = 0.5 * (span.track.time(reading) + span.track.time(reading + 1));
    functions.evaluate(middle, middle_[n]);
    functions.evaluate(middle, bends_[n]);
  }
  // Outside of the window the functions are zero.
  for (const std::size_t outside : {std::size_t{0}, readings - 2}) {
    middle_[outside] = {Eigen::VectorXd::Zero(count_), Eigen::VectorXd::Zero(count_)};
    bends_[outside] = {Eigen::VectorXd::Zero(count_), Eigen::VectorXd::Zero(count_)};
  }
  momentum_.start(turning_ + kBehind, count_);
  impulse_.start(3 * point.space().size() + 3, count_);
  delay_.setZero(3, count_);
  if (wants_noise_) {
    noise_.setZero(3 * count_, 3 * static_cast<Eigen::Index>(readings + 2));
    current_noise_.start(9, count_ * (count_ + 1) / 2);
  }
}

/// Of h³/12 ω̇ at a place within the window: what the turn of a neighbour, that long, counts there.
double BalanceEvaluator::neighbourShare(std::size_t place, double neighbour) const {
  const double h = lengths_[place];
  const double apart = 0.5 * (lengths_[place - 1] + 2.0 * h + lengths_[place + 1]);
  return h * h * h / (12.0 * apart * neighbour);
}

/// Of M = −Σ factor A Δ: −∫φ̇ L dt is −Σ (mean of φ̇) A Δ − Σ φ̈ A ω̇ h³/12, with ω̇ from the turns of
/// both neighbours, which may be longer or shorter. Outside of the window φ̈ is zero.
void BalanceEvaluator::setMomentumFactors(std::size_t place) {
  const double h = lengths_[place];
  factor_ = middle_[place].first + (h * h / 24.0) * bends_[place].third;
  if (place > 1) {
    factor_ += neighbourShare(place - 1, h) * bends_[place - 1].second;
  }
  if (place + 2 < middle_.size()) {
    factor_ -= neighbourShare(place + 1, h) * bends_[place + 1].second;
  }
}

/// Of dry friction, by the rate over a few readings around an interval: less noisy than that of the
/// interval alone.
BalanceEvaluator::Fading BalanceEvaluator::fadingAt(const JointTrack& track,
                                                    std::size_t place) const {
  const std::size_t reach = track.rateReach();
  Fading fading;
  fading.first = place - std::min(place, reach);
  fading.last = std::min(turned_.size() - 1, place + 1 + reach);
  const std::size_t origin = window_.first - 1;
  const double per_time =
      1.0 / (track.time(origin + fading.last) - track.time(origin + fading.first));
  const Eigen::Matrix3d& before = turned_[fading.first].R_stator_rotor;
  const Eigen::Matrix3d& after = turned_[fading.last].R_stator_rotor;
  const Eigen::Vector3d rate = per_time * rotationLog(after * before.transpose());
  fading.value = 1.0 / std::hypot(rate.norm(), options_.friction_speed);
  // What turns about the axis of the turn adds to its angle.
  const double cube = fading.value * fading.value * fading.value;
  fading.d_turn = (-cube * per_time) * rate.transpose();
  return fading;
}

void BalanceEvaluator::addInterval(const MotionSpan& span,
                                   const MotionPoint& point,
                                   std::size_t place) {
  const TurnedRotor& before = turned_[place];
  const TurnedRotor& after = turned_[place + 1];
  setMomentumFactors(place);
  const IntervalMomentum interval(before.R_stator_rotor, after.R_stator_rotor, point.inertia());
  const Fading fading = fadingAt(span.track, place);
  const double friction = point.viscous() + point.coulomb() * fading.value;
  const MotionPlaces& places = point.places();
  // Products of three by three and three by some: too small for the general way.
  const auto turning_of = [this](auto column) {
    return Eigen::Map<Eigen::Matrix3Xd>(column.data(), 3, turning_ / 3);
  };
  auto momentum = momentum_.column();
  turning_of(momentum) = interval.momentum_after.lazyProduct(after.d_x) +
                         interval.momentum_before.lazyProduct(before.d_x);
  if (places.inertia >= 0) {
    Eigen::Map<Eigen::Matrix<double, 3, 6>>(momentum.data() + turning_ + kInertia) =
        point.scaleAt(places.inertia) * interval.d_inertia;
  }
  momentum.segment<6>(turning_ + kViscous).setZero();
  momentum.segment<3>(turning_ + kResidual) = interval.momentum;
  momentum_.factors() = -factor_.transpose();
  momentum_.next();

  const Eigen::Matrix3d by_after = friction * interval.turn_after;
  const Eigen::Matrix3d by_before = friction * interval.turn_before;
  const Eigen::Matrix3d by_fading = point.coulomb() * interval.turn * fading.d_turn;
  auto braking = momentum_.column();
  turning_of(braking) = by_after.lazyProduct(after.d_x) + by_before.lazyProduct(before.d_x) +
                        by_fading.lazyProduct(turned_[fading.last].d_x) -
                        by_fading.lazyProduct(turned_[fading.first].d_x);
  braking.segment<18>(turning_ + kInertia).setZero();
  if (places.viscous >= 0) {
    braking.segment<3>(turning_ + kViscous) = point.scaleAt(places.viscous) * interval.turn;
  }
  if (places.coulomb >= 0) {
    braking.segment<3>(turning_ + kCoulomb) =
        (point.scaleAt(places.coulomb) * fading.value) * interval.turn;
  }
  braking.segment<3>(turning_ + kResidual) = friction * interval.turn;
  momentum_.factors() = middle_[place].value.transpose();
  momentum_.next();
  if (!wants_noise_) {
    return;
  }
  const auto n = 3 * static_cast<Eigen::Index>(place);
  const Eigen::Matrix3d momentum_after = interval.momentum_after * after.d_reading;
  const Eigen::Matrix3d momentum_before = interval.momentum_before * before.d_reading;
  const Eigen::Matrix3d braking_after = by_after * after.d_reading;
  const Eigen::Matrix3d braking_before = by_before * before.d_reading;
  for (Eigen::Index k = 0; k < count_; ++k) {
    const double c = -factor_[k];
    const double f = middle_[place].value[k];
    noise_.block<3, 3>(3 * k, n + 6) += c * momentum_after + f * braking_after;
    noise_.block<3, 3>(3 * k, n + 3) += c * momentum_before + f * braking_before;
  }
}

/// P: the integrand and its slope vanish at both ends, so that the plain sum is of fourth order.
void BalanceEvaluator::addImpulse(const MotionSpan& span,
                                  const MotionPoint& point,
                                  const BalanceOrder& order,
                                  const WindowPart& part) {
  const std::size_t every = order.at_nodes ? nodeStride(span) : 1;
  thinning_ = static_cast<double>(std::max(order.stride, every));
  if (every > 1) {
    addNodes(span, point, part, every);
    return;
  }
  const TestFunctions functions(
      span.track.time(window_.first), span.track.time(window_.last), options_.test_functions);
  const auto& all = span.streams->currents;
  const auto step = static_cast<Eigen::Index>(order.stride);
  const auto at = [&](Eigen::Index row) { return all.row(row).transpose().cast<double>(); };
  current_.resize(all.cols());
  bend_.resize(all.cols());
  const auto add = [&](const CurrentReading& now) {
    const auto row = static_cast<Eigen::Index>(now.row);
    bend_ = 2.0 / (now.before + now.after) *
            ((at(row + step) - at(row)) / now.after - (at(row) - at(row - step)) / now.before);
    current_ = at(row) + point.currentDispersion() * bend_;
    functions.evaluate(now.time, test_);
    addCurrents(now.track, point, now.step());
  };
  visitCurrents(span, window_, point.currentDelay(), order.stride, part, add);
}

/// The same by the currents of `every` readings at a time.
void BalanceEvaluator::addNodes(const MotionSpan& span,
                                const MotionPoint& point,
                                const WindowPart& part,
                                std::size_t every) {
  const TestFunctions functions(
      span.track.time(window_.first), span.track.time(window_.last), options_.test_functions);
  const CurrentRange range(span, window_, point.currentDelay(), 1);
  const std::size_t first = (range.first + every - 1) / every;
  const std::size_t count = range.size() == 0 ? 0 : (range.last + every - 1) / every - first;
  NodeCurrents nodes(span, every);
  for (std::size_t n = beginOf(count, part); n < endOf(count, part); ++n) {
    const std::size_t row = (first + n) * every;
    const double time = span.current_times[row] - point.currentDelay();
    // Positions of the readings between nodes count, too.
    const auto track = span.track.smoothAt(time, nodes.reach());
    if (!track) {
      continue;
    }
    nodes.gather(row, range.first, range.last);
    bend_ = nodes.bend();
    current_ = nodes.current() + point.currentDispersion() * bend_;
    functions.evaluate(time, test_);
    addCurrents(*track, point, nodes.step());
  }
}

void BalanceEvaluator::addCurrents(const TrackPoint& track, const MotionPoint& point, double step) {
  point.turn(track.position, between_);
  point.torque(between_.R_stator_rotor, current_, torque_);
  for (std::size_t t = 0; t < point.turning().size(); ++t) {
    torque_.d_x.col(point.turning()[t]) +=
        torque_.d_turn * between_.d_x.col(static_cast<Eigen::Index>(t));
  }
  const MotionPlaces& places = point.places();
  if (places.current_dispersion >= 0) {
    torque_.d_x.col(places.current_dispersion) =
        point.scaleAt(places.current_dispersion) * (torque_.d_coil * bend_);
  }
  if (places.current_delay >= 0) {
    const double scale = step * point.scaleAt(places.current_delay);
    const Eigen::Vector3d torque = scale * torque_.torque;
    const Eigen::Vector3d rate = scale * (torque_.d_turn * (between_.d_reading * track.velocity));
    delay_ +=
        torque.lazyProduct(test_.first.transpose()) + rate.lazyProduct(test_.value.transpose());
  }
  const Eigen::Index rows = torque_.d_x.size();
  auto column = impulse_.column();
  column.head(rows) = Eigen::Map<const Eigen::VectorXd>(torque_.d_x.data(), rows);
  column.tail<3>() = torque_.torque;
  impulse_.factors() = -step * test_.value.transpose();
  impulse_.next();
  if (wants_noise_) {
    addNoise(track, step);
  }
}

void BalanceEvaluator::addNoise(const TrackPoint& track, double step) {
  const Eigen::Matrix3d by_reading = torque_.d_turn * between_.d_reading;
  for (std::size_t m = 0; m < track.count; ++m) {
    const std::size_t reading = track.first + m;
    if (reading + 2 < window_.first || reading > window_.last + 2) {
      continue;
    }
    const auto n = 3 * static_cast<Eigen::Index>(reading + 2 - window_.first);
    const Eigen::Matrix3d share = (step * track.share[m]) * by_reading;
    for (Eigen::Index k = 0; k < count_; ++k) {
      noise_.block<3, 3>(3 * k, n) -= test_.value[k] * share;
    }
  }
  const Eigen::Matrix3d squares =
      (step * step / thinning_) * torque_.d_coil.lazyProduct(torque_.d_coil.transpose());
  current_noise_.column() = Eigen::Map<const Eigen::VectorXd>(squares.data(), squares.size());
  auto factors = current_noise_.factors();
  for (Eigen::Index l = 0, n = 0; l < count_; n += count_ - l, ++l) {
    factors.segment(n, count_ - l) = test_.value[l] * test_.value.tail(count_ - l).transpose();
  }
  current_noise_.next();
}

void BalanceEvaluator::conclude(const MotionPoint& point, WindowBalance& out) {
  const Eigen::Index size = point.space().size();
  const MotionPlaces& places = point.places();
  const Eigen::MatrixXd& momentum = momentum_.result();
  Eigen::MatrixXd& sum = impulse_.result();
  const auto add = [&](Eigen::Index coordinate, Eigen::Index row) {
    sum.middleRows<3>(3 * coordinate) += momentum.middleRows<3>(row);
  };
  for (Eigen::Index t = 0; t < turning_ / 3; ++t) {
    add(point.turning()[static_cast<std::size_t>(t)], 3 * t);
  }
  for (Eigen::Index n = 0; places.inertia >= 0 && n < 6; ++n) {
    add(places.inertia + n, turning_ + kInertia + 3 * n);
  }
  if (places.viscous >= 0) {
    add(places.viscous, turning_ + kViscous);
  }
  if (places.coulomb >= 0) {
    add(places.coulomb, turning_ + kCoulomb);
  }
  if (places.current_delay >= 0) {
    sum.middleRows<3>(3 * places.current_delay) += delay_;
  }
  add(size, turning_ + kResidual);
  out.residual.resize(3 * count_);
  out.jacobian.resize(3 * count_, size);
  for (Eigen::Index k = 0; k < count_; ++k) {
    out.jacobian.middleRows<3>(3 * k) =
        Eigen::Map<const Eigen::Matrix3Xd>(sum.col(k).data(), 3, size);
    out.residual.segment<3>(3 * k) = sum.col(k).tail<3>();
  }
  if (wants_noise_) {
    finishNoise(out);
  }
}

void BalanceEvaluator::finishNoise(WindowBalance& out) {
  for (Eigen::Index n = 0; n < noise_.cols(); ++n) {
    noise_.col(n) *= joint_stddev_[n % 3];
  }
  Eigen::MatrixXd lower = Eigen::MatrixXd::Zero(3 * count_, 3 * count_);
  lower.selfadjointView<Eigen::Lower>().rankUpdate(noise_);
  out.by_joints = lower.selfadjointView<Eigen::Lower>();
  const Eigen::MatrixXd& by_currents = current_noise_.result();
  for (Eigen::Index l = 0, n = 0; l < count_; ++l) {
    for (Eigen::Index k = l; k < count_; ++k, ++n) {
      lower.block<3, 3>(3 * k, 3 * l) =
          Eigen::Map<const Eigen::Matrix3d>(by_currents.col(n).data());
    }
  }
  out.by_currents = lower.selfadjointView<Eigen::Lower>();
}

void BalanceEvaluator::sumUp(const MotionSpan& span,
                             const MotionWindow& window,
                             const MotionPoint& point,
                             const BalanceOrder& order,
                             const WindowPart& part) {
  wants_noise_ = order.covariance;
  start(span, window, point, part);
  const std::size_t intervals = turned_.size() - 1;
  for (std::size_t n = beginOf(intervals, part); n < endOf(intervals, part); ++n) {
    addInterval(span, point, n);
  }
  addImpulse(span, point, order, part);
}

void BalanceEvaluator::add(BalanceEvaluator& other) {
  momentum_.add(other.momentum_);
  impulse_.add(other.impulse_);
  delay_ += other.delay_;
  if (wants_noise_) {
    noise_ += other.noise_;
    current_noise_.add(other.current_noise_);
  }
}

void BalanceEvaluator::evaluate(const MotionSpan& span,
                                const MotionWindow& window,
                                const MotionPoint& point,
                                const BalanceOrder& order,
                                WindowBalance& out) {
  sumUp(span, window, point, order, {});
  conclude(point, out);
}

}  // namespace sac
