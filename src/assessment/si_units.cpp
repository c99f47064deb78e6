#include "si_units.hpp"

#include <algorithm>
#include <array>
#include <string_view>
#include <utility>
#include <vector>

#include "spherical_actuator_calibration/base/error.hpp"

namespace sac {
namespace {

/// Symbols of a unit with their exponents, in the order in which they stand.
using Powers = std::vector<std::pair<std::string, int>>;

constexpr std::array<std::pair<const char*, const char*>, 6> kSymbols = {{{"A", "\\ampere"},
                                                                          {"N", "\\newton"},
                                                                          {"kg", "\\kilogram"},
                                                                          {"m", "\\metre"},
                                                                          {"rad", "\\radian"},
                                                                          {"s", "\\second"}}};

const char* siSymbol(const std::string& symbol) {
  const auto* const found = std::find_if(
      kSymbols.begin(), kSymbols.end(), [&](const auto& each) { return each.first == symbol; });
  if (found == kSymbols.end()) {
    throw DataError("A certificate has no name for the unit \"" + symbol + "\".");
  }
  return found->second;
}

/// `factor`: a symbol, squared or not; of a unit's denominator where `sign` is −1.
void multiply(std::string factor, int sign, Powers& powers) {
  constexpr std::string_view kSquare = "²";
  int exponent = sign;
  if (factor.size() > kSquare.size() &&
      factor.compare(factor.size() - kSquare.size(), kSquare.size(), kSquare) == 0) {
    factor.erase(factor.size() - kSquare.size());
    exponent *= 2;
  }
  const auto known = std::find_if(
      powers.begin(), powers.end(), [&](const auto& power) { return power.first == factor; });
  if (known == powers.end()) {
    powers.emplace_back(factor, exponent);
  } else {
    known->second += exponent;
  }
}

void multiplyUnit(const std::string& unit, Powers& powers) {
  constexpr std::string_view kTimes = "·";
  if (unit == "1") {
    return;
  }
  int sign = 1;
  for (std::size_t begin = 0; begin <= unit.size();) {
    const std::size_t times = std::min(unit.find(kTimes, begin), unit.size());
    const std::size_t per = std::min(unit.find('/', begin), unit.size());
    const std::size_t end = std::min(times, per);
    multiply(unit.substr(begin, end - begin), sign, powers);
    sign = per < times ? -1 : 1;
    begin = end + (per < times ? 1 : kTimes.size());
  }
}

std::string textOf(const Powers& powers) {
  std::string text;
  for (const auto& [symbol, exponent] : powers) {
    const std::string name = siSymbol(symbol);
    if (exponent != 0) {
      text += name;
    }
    if (exponent != 0 && exponent != 1) {
      text += "\\tothe{" + std::to_string(exponent) + "}";
    }
  }
  return text.empty() ? "\\one" : text;
}

}  // namespace

std::string siUnit(const std::string& unit) {
  return siProduct(unit, "1");
}

std::string siProduct(const std::string& a, const std::string& b) {
  Powers powers;
  multiplyUnit(a, powers);
  multiplyUnit(b, powers);
  return textOf(powers);
}

}  // namespace sac
