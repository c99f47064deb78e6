// What a LiveMotion knows from its sums.
#include <algorithm>
#include <cmath>
#include <utility>

#include "factor_inverse.hpp"
#include "live_motion_work.hpp"
#include "spherical_actuator_calibration/base/cholesky.hpp"
#include "spherical_actuator_calibration/estimation/misfit.hpp"

namespace sac {

Eigen::MatrixXd LiveMotionWork::information() const {
  InformationSum sum = balance_;
  sum.addAt(orienting_, orientation_);
  return sum.information();
}

void LiveMotionWork::solve() {
  const Eigen::MatrixXd told = information() + prior_information_;
  const Eigen::MatrixXd all = told(free_, free_);
  Eigen::VectorXd slope = balance_.gradient() + prior_information_ * (anchor_ - prior_.x);
  slope(orienting_) += orientation_.gradient();
  const Cholesky factor(all);
  const Eigen::VectorXd slope_of_free = slope(free_);
  const Eigen::VectorXd step = factor.solve(slope_of_free);
  if (!factor.isPositive() || !step.allFinite()) {
    return;
  }
  x_ = anchor_;
  x_(free_) -= step;
  tell(inverseOfSquare(factor.lower()));
}

double LiveMotionWork::squares() const {
  InformationSum here = balance_;
  here.moveBy(x_ - anchor_);
  return here.squaredMisfit();
}

double LiveMotionWork::freedom() const {
  const std::size_t serving = estimate_.windows - estimate_.left_out;
  return 3.0 * options_.test_functions * static_cast<double>(serving) -
         static_cast<double>(free_.size());
}

/// Reduced, of the tracker's means over the windows that are kept.
double LiveMotionWork::orientationChiSquare() const {
  double freedom = -static_cast<double>(model_->space().pole(0));
  for (const LiveWindow& window : kept_) {
    freedom += window.orientations > 0 ? 3.0 : 0.0;
  }
  const Eigen::VectorXd apart = x_ - anchor_;
  InformationSum here = means_;
  here.moveBy(apart(orienting_));
  return freedom > 2.0 ? here.squaredMisfit() / freedom : 0.0;
}

void LiveMotionWork::countServing() {
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

/// Columns of what is free that orientations tell of; zero of what is held.
Eigen::MatrixXd LiveMotionWork::orientingColumns(const Eigen::MatrixXd& of_free) const {
  Eigen::MatrixXd columns = Eigen::MatrixXd::Zero(of_free.rows(), orientation_.gradient().size());
  for (std::size_t n = 0; n < orienting_.size(); ++n) {
    const auto place = std::lower_bound(free_.begin(), free_.end(), orienting_[n]);
    if (place != free_.end() && *place == orienting_[n]) {
      columns.col(static_cast<Eigen::Index>(n)) = of_free.col(place - free_.begin());
    }
  }
  return columns;
}

/// What is known now, with noise as large as both kinds of residuals say. `inverse`: of the
/// information of what is free.
void LiveMotionWork::tell(const Eigen::MatrixXd& inverse) {
  countServing();
  const double squares = this->squares();
  const double freedom = this->freedom();
  estimate_.chi_square = freedom > 0.0 ? squares / freedom : 0.0;
  const double windows = misfitVariance(squares, freedom);
  const double orientations = std::max(1.0, orientationChiSquare());
  Eigen::MatrixXd own = windows * inverse;
  if (orientations != windows) {
    const Eigen::MatrixXd by_orientations = orientingColumns(inverse);
    const Eigen::MatrixXd more = (orientations - windows) * orientation_.information();
    own.noalias() += (by_orientations * more) * by_orientations.transpose();
  }
  ParameterBelief& belief = estimate_.belief;
  belief.x = x_;
  if (static_cast<Eigen::Index>(free_.size()) == x_.size()) {
    belief.covariance = own;
  } else {
    tellBesideHeld(inverse, own);
  }
  const double noise = std::sqrt(factors_.currents) * noise_.current;
  by_steps_ = steps_.widen(model_->space(), noise, belief);
}

/// `own`: the covariance of what is free, without what is held.
void LiveMotionWork::tellBesideHeld(const Eigen::MatrixXd& inverse, const Eigen::MatrixXd& own) {
  Eigen::MatrixXd& covariance = estimate_.belief.covariance;
  covariance = prior_.covariance;
  for (const Eigen::Index p : free_) {
    covariance.row(p).setZero();
    covariance.col(p).setZero();
  }
  if (holds_uncertain_) {
    tellWithHeld(inverse, own);
  } else {
    covariance(free_, free_) = own;
  }
}

/// What is held is as uncertain as before, and what is estimated because of it, too.
void LiveMotionWork::tellWithHeld(const Eigen::MatrixXd& inverse, const Eigen::MatrixXd& own) {
  ParameterBelief& belief = estimate_.belief;
  Eigen::MatrixXd others = information()(free_, Eigen::all);
  others(Eigen::all, free_).setZero();
  const Eigen::MatrixXd gain = -inverse * others;
  const Eigen::MatrixXd with_held = gain * belief.covariance;
  belief.covariance(free_, Eigen::all) += with_held;
  belief.covariance(Eigen::all, free_) += with_held.transpose();
  belief.covariance(free_, free_) = own + with_held * gain.transpose();
}

}  // namespace sac
