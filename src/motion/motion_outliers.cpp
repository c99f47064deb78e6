#include "motion_outliers.hpp"

#include <algorithm>
#include <vector>

#include "spherical_actuator_calibration/base/median.hpp"
#include "spherical_actuator_calibration/estimation/distributions.hpp"

namespace sac {
namespace {

/// `counts`: whether a term has a misfit. `freedom`: residuals of a term.
template <typename Terms, typename Counts>
bool rejectThose(Terms& terms,
                 double freedom,
                 double false_alarm_probability,
                 const Counts& counts) {
  std::vector<double> squares;
  for (const auto& term : terms) {
    if (counts(term)) {
      squares.push_back(term.square);
    }
  }
  if (squares.empty()) {
    return false;
  }
  const double usual = chiSquareLimit(freedom, 0.5) / freedom;
  const double probability = false_alarm_probability / static_cast<double>(squares.size());
  const double limit =
      chiSquareLimit(freedom, probability) / freedom * std::max(1.0, medianOf(squares) / usual);
  bool changed = false;
  for (auto& term : terms) {
    const bool active = !counts(term) || term.square <= limit;
    changed = changed || active != term.active;
    term.active = active;
  }
  return changed;
}

}  // namespace

bool rejectOutliers(MotionTerms& terms, double false_alarm_probability) {
  const bool windows = rejectThose(terms.windows(),
                                   static_cast<double>(terms.valuesPerWindow()),
                                   false_alarm_probability,
                                   [](const WindowTerm& term) { return term.residual.size() > 0; });
  const bool orientations = rejectThose(
      terms.orientations().terms(), 3.0, false_alarm_probability, [](const OrientationTerm& term) {
        return term.is_known;
      });
  return windows || orientations;
}

}  // namespace sac
