#include "friction_probe.hpp"

#include <array>
#include <cmath>
#include <cstddef>

#include "spherical_actuator_calibration/base/rotations.hpp"

namespace sac {
namespace {

struct Law {
  const char* words;
  const char* unit;
};

constexpr std::size_t kLaws = 2;
constexpr std::array<Law, kLaws> kLawsInWords{
    {{"that grows with the square of the speed, as of air", "N.m.s2/rad2"},
     {"that is another about the rotor's axis z than about others", "N.m.s/rad"}}};

/// What some windows tell of one law.
struct Evidence {
  double information = 0.0;
  double gradient = 0.0;
  Eigen::VectorXd with_estimated;  ///< information that it has in common with them
};

/// Readings on either side of one over which a rate is not noise.
std::size_t rateReach(const JointTrack& track) {
  constexpr double kSpan = 0.01;  // [s]
  return std::max<std::size_t>(1, static_cast<std::size_t>(kSpan / (2.0 * track.step())));
}

/// Derivatives of a window's residuals by the coefficient of each law.
Eigen::MatrixXd derivatives(const WindowTerm& term,
                            const JointTrack& track,
                            const MotionPoint& point,
                            int functions) {
  const std::size_t reach = rateReach(track);
  const std::size_t first = term.window.first;
  const std::size_t last = term.window.last;
  std::vector<Eigen::Matrix3d> turned;
  TurnedRotor rotor;
  for (std::size_t n = first; n <= last; ++n) {
    point.turn(track.reading(n), rotor);
    turned.push_back(rotor.R_stator_rotor);
  }
  const TestFunctions tests(track.time(first), track.time(last), functions);
  TestFunctionValues test;
  Eigen::MatrixXd result = Eigen::MatrixXd::Zero(term.residual.size(), kLaws);
  for (std::size_t n = first; n < last; ++n) {
    const std::size_t from = std::max(first, n - std::min(n, reach));
    const std::size_t to = std::min(last, n + 1 + reach);
    const double lasting = track.time(to) - track.time(from);
    const Eigen::Vector3d rate =
        rotationLog(turned[to - first] * turned[from - first].transpose()) / lasting;
    const Eigen::Vector3d turn = rate * (track.time(n + 1) - track.time(n));
    const Eigen::Vector3d axis = turned[n - first].col(2);
    tests.evaluate(0.5 * (track.time(n) + track.time(n + 1)), test);
    for (Eigen::Index k = 0; k < functions; ++k) {
      result.block<3, 1>(3 * k, 0) += test.value[k] * rate.norm() * turn;
      result.block<3, 1>(3 * k, 1) += test.value[k] * axis.dot(turn) * axis;
    }
  }
  return result;
}

}  // namespace

std::vector<OtherFriction> probedFriction(const MotionTerms& terms,
                                          const Eigen::VectorXd& x,
                                          const std::vector<Eigen::Index>& estimated,
                                          const Eigen::MatrixXd& covariance) {
  std::array<Evidence, kLaws> evidence;
  for (Evidence& one : evidence) {
    one.with_estimated.setZero(static_cast<Eigen::Index>(estimated.size()));
  }
  const MotionPoint point = terms.pointAt(x);
  const int functions = static_cast<int>(terms.valuesPerWindow() / 3);
  for (const WindowTerm& term : terms.windows()) {
    if (!term.serves() || !term.isKept()) {
      continue;
    }
    const JointTrack& track = terms.spans()[term.window.span].track;
    const auto whitening = term.whitening.triangularView<Eigen::Lower>();
    const Eigen::MatrixXd by_law = whitening * derivatives(term, track, point, functions);
    const Eigen::MatrixXd by_parameters = whitening * term.balance.jacobian;
    for (std::size_t k = 0; k < kLaws; ++k) {
      const auto column = by_law.col(static_cast<Eigen::Index>(k));
      evidence[k].information += column.squaredNorm();
      evidence[k].gradient += column.dot(term.residual);
      const Eigen::VectorXd common = by_parameters.transpose() * column;
      evidence[k].with_estimated += common(estimated);
    }
  }
  // Of the rest nothing is known that the parameters do not explain as well.
  constexpr double kLeastShare = 1e-3;
  std::vector<OtherFriction> result;
  for (std::size_t k = 0; k < kLaws; ++k) {
    const Evidence& one = evidence[k];
    const double told = one.information - one.with_estimated.dot(covariance * one.with_estimated);
    if (told > kLeastShare * one.information) {
      result.push_back({kLawsInWords[k].words,
                        kLawsInWords[k].unit,
                        -one.gradient / told,
                        1.0 / std::sqrt(told)});
    }
  }
  return result;
}

}  // namespace sac
