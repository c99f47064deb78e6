#include "spherical_actuator_calibration/motion/channel_impulses.hpp"

#include <cmath>
#include <vector>

#include "motion_terms.hpp"
#include "spherical_actuator_calibration/base/cholesky.hpp"
#include "spherical_actuator_calibration/estimation/effect_name.hpp"

namespace sac {
namespace {

/// Coordinates of what moves the rotor beside the coils.
std::vector<Eigen::Index> otherMovers(const ParameterSpace& space, const MotionPlaces& places) {
  std::vector<Eigen::Index> coordinates;
  for (Eigen::Index p = space.effect(); p < space.size(); ++p) {
    const bool is_inertia = places.inertia >= 0 && p >= places.inertia && p < places.inertia + 6;
    if (is_inertia || p == places.viscous || p == places.coulomb ||
        space.effects().at(p - space.effect()).name == effect_name::kRotorUnbalance) {
      coordinates.push_back(p);
    }
  }
  return coordinates;
}

/// One window's part of `through`: of each channel and coil, test function by test function.
class ThroughCoils {
 public:
  ThroughCoils(const MotionPoint& point, int functions) : point_(point), functions_(functions) {}

  Eigen::MatrixXd evaluate(const MotionSpan& span, const MotionWindow& window, std::size_t stride) {
    const TestFunctions functions(
        span.track.time(window.first), span.track.time(window.last), functions_);
    const Eigen::Index coils = span.streams->currents.cols();
    Eigen::MatrixXd result = Eigen::MatrixXd::Zero(Eigen::Index{3} * functions_, coils * coils);
    TestFunctionValues test;
    visitCurrents(span, window, point_.currentDelay(), stride, {}, [&](const CurrentReading& now) {
      const Eigen::VectorXd current =
          span.streams->currents.row(static_cast<Eigen::Index>(now.row)).transpose().cast<double>();
      point_.turn(now.track.position, turned_);
      point_.torque(turned_.R_stator_rotor, current, torque_);
      functions.evaluate(now.time, test);
      for (Eigen::Index channel = 0; channel < coils; ++channel) {
        const Eigen::Matrix3Xd impulse = (now.step() * current[channel]) * torque_.d_coil;
        for (Eigen::Index k = 0; k < functions_; ++k) {
          result.block(3 * k, channel * coils, 3, coils) += test.value[k] * impulse;
        }
      }
    });
    return result;
  }

 private:
  const MotionPoint& point_;
  int functions_;
  TurnedRotor turned_;
  StatorTorque torque_;
};

/// Root mean square over the windows, of each test function.
Eigen::VectorXd usualSizes(const Eigen::VectorXd& values, Eigen::Index per_window) {
  Eigen::VectorXd squares = Eigen::VectorXd::Zero(per_window / 3);
  for (Eigen::Index n = 0; n < values.size(); ++n) {
    squares[n % per_window / 3] += values[n] * values[n];
  }
  const double windows = static_cast<double>(values.size()) / static_cast<double>(per_window);
  return (squares / (3.0 * windows)).cwiseMax(1e-300).cwiseSqrt();
}

/// Both in units of the usual size of the last column's values.
void scaleRows(Eigen::Index per_window, Eigen::MatrixXd& all, Eigen::MatrixXd& by_movers) {
  const Eigen::VectorXd sizes = usualSizes(all.col(all.cols() - 1), per_window);
  for (Eigen::Index n = 0; n < all.rows(); ++n) {
    const double size = sizes[n % per_window / 3];
    all.row(n) /= size;
    by_movers.row(n) /= size;
  }
}

/// What the movers, of these prior variances, explain of each column.
void takeOff(const Eigen::MatrixXd& by_movers,
             const Eigen::VectorXd& variances,
             Eigen::MatrixXd& columns) {
  // Of the usual size of a value; it matters where nothing else is known of the movers.
  constexpr double kNoise = 0.1;
  constexpr double kLeast = 1e-12;
  Eigen::MatrixXd information = by_movers.transpose() * by_movers;
  information.diagonal() += kNoise * kNoise * variances.cwiseMax(kLeast).cwiseInverse();
  columns -= by_movers * solveSemidefinite(information, by_movers.transpose() * columns);
}

MotionOptions someWindows() {
  MotionOptions options;
  options.hold_out_every = 0;
  options.most_windows = 40;
  return options;
}

}  // namespace

ChannelImpulses channelImpulses(const MotionProblem& problem, double current_delay) {
  const MotionOptions options = someWindows();
  MotionTerms terms(problem, options);
  const ParameterSpace& space = problem.model->space();
  ChannelImpulses result;
  result.coils = space.coils();
  const auto windows = static_cast<Eigen::Index>(terms.windowCount());
  if (windows == 0) {
    return result;
  }
  Eigen::VectorXd x = problem.prior.x;
  const Eigen::Index delay = terms.places().current_delay;
  if (delay >= 0) {
    x[delay] = current_delay / space.effects().scale(delay - space.effect());
  }
  TermOrder order;
  order.balance.stride = terms.coarseStride();
  order.orientations = false;
  terms.linearize(x, order);
  const MotionPoint point = terms.pointAt(x);
  const std::vector<Eigen::Index> movers = otherMovers(space, terms.places());
  const Eigen::Index values = terms.valuesPerWindow();
  const auto coils = static_cast<Eigen::Index>(result.coils);
  const Eigen::Index pairs = coils * coils;
  Eigen::MatrixXd by_movers(windows * values, static_cast<Eigen::Index>(movers.size()));
  Eigen::MatrixXd all(windows * values, pairs + 1);
  ThroughCoils through(point, options.test_functions);
  for (Eigen::Index n = 0; n < windows; ++n) {
    const WindowTerm& term = terms.windows()[static_cast<std::size_t>(n)];
    auto own = all.middleRows(n * values, values);
    own.leftCols(pairs) =
        through.evaluate(terms.spans()[term.window.span], term.window, order.balance.stride);
    own.col(pairs) = term.balance.residual;
    for (Eigen::Index coil = 0; coil < coils; ++coil) {
      own.col(pairs) += own.col(coil * coils + coil);
    }
    by_movers.middleRows(n * values, values) = term.balance.jacobian(Eigen::all, movers);
  }
  scaleRows(values, all, by_movers);
  const Eigen::VectorXd variances = problem.prior.covariance.diagonal();
  takeOff(by_movers, variances(movers), all);
  result.momentum = all.col(pairs);
  result.through = all.leftCols(pairs);
  return result;
}

}  // namespace sac
