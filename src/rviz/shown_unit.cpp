#include "shown_unit.hpp"

#include <cstdio>

namespace sac {

ShownUnit shownIn(const std::string& unit) {
  if (unit == "rad" || unit == "N·m") {
    return {1e3, "m" + unit, "%.3f"};
  }
  return {1.0, unit == "1" ? "" : unit, "%.2g"};
}

std::string number(const char* format, double value) {
  char text[64];
  std::snprintf(text, sizeof(text), format, value);
  return text;
}

std::string withUnit(const char* format, double value, const std::string& unit) {
  return number(format, value) + (unit.empty() ? "" : " " + unit);
}

}  // namespace sac
