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

bool leaveCutOff(MotionTerms& terms, std::size_t least) {
  constexpr std::size_t kPart = 4;
  std::size_t at_end = 0;
  std::size_t contradicting = 0;
  std::size_t others = 0;
  for (const WindowTerm& term : terms.windows()) {
    at_end += term.at_end.empty() ? 0 : 1;
    contradicting += !term.at_end.empty() && !term.active ? 1 : 0;
    others += term.at_end.empty() && term.serves() ? 1 : 0;
  }
  if (contradicting == 0 || kPart * contradicting < at_end || others < least) {
    return false;
  }
  for (WindowTerm& term : terms.windows()) {
    term.is_cut_off = !term.at_end.empty();
  }
  return true;
}

std::string leftOutReason(const WindowTerm& term) {
  if (!term.at_end.empty() && (term.is_cut_off || !term.active)) {
    return term.at_end;
  }
  return term.active ? "something held or turned the rotor steadily for longer"
                     : "it contradicts the others: something else moved the rotor";
}

}  // namespace sac
