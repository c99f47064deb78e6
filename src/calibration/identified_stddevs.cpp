#include "identified_stddevs.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <type_traits>
#include <utility>
#include <vector>

#include "spherical_actuator_calibration/actuator/torque_curve.hpp"
#include "spherical_actuator_calibration/base/pi.hpp"
#include "spherical_actuator_calibration/estimation/defined_stddev.hpp"

namespace sac {
namespace {

/// Derivatives of one gain by the coordinates of effects that it depends on.
using Gradient = std::vector<std::pair<Eigen::Index, double>>;

/// Gradients of the gains of all poles and coils.
struct GainGradients {
  std::vector<Gradient> poles;
  std::vector<Gradient> coils;
};

template <typename Axis>
void addDerivatives(const std::vector<Axis>& at,
                    const std::vector<Axis>& moved,
                    Eigen::Index coordinate,
                    std::vector<Gradient>& gradients) {
  for (std::size_t n = 0; n < at.size(); ++n) {
    if (moved[n].gain != at[n].gain) {
      gradients[n].emplace_back(coordinate, moved[n].gain - at[n].gain);
    }
  }
}

/// A gain is linear in each coordinate: a step of 1 gives its derivative.
GainGradients gainGradients(const ParameterSpace& space, const Eigen::VectorXd& x) {
  GainGradients gradients{std::vector<Gradient>(space.poles()),
                          std::vector<Gradient>(space.coils())};
  const Actuator at = space.actuatorAt(x);
  for (Eigen::Index p = space.effect(); p < space.size(); ++p) {
    const Actuator moved = space.actuatorAt(x + Eigen::VectorXd::Unit(space.size(), p));
    addDerivatives(at.poles, moved.poles, p, gradients.poles);
    addDerivatives(at.coils, moved.coils, p, gradients.coils);
  }
  return gradients;
}

/// Standard deviations of the corrections of readings: each entry has one coordinate, and is linear
/// in it.
void enterCorrections(const ParameterSpace& space,
                      const CalibrationState& state,
                      std::array<JointStddev, kJoints>& stddevs) {
  const Actuator at = space.actuatorAt(state.belief.x);
  for (Eigen::Index p = space.effect(); p < space.size(); ++p) {
    if (!state.identified[static_cast<std::size_t>(p)]) {
      continue;
    }
    const Actuator moved =
        space.actuatorAt(state.belief.x + Eigen::VectorXd::Unit(space.size(), p));
    const double stddev = std::sqrt(std::max(0.0, state.belief.covariance(p, p)));
    const auto enter = [&](const auto& before, const auto& after, auto& entries) {
      for (std::size_t n = 0; n < before.size(); ++n) {
        if (after[n] != before[n]) {
          entries = entries ? entries : std::decay_t<decltype(before)>{};
          (*entries)[n] = std::abs(after[n] - before[n]) * stddev;
        }
      }
    };
    for (std::size_t k = 0; k < kJoints; ++k) {
      const ReadingCorrection& before = at.joints[k].correction;
      const ReadingCorrection& after = moved.joints[k].correction;
      enter(before.linear, after.linear, stddevs[k].linear);
      enter(before.harmonics, after.harmonics, stddevs[k].harmonics);
    }
  }
}

/// Likewise; nothing unless all of it is identified.
std::optional<Eigen::Vector3d> unbalanceStddev(const ParameterSpace& space,
                                               const CalibrationState& state) {
  const Actuator at = space.actuatorAt(state.belief.x);
  std::optional<Eigen::Vector3d> stddevs;
  for (Eigen::Index p = space.effect(); p < space.size(); ++p) {
    const Actuator moved =
        space.actuatorAt(state.belief.x + Eigen::VectorXd::Unit(space.size(), p));
    const Eigen::Vector3d change = moved.unbalance - at.unbalance;
    if (change.isZero(0.0)) {
      continue;
    }
    if (!state.identified[static_cast<std::size_t>(p)]) {
      return std::nullopt;
    }
    const double stddev = std::sqrt(std::max(0.0, state.belief.covariance(p, p)));
    stddevs = stddevs.value_or(Eigen::Vector3d::Zero()) + stddev * change.cwiseAbs();
  }
  return stddevs;
}

/// At angles over the support, likewise: the curve is linear in the coordinates of its change.
std::optional<TorqueCurveStddev> curveStddev(const ParameterSpace& space,
                                             const CalibrationState& state) {
  constexpr Eigen::Index kIntervals = 30;
  const Actuator at = space.actuatorAt(state.belief.x);
  if (!at.torque_curve) {
    return std::nullopt;
  }
  const TorqueCurve curve(*at.torque_curve);
  const Eigen::VectorXd angles =
      Eigen::VectorXd::LinSpaced(kIntervals + 1, 0.0, curve.supportEnd());
  const auto change_of = [&](const TorqueCurve& moved) {
    return angles.unaryExpr([&](double angle) { return moved.value(angle) - curve.value(angle); })
        .eval();
  };
  std::vector<Eigen::Index> coordinates;
  Eigen::MatrixXd derivatives(angles.size(), space.size());
  for (Eigen::Index p = space.effect(); p < space.size(); ++p) {
    const Actuator moved =
        space.actuatorAt(state.belief.x + Eigen::VectorXd::Unit(space.size(), p));
    const Eigen::VectorXd change = change_of(TorqueCurve(*moved.torque_curve));
    if (change.isZero(0.0)) {
      continue;
    }
    if (!state.identified[static_cast<std::size_t>(p)]) {
      return std::nullopt;
    }
    derivatives.col(static_cast<Eigen::Index>(coordinates.size())) = change;
    coordinates.push_back(p);
  }
  if (coordinates.empty()) {
    return std::nullopt;
  }
  const Eigen::MatrixXd D = derivatives.leftCols(static_cast<Eigen::Index>(coordinates.size()));
  const Eigen::MatrixXd covariance = state.belief.covariance(coordinates, coordinates);
  const Eigen::VectorXd stddevs =
      (D * covariance).cwiseProduct(D).rowwise().sum().cwiseMax(0.0).cwiseSqrt();
  const double unit = at.torque_curve->angle_unit == AngleUnit::kDegree ? kOneDegree : 1.0;
  const Eigen::VectorXd described = angles / unit;
  return TorqueCurveStddev{{described.data(), described.data() + described.size()},
                           {stddevs.data(), stddevs.data() + stddevs.size()}};
}

std::optional<double> gainStddev(const CalibrationState& state, const Gradient& gradient) {
  const bool is_identified =
      !gradient.empty() && std::all_of(gradient.begin(), gradient.end(), [&](const auto& term) {
        return state.identified[static_cast<std::size_t>(term.first)];
      });
  if (!is_identified) {
    return std::nullopt;
  }
  double variance = 0.0;
  for (const auto& [p, d_p] : gradient) {
    for (const auto& [q, d_q] : gradient) {
      variance += d_p * d_q * state.belief.covariance(p, q);
    }
  }
  return std::sqrt(std::max(0.0, variance));
}

}  // namespace

ParameterStddevs identifiedStddevs(const ParameterSpace& space, const CalibrationState& state) {
  const Eigen::VectorXd& x = state.belief.x;
  const Eigen::VectorXd stddevs = space.reportedStddevs(x, state.belief.covariance);
  const auto at = [&](Eigen::Index p) {
    return state.identified[static_cast<std::size_t>(p)] ? std::optional(stddevs[p]) : std::nullopt;
  };
  const GainGradients gains = gainGradients(space, x);
  ParameterStddevs result;
  for (std::size_t k = 0; k < space.joints(); ++k) {
    const Eigen::Index joint = space.joint(k);
    result.joints[k] = {at(joint), at(joint + 1), at(joint + 2)};
  }
  enterCorrections(space, state, result.joints);
  result.unbalance = unbalanceStddev(space, state);
  result.torque_curve = curveStddev(space, state);
  for (std::size_t i = 0; i < space.poles(); ++i) {
    const Eigen::Index pole = space.pole(i);
    result.poles.push_back({at(pole), at(pole + 1), gainStddev(state, gains.poles[i])});
  }
  for (std::size_t j = 0; j < space.coils(); ++j) {
    const Eigen::Index coil = space.coil(j);
    result.coils.push_back({at(coil), at(coil + 1), gainStddev(state, gains.coils[j])});
  }
  return result;
}

double worstStddev(const ParameterSpace& space, const CalibrationState& state) {
  const Eigen::VectorXd stddevs = space.reportedStddevs(state.belief.x, state.belief.covariance);
  double worst = 0.0;
  for (Eigen::Index p = 0; p < space.effect(); ++p) {
    if (!state.identified[static_cast<std::size_t>(p)]) {
      return std::numeric_limits<double>::infinity();
    }
    worst = std::max(worst, definedStddev(stddevs[p]));
  }
  return worst;
}

}  // namespace sac
