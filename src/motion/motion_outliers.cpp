#include "motion_outliers.hpp"

#include <algorithm>
#include <cstddef>
#include <map>
#include <string>
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
  const bool windows = rejectThose(
      terms.windows(),
      static_cast<double>(terms.valuesPerWindow()),
      false_alarm_probability,
      [](const WindowTerm& term) { return term.residual.size() > 0 && !term.is_cut_off; });
  const bool orientations = rejectThose(
      terms.orientations().terms(), 3.0, false_alarm_probability, [](const OrientationTerm& term) {
        return term.is_known;
      });
  return windows || orientations;
}

bool leaveCutOff(MotionTerms& terms, std::size_t least) {
  constexpr std::size_t kPart = 4;
  constexpr double kChance = 1e-3;
  constexpr double kLeastRate = 0.01;
  struct Tally {
    std::size_t count = 0;
    std::size_t contradicting = 0;
  };
  std::map<std::string, Tally> ends;
  Tally others;
  for (const WindowTerm& term : terms.windows()) {
    Tally& tally = term.at_end.empty() ? others : ends[term.at_end];
    ++tally.count;
    tally.contradicting += term.active ? 0 : 1;
  }
  // Hands come in windows with such readings, too.
  const double rate = std::max(kLeastRate,
                               static_cast<double>(others.contradicting) /
                                   static_cast<double>(std::max<std::size_t>(1, others.count)));
  bool changed = false;
  for (WindowTerm& term : terms.windows()) {
    const Tally& tally = term.at_end.empty() ? others : ends[term.at_end];
    term.is_cut_off = !term.at_end.empty() && others.count >= least &&
                      kPart * tally.contradicting >= tally.count &&
                      binomialTail(tally.count, rate, tally.contradicting) < kChance;
    changed = changed || term.is_cut_off;
  }
  return changed;
}

std::string leftOutReason(const WindowTerm& term) {
  if (term.is_cut_off) {
    return term.at_end;
  }
  return term.active ? "something held or turned the rotor steadily for longer"
                     : "it contradicts the others: something else moved the rotor";
}

}  // namespace sac
