#include "tracker_colour.hpp"

#include <algorithm>
#include <cmath>

#include "spherical_actuator_calibration/estimation/distributions.hpp"

namespace sac {

bool WindowMeansMisfit::isMisfit() const {
  constexpr double kSignificance = 1e-3;
  return freedom > 0.0 && squares > expected * chiSquareLimit(freedom, kSignificance);
}

WindowMeansMisfit meansOfOrientations(const MotionTerms& terms, const Eigen::VectorXd& x) {
  const auto joints = static_cast<double>(terms.orientations().model().space().pole(0));
  WindowMeansMisfit means = terms.orientations().misfit(x, joints);
  means.expected = meansOverDifferences(terms.noise(), terms.spans());
  return means;
}

double trackerColour(const WindowMeansMisfit& orientations) {
  constexpr double kMostAlike = 0.5;
  if (!orientations.isMisfit()) {
    return 1.0;
  }
  // Of what is more than white noise; a part of it may be chance.
  const double misfit = orientations.reduced() / orientations.expected;
  const double chance = 2.0 / std::sqrt(orientations.freedom);
  if ((orientations.alike + chance) * misfit > kMostAlike * (misfit - 1.0)) {
    return 1.0;
  }
  // What neighbouring windows have in common widens means over many of them.
  const double alike = std::max(0.0, orientations.next_alike);
  return orientations.reduced() * (1.0 + alike) / (1.0 - alike);
}

}  // namespace sac
