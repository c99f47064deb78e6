#pragma once

#include <string>

namespace sac {

/// In what small quantities are shown: angles and torques in thousandths, others as they come.
struct ShownUnit {
  double factor;
  std::string name;
  const char* format;  ///< of printf
};

/// `unit`: of a message; 1 is shown without a name.
ShownUnit shownIn(const std::string& unit);

/// A number by a format of printf.
std::string number(const char* format, double value);

/// The same with its unit, if there is one.
std::string withUnit(const char* format, double value, const std::string& unit);

}  // namespace sac
