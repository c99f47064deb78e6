#include "window_balance.hpp"

#include <algorithm>
#include <cmath>

#include "spherical_actuator_calibration/base/rotations.hpp"

namespace sac {
namespace {

constexpr Eigen::Index kBatch = 16;

/// ∂(J u)/∂(xx, yy, zz, xy, xz, yz) of a symmetric J.
Eigen::Matrix<double, 3, 6> inertiaColumns(const Eigen::Vector3d& u) {
  Eigen::Matrix<double, 3, 6> columns;
  columns << u[0], 0.0, 0.0, u[1], u[2], 0.0,  //
      0.0, u[1], 0.0, u[0], 0.0, u[2],         //
      0.0, 0.0, u[2], 0.0, u[0], u[1];
  return columns;
}

/// The momentum of an interval, and how it changes with the turns of both readings.
struct IntervalMomentum {
  Eigen::Vector3d turn;      ///< Δ [rad]
  Eigen::Vector3d momentum;  ///< A Δ [N·m·s·s]
  // ∂/∂ξ of the readings after and before.
  Eigen::Matrix3d turn_after;
  Eigen::Matrix3d turn_before;
  Eigen::Matrix3d momentum_after;
  Eigen::Matrix3d momentum_before;
  Eigen::Matrix<double, 3, 6> d_inertia;

