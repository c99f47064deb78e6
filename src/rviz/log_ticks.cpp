#include "log_ticks.hpp"

#include <cmath>
#include <cstddef>

namespace sac {
namespace {

constexpr std::size_t kMost = 6;

/// Those of `digits` times powers of ten that are within.
template <typename Digits>
std::vector<double> roundValues(double least, double most, const Digits& digits) {
  constexpr double kSlack = 1e-9;  // of a value that rounding puts just outside
  std::vector<double> values;
  const auto first = static_cast<int>(std::floor(std::log10(least)));
  const auto last = static_cast<int>(std::ceil(std::log10(most)));
  for (int decade = first; decade <= last; ++decade) {
    for (const double digit : digits) {
      const double value = digit * std::pow(10.0, decade);
      if (value >= least * (1.0 - kSlack) && value <= most * (1.0 + kSlack)) {
        values.push_back(value);
      }
    }
  }
  return values;
}

}  // namespace

std::vector<double> logTicks(double least, double most) {
  if (!(most > least)) {
    return {least};
  }
  for (const auto& digits : {std::vector{1.0, 2.0, 5.0}, std::vector{1.0}}) {
    std::vector<double> ticks = roundValues(least, most, digits);
    if (ticks.size() < 2) {
      return {least, most};
    }
    if (ticks.size() <= kMost) {
      return ticks;
    }
  }
  // Decades beyond decades: every so many.
  const std::vector<double> decades = roundValues(least, most, std::vector{1.0});
  const std::size_t step = (decades.size() + kMost - 1) / kMost;
  std::vector<double> ticks;
  for (std::size_t n = 0; n < decades.size(); n += step) {
    ticks.push_back(decades[n]);
  }
  return ticks;
}

}  // namespace sac
