#include "spherical_actuator_calibration/base/value_range.hpp"

#include <cmath>
#include <sstream>

#include "spherical_actuator_calibration/base/error.hpp"

namespace sac {

ValueRange ValueRange::finite(const std::string& unit) {
  ValueRange range;
  range.unit = unit;
  return range;
}

ValueRange ValueRange::closed(double minimum, double maximum, const std::string& unit) {
  return {minimum, maximum, unit, false, false};
}

ValueRange ValueRange::open(double minimum, double maximum, const std::string& unit) {
  return {minimum, maximum, unit, true, true};
}

ValueRange ValueRange::positive(const std::string& unit) {
  ValueRange range = nonNegative(unit);
  range.minimum_excluded = true;
  return range;
}

ValueRange ValueRange::nonNegative(const std::string& unit) {
  ValueRange range = finite(unit);
  range.minimum = 0.0;
  return range;
}

bool ValueRange::contains(double value) const {
  if (!std::isfinite(value)) {
    return false;
  }
  const bool above = minimum_excluded ? value > minimum : value >= minimum;
  const bool below = maximum_excluded ? value < maximum : value <= maximum;
  return above && below;
}

std::string ValueRange::text() const {
  const bool open_below = minimum_excluded || std::isinf(minimum);
  const bool open_above = maximum_excluded || std::isinf(maximum);
  std::ostringstream text;
  text << (open_below ? '(' : '[') << minimum << ", " << maximum << (open_above ? ')' : ']');
  if (!unit.empty()) {
    text << ' ' << unit;
  }
  return text.str();
}

void requireInRange(const std::string& key, double value, const ValueRange& range) {
  if (range.contains(value)) {
    return;
  }
  std::ostringstream message;
  message << key << ": " << value;
  if (std::isfinite(value)) {
    message << " is outside " << range.text() << ".";
  } else {
    message << " is not finite; allowed is " << range.text() << ".";
  }
  throw ConfigError(message.str());
}

}  // namespace sac