  IntervalMomentum(const Eigen::Matrix3d& before,
                   const Eigen::Matrix3d& after,
                   const Eigen::Matrix3d& inertia);
};

IntervalMomentum::IntervalMomentum(const Eigen::Matrix3d& before,
                                   const Eigen::Matrix3d& after,
                                   const Eigen::Matrix3d& inertia)
    : turn(rotationLog(after * before.transpose())) {
  const Eigen::Matrix3d R_half = rotationExp(0.5 * turn);
  const Eigen::Matrix3d R_middle = R_half * before;
  const Eigen::Matrix3d A = R_middle * inertia * R_middle.transpose();
  momentum = A * turn;
  turn_after = leftJacobianInverse(turn);
  turn_before = -turn_after * (R_half * R_half);
  const Eigen::Matrix3d half_left = 0.5 * leftJacobian(0.5 * turn);
  const Eigen::Matrix3d by_middle = A * skew(turn) - skew(momentum);
  momentum_after = A * turn_after + by_middle * half_left * turn_after;
  momentum_before = A * turn_before + by_middle * (half_left * turn_before + R_half);
  d_inertia = R_middle * inertiaColumns(R_middle.transpose() * turn);
}

}  // namespace

void BalanceEvaluator::start(const MotionSpan& span,
                             const MotionWindow& window,
                             const MotionPoint& point) {
  window_ = window;
  count_ = options_.test_functions;
  const std::size_t readings = window.last - window.first + 3;
  turned_.resize(readings);
  noise_.resize(readings + 2);
  for (std::size_t n = 0; wants_noise_ && n < noise_.size(); ++n) {
    noise_[n].setZero(3 * count_, 3);
  }
  const TestFunctions functions(
      span.track.time(window.first), span.track.time(window.last), options_.test_functions);
  middle_.resize(readings - 1);
  for (std::size_t n = 0; n < readings; ++n) {
    const std::size_t reading = window.first - 1 + n;
    point.turn(span.track.reading(reading), turned_[n]);
    if (n == 0 || n + 2 >= readings) {
      continue;
    }
    functions.evaluate(0.5 * (span.track.time(reading) + span.track.time(reading + 1)), middle_[n]);
  }
  // Outside of the window the functions are zero.
  for (TestFunctionValues* outside : {&middle_.front(), &middle_.back()}) {
    outside->value.setZero(count_);
    outside->first.setZero(count_);
    outside->second.setZero(count_);
    outside->third.setZero(count_);
  }
  sum_.setZero(3 * point.space().size(), count_);
  batch_.resize(3 * point.space().size(), kBatch);
  factors_.resize(kBatch, count_);
  batched_ = 0;
}

void BalanceEvaluator::addMomentum(const MotionSpan& span,
                                   const MotionPoint& point,
                                   WindowBalance& out) {
  for (std::size_t n = 0; n + 1 < turned_.size(); ++n) {
    addInterval(span, point, n, out);
  }
}

/// Of M = −Σ factor A Δ: −∫φ̇ L dt is −Σ (mean of φ̇) A Δ − Σ φ̈ A ω̇ h³/12, with ω̇ from the turns of
/// both neighbours.
Eigen::VectorXd BalanceEvaluator::momentumFactors(std::size_t place, double h) const {
  Eigen::VectorXd factor = middle_[place].first + (h * h / 24.0) * middle_[place].third;
  if (place > 0) {
    factor += (h / 24.0) * middle_[place - 1].second;
  }
  if (place + 1 < middle_.size()) {
    factor -= (h / 24.0) * middle_[place + 1].second;
  }
  return factor;
}

/// Of dry friction, by the rate over a few readings around an interval: less noisy than that of the
/// interval alone.
BalanceEvaluator::Fading BalanceEvaluator::fadingAt(const JointTrack& track,
                                                    std::size_t place) const {
  constexpr double kSpan = 0.01;  // [s]
  const auto reach = static_cast<std::size_t>(kSpan / (2.0 * track.step()));
  const std::size_t first = place - std::min(place, reach);
  const std::size_t last = std::min(turned_.size() - 1, place + 1 + reach);
  const std::size_t origin = window_.first - 1;
  const double per_time = 1.0 / (track.time(origin + last) - track.time(origin + first));
  const TurnedRotor& before = turned_[first];
  const TurnedRotor& after = turned_[last];
  const Eigen::Vector3d rate =
      per_time * rotationLog(after.R_stator_rotor * before.R_stator_rotor.transpose());
  Fading fading;
  fading.value = 1.0 / std::hypot(rate.norm(), options_.friction_speed);
  // What turns about the axis of the turn adds to its angle.
  fading.d_x =
      -std::pow(fading.value, 3) * per_time * rate.transpose().lazyProduct(after.d_x - before.d_x);
  return fading;
}

void BalanceEvaluator::addInterval(const MotionSpan& span,
                                   const MotionPoint& point,
                                   std::size_t place,
                                   WindowBalance& out) {
  const TurnedRotor& before = turned_[place];
  const TurnedRotor& after = turned_[place + 1];
  const std::size_t reading = window_.first - 1 + place;
  const Eigen::VectorXd factor =
      momentumFactors(place, span.track.time(reading + 1) - span.track.time(reading));
  const IntervalMomentum interval(before.R_stator_rotor, after.R_stator_rotor, point.inertia());
  const Fading fading = fadingAt(span.track, place);
  const double friction = point.viscous() + point.coulomb() * fading.value;
  // Products of three by three and three by some: too small for the general way.
  const Eigen::Matrix3Xd d_turn =
      interval.turn_after.lazyProduct(after.d_x) + interval.turn_before.lazyProduct(before.d_x);
  const Eigen::Matrix3Xd d_momentum = interval.momentum_after.lazyProduct(after.d_x) +
                                      interval.momentum_before.lazyProduct(before.d_x);
  const Eigen::Matrix3Xd d_braking =
      friction * d_turn + (point.coulomb() * interval.turn).lazyProduct(fading.d_x);
  const MotionPlaces& places = point.places();
  const auto add = [](Eigen::Index coordinate, const auto& derivative, auto column) {
    column.template segment<3>(3 * coordinate) += derivative;
  };
  for (Eigen::Index k = 0; k < count_; ++k) {
    const double c = -factor[k];
    const double f = middle_[place].value[k];
    out.residual.segment<3>(3 * k) += c * interval.momentum + (f * friction) * interval.turn;
    auto column = sum_.col(k);
    for (Eigen::Index t = 0; t < d_turn.cols(); ++t) {
      add(point.turning()[static_cast<std::size_t>(t)],
          c * d_momentum.col(t) + f * d_braking.col(t),
          column);
    }
    for (Eigen::Index n = 0; places.inertia >= 0 && n < 6; ++n) {
      add(places.inertia + n,
          c * point.scaleAt(places.inertia) * interval.d_inertia.col(n),
          column);
    }
    if (places.viscous >= 0) {
      add(places.viscous, f * point.scaleAt(places.viscous) * interval.turn, column);
    }
    if (places.coulomb >= 0) {
      add(places.coulomb, f * point.scaleAt(places.coulomb) * fading.value * interval.turn, column);
    }
    if (!wants_noise_) {
      continue;
    }
    noise_[place + 2].middleRows<3>(3 * k).noalias() +=
        (c * interval.momentum_after + f * friction * interval.turn_after) * after.d_reading;
    noise_[place + 1].middleRows<3>(3 * k).noalias() +=
        (c * interval.momentum_before + f * friction * interval.turn_before) * before.d_reading;
  }
}

void BalanceEvaluator::flush() {
  sum_.noalias() += batch_.leftCols(batched_) * factors_.topRows(batched_);
  batched_ = 0;
}

/// P: the integrand and its slope vanish at both ends, so that the plain sum is of fourth order.
void BalanceEvaluator::addImpulse(const MotionSpan& span,
                                  const MotionPoint& point,
                                  const BalanceOrder& order,
                                  WindowBalance& out) {
  const double begin = span.track.time(window_.first);
  const double end = span.track.time(window_.last);
  const double delay = point.currentDelay();
  const std::vector<double>& times = span.current_times;
  const auto first = static_cast<std::size_t>(
      std::upper_bound(times.begin(), times.end(), begin + delay) - times.begin());
  const TestFunctions functions(begin, end, options_.test_functions);
  const Eigen::Index coils = span.streams->currents.cols();
  current_.resize(coils);
  bend_.resize(coils);
  const std::size_t stride = order.stride;
  for (std::size_t n = std::max(first, stride); n + stride < times.size(); n += stride) {
    const double time = times[n] - delay;
    if (time >= end) {
      break;
    }
    const std::optional<TrackPoint> track = span.track.at(time);
    if (!track) {
      continue;
    }
    const double before = times[n] - times[n - stride];
    const double after = times[n + stride] - times[n];
    const auto row = static_cast<Eigen::Index>(n);
    const auto step = static_cast<Eigen::Index>(stride);
    const auto& all = span.streams->currents;
    const auto at = [&](Eigen::Index r) { return all.row(r).transpose().cast<double>(); };
    bend_ = 2.0 / (before + after) *
            ((at(row + step) - at(row)) / after - (at(row) - at(row - step)) / before);
    current_ = at(row) + point.currentDispersion() * bend_;
    functions.evaluate(time, test_);
    addCurrents(*track, point, 0.5 * (before + after), order, out);
  }
  flush();
}

void BalanceEvaluator::addCurrents(const TrackPoint& track,
                                   const MotionPoint& point,
                                   double step,
                                   const BalanceOrder& order,
                                   WindowBalance& out) {
  point.turn(track.position, between_);
  point.torque(between_.R_stator_rotor, current_, torque_);
  for (std::size_t t = 0; t < point.turning().size(); ++t) {
    torque_.d_x.col(point.turning()[t]).noalias() +=
        torque_.d_turn * between_.d_x.col(static_cast<Eigen::Index>(t));
  }
  const MotionPlaces& places = point.places();
  if (places.current_dispersion >= 0) {
    torque_.d_x.col(places.current_dispersion) =
        point.scaleAt(places.current_dispersion) * (torque_.d_coil * bend_);
  }
  const Eigen::Vector3d rate = torque_.d_turn * (between_.d_reading * track.velocity);
  for (Eigen::Index k = 0; k < count_; ++k) {
    out.residual.segment<3>(3 * k) -= (step * test_.value[k]) * torque_.torque;
    if (places.current_delay >= 0) {
      sum_.col(k).segment<3>(3 * places.current_delay) +=
          (step * point.scaleAt(places.current_delay)) *
          (test_.first[k] * torque_.torque + test_.value[k] * rate);
    }
  }
  batch_.col(batched_) = Eigen::Map<const Eigen::VectorXd>(torque_.d_x.data(), batch_.rows());
  factors_.row(batched_) = -step * test_.value.transpose();
  if (++batched_ == kBatch) {
    flush();
  }
  if (order.covariance) {
    addNoise(track, step, order, out);
  }
}

void BalanceEvaluator::addNoise(const TrackPoint& track,
                                double step,
                                const BalanceOrder& order,
                                WindowBalance& out) {
  const Eigen::Matrix3d by_reading = torque_.d_turn * between_.d_reading;
  const Eigen::Matrix3d squares = torque_.d_coil * torque_.d_coil.transpose();
  for (Eigen::Index k = 0; k < count_; ++k) {
    for (std::size_t m = 0; m < track.share.size(); ++m) {
      const std::size_t reading = track.first + m;
      if (reading + 2 >= window_.first && reading <= window_.last + 2) {
        noise_[reading + 2 - window_.first].middleRows<3>(3 * k) -=
            (step * test_.value[k] * track.share[m]) * by_reading;
      }
    }
    for (Eigen::Index l = 0; l < count_; ++l) {
      out.by_currents.block<3, 3>(3 * k, 3 * l) +=
          (step * step / static_cast<double>(order.stride) * test_.value[k] * test_.value[l]) *
          squares;
    }
  }
}

void BalanceEvaluator::finish(const MotionPoint& point,
                              const BalanceOrder& order,
                              WindowBalance& out) {
  const Eigen::Index size = point.space().size();
  out.jacobian.resize(3 * count_, size);
  for (Eigen::Index k = 0; k < count_; ++k) {
    out.jacobian.middleRows<3>(3 * k) =
        Eigen::Map<const Eigen::Matrix3Xd>(sum_.col(k).data(), 3, size);
  }
  if (!order.covariance) {
    return;
  }
  for (const Eigen::MatrixXd& one : noise_) {
    const Eigen::MatrixXd scaled = one * joint_stddev_.asDiagonal();
    out.by_joints.noalias() += scaled * scaled.transpose();
  }
}

void BalanceEvaluator::evaluate(const MotionSpan& span,
                                const MotionWindow& window,
                                const MotionPoint& point,
                                const BalanceOrder& order,
                                WindowBalance& out) {
  wants_noise_ = order.covariance;
  start(span, window, point);
  out.residual.setZero(3 * count_);
  if (order.covariance) {
    out.by_joints.setZero(3 * count_, 3 * count_);
    out.by_currents.setZero(3 * count_, 3 * count_);
  }
  addMomentum(span, point, out);
  addImpulse(span, point, order, out);
  finish(point, order, out);
}

}  // namespace sac
