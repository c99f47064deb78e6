#include "friction_probe.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "spherical_actuator_calibration/base/cholesky.hpp"
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
                                          const std::vector<Eigen::Index>& estimated) {
  const MotionPoint point = terms.pointAt(x);
  const int functions = static_cast<int>(terms.valuesPerWindow() / 3);
  const auto count = static_cast<Eigen::Index>(estimated.size());
  // Of the laws, of the parameters, and what they have in common.
  Eigen::MatrixXd of_laws = Eigen::MatrixXd::Zero(kLaws, kLaws);
  Eigen::MatrixXd of_both = Eigen::MatrixXd::Zero(count, kLaws);
  Eigen::MatrixXd of_parameters = Eigen::MatrixXd::Zero(count, count);
  Eigen::VectorXd laws_gradient = Eigen::VectorXd::Zero(kLaws);
  Eigen::VectorXd parameters_gradient = Eigen::VectorXd::Zero(count);
  // Others are kept because they stand out.
  const std::size_t stride = noiseStride(terms.windowCount());
  for (std::size_t n = 0; n < terms.windowCount(); n += terms.areSummed() ? stride : 1) {
    const WindowTerm& term = terms.windows()[n];
    if (!term.serves() || !term.isKept()) {
      continue;
    }
    const JointTrack& track = terms.spans()[term.window.span].track;
    const auto whitening = term.whitening.triangularView<Eigen::Lower>();
    const Eigen::MatrixXd by_law = whitening * derivatives(term, track, point, functions);
    const Eigen::MatrixXd by_all = whitening * term.balance.jacobian;
    const Eigen::MatrixXd by_parameters = by_all(Eigen::all, estimated);
    of_laws += by_law.transpose() * by_law;
    of_both += by_parameters.transpose() * by_law;
    of_parameters += by_parameters.transpose() * by_parameters;
    laws_gradient += by_law.transpose() * term.residual;
    parameters_gradient += by_parameters.transpose() * term.residual;
  }
  // Of the rest nothing is known that the parameters do not explain as well.
  constexpr double kLeastShare = 1e-3;
  const Eigen::MatrixXd taken_up = solveSemidefinite(of_parameters, of_both);
  std::vector<OtherFriction> result;
  for (std::size_t k = 0; k < kLaws; ++k) {
    const auto law = static_cast<Eigen::Index>(k);
    const double all = of_laws(law, law);
    const double told = all - of_both.col(law).dot(taken_up.col(law));
    const double gradient = laws_gradient[law] - parameters_gradient.dot(taken_up.col(law));
    if (told > kLeastShare * all) {
      result.push_back(
          {kLawsInWords[k].words, kLawsInWords[k].unit, -gradient / told, 1.0 / std::sqrt(told)});
    }
  }
  return result;
}

}  // namespace sac
