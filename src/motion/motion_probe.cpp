#include "motion_probe.hpp"

#include <cmath>
#include <cstddef>

#include "joint_skew.hpp"
#include "other_friction.hpp"
#include "residual_probe.hpp"
#include "spherical_actuator_calibration/base/cholesky.hpp"

namespace sac {
namespace {

constexpr auto kFrictions = static_cast<Eigen::Index>(kFrictionLaws);

/// Windows and orientations of one estimate, with what they would be by other frictions and skews.
class MotionProbe {
 public:
  MotionProbe(const MotionTerms& terms,
              const MotionOptions& options,
              const std::vector<Eigen::Index>& estimated,
              const Eigen::VectorXd& x)
      : terms_(terms),
        options_(options),
        x_(x),
        frictions_(estimated, kFrictions),
        skews_(estimated, kSkews) {}

  void addWindows();
  void addOrientations();
  ResidualProbe::Finding friction(Eigen::Index law) const { return frictions_.find(law, 1); }
  ResidualProbe::Finding skew() const { return skews_.find(0, kSkews); }

 private:
  void addOrientations(const OrientationGroup& group, TrackerTerm& tracker);

  const MotionTerms& terms_;
  const MotionOptions& options_;
  const Eigen::VectorXd& x_;
  ResidualProbe frictions_;
  ResidualProbe skews_;  ///< by some windows: each has to be evaluated anew
};

void MotionProbe::addWindows() {
  const MotionPoint point = terms_.pointAt(x_);
  SkewEvaluator skews(options_);
  const std::size_t stride = keptStride(terms_.windowCount());
  for (std::size_t n = 0; n < terms_.windowCount(); ++n) {
    const WindowTerm& term = terms_.windows()[n];
    const bool is_some = n % stride == 0;
    // Of a sum, others are kept because they stand out.
    if (!term.serves() || !term.isKept() || (terms_.areSummed() && !is_some)) {
      continue;
    }
    const MotionSpan& span = terms_.spans()[term.window.span];
    const auto whitening = term.whitening.triangularView<Eigen::Lower>();
    const Eigen::MatrixXd by_coordinates = whitening * term.balance.jacobian;
    const Eigen::MatrixXd by_frictions =
        balanceByFrictions(term.window, span.track, point, options_.test_functions);
    frictions_.add(by_coordinates, whitening * by_frictions, term.residual);
    if (is_some) {
      skews_.add(
          by_coordinates, whitening * skews.evaluate(span, term.window, point), term.residual);
    }
  }
}

void MotionProbe::addOrientations() {
  const std::vector<OrientationGroup>& groups = terms_.orientations().groups();
  const std::size_t stride = keptStride(groups.size());
  TrackerTerm tracker(terms_.orientations().model(), terms_.places(), x_);
  for (std::size_t n = 0; n < groups.size(); n += stride) {
    addOrientations(groups[n], tracker);
  }
}

void MotionProbe::addOrientations(const OrientationGroup& group, TrackerTerm& tracker) {
  const double whitening = 1.0 / terms_.noise().orientation;
  const MotionSpan& span = terms_.spans()[group.span];
  const auto most = 3 * static_cast<Eigen::Index>(group.count);
  Eigen::MatrixXd by_coordinates(most, x_.size());
  Eigen::MatrixXd by_skews(most, kSkews);
  Eigen::VectorXd residual(most);
  Eigen::Index rows = 0;
  for (std::size_t n = 0; n < group.count; ++n) {
    const bool serves = terms_.orientations().terms()[group.term + n].active;
    if (!serves || !tracker.evaluate(span, group.first + n)) {
      continue;
    }
    by_coordinates.middleRows<3>(rows) = whitening * tracker.jacobian();
    for (Eigen::Index k = 0; k < kSkews; ++k) {
      by_skews.block<3, 1>(rows, k) = -whitening * tracker.byTime(static_cast<std::size_t>(k) + 1);
    }
    residual.segment<3>(rows) = whitening * tracker.residual();
    rows += 3;
  }
  skews_.add(by_coordinates.topRows(rows), by_skews.topRows(rows), residual.head(rows));
}

/// Of what geometry tells, by its covariance.
double distanceOf(const Eigen::VectorXd& bias, const Eigen::MatrixXd& covariance) {
  const Cholesky factor(covariance);
  return factor.isPositive() ? factor.half(bias).norm() : 0.0;
}

JointSkew skewOf(const ResidualProbe::Finding& finding,
                 const std::vector<Eigen::Index>& estimated,
                 const ParameterSpace& space,
                 const Eigen::MatrixXd& covariance) {
  JointSkew skew;
  if (!finding.is_told) {
    return skew;
  }
  skew.value = finding.value;
  skew.covariance = finding.covariance;
  std::vector<Eigen::Index> geometry;
  for (std::size_t n = 0; n < estimated.size() && estimated[n] < space.effect(); ++n) {
    geometry.push_back(estimated[n]);
    const double variance = covariance(estimated[n], estimated[n]);
    const double shift =
        variance > 0.0 ? finding.bias[static_cast<Eigen::Index>(n)] / std::sqrt(variance) : 0.0;
    if (std::abs(shift) > std::abs(skew.shift)) {
      skew.shift = shift;
      skew.most_shifted = space.name(estimated[n]);
    }
  }
  const auto count = static_cast<Eigen::Index>(geometry.size());
  skew.distance = distanceOf(finding.bias.head(count), covariance(geometry, geometry));
  return skew;
}

}  // namespace

void probeMotion(const MotionTerms& terms,
                 const MotionOptions& options,
                 const std::vector<Eigen::Index>& estimated,
                 MotionEstimate& found) {
  const ParameterBelief& belief = found.estimate.belief;
  MotionProbe probe(terms, options, estimated, belief.x);
  probe.addWindows();
  for (std::size_t k = 0; k < kFrictionLaws; ++k) {
    const ResidualProbe::Finding one = probe.friction(static_cast<Eigen::Index>(k));
    if (one.is_told) {
      const FrictionLaw& law = kFrictionLawsInWords[k];
      found.frictions.push_back(
          {law.words, law.unit, one.value[0], std::sqrt(one.covariance(0, 0))});
    }
  }
  probe.addOrientations();
  found.skew =
      skewOf(probe.skew(), estimated, terms.orientations().model().space(), belief.covariance);
}

}  // namespace sac
