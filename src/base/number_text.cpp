#include "spherical_actuator_calibration/base/number_text.hpp"

#include <array>
#include <charconv>
#include <limits>
#include <system_error>

#ifdef __cpp_lib_to_chars

namespace sac {

std::string shortestText(double value) {
  std::array<char, 32> text = {};
  return {text.data(), std::to_chars(text.data(), text.data() + text.size(), value).ptr};
}

std::string roundedText(double value, int digits) {
  std::array<char, 32> text = {};
  const std::to_chars_result result = std::to_chars(
      text.data(), text.data() + text.size(), value, std::chars_format::general, digits);
  return {text.data(), result.ptr};
}

std::optional<double> parsedNumber(const std::string& text) {
  double number = 0.0;
  const char* const end = text.data() + text.size();
  const std::from_chars_result result = std::from_chars(text.data(), end, number);
  if (result.ptr != end || result.ec == std::errc::invalid_argument) {
    return std::nullopt;
  }
  return result.ec == std::errc() ? number : std::numeric_limits<double>::infinity();
}

}  // namespace sac

#else  // The library of GCC before 11 (Debian 11) has these functions for integers only.

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <cmath>
#include <cstdio>
#include <cstdlib>

#include <locale.h>

namespace sac {
namespace {

/// The numbers of this thread are written and read as in C, whatever the locale of the program.
class PlainNumbers {
 public:
  PlainNumbers() : plain_(newlocale(LC_NUMERIC_MASK, "C", nullptr)), before_(uselocale(plain_)) {}
  ~PlainNumbers() {
    uselocale(before_);
    freelocale(plain_);
  }
  PlainNumbers(const PlainNumbers&) = delete;
  PlainNumbers& operator=(const PlainNumbers&) = delete;

 private:
  locale_t plain_;
  locale_t before_;
};

/// With `decimals` after the point, by %e or %f.
std::string printed(const char* pattern, int decimals, double value) {
  std::array<char, 64> text = {};
  std::snprintf(text.data(), text.size(), pattern, decimals, value);
  return text.data();
}

}  // namespace

std::string shortestText(double value) {
  const PlainNumbers plain;
  int decimals = 0;
  std::string scientific = printed("%.*e", decimals, value);
  while (std::isfinite(value) && std::strtod(scientific.c_str(), nullptr) != value) {
    ++decimals;
    scientific = printed("%.*e", decimals, value);
  }
  const std::size_t letter = scientific.find('e');
  if (letter == std::string::npos) {
    return scientific;
  }
  constexpr int kLongestInteger = 24;  // no text with an exponent is longer
  const int exponent = std::atoi(scientific.c_str() + letter + 1);
  if (std::abs(exponent) > kLongestInteger) {
    return scientific;
  }
  std::string fixed = printed("%.*f", std::max(decimals - exponent, 0), value);
  return fixed.size() <= scientific.size() ? fixed : scientific;
}

std::string roundedText(double value, int digits) {
  const PlainNumbers plain;
  return printed("%.*g", digits, value);
}

std::optional<double> parsedNumber(const std::string& text) {
  const PlainNumbers plain;
  const bool is_hexadecimal = text.find_first_of("xX") != std::string::npos;
  if (text.empty() || text[0] == '+' || std::isspace(static_cast<unsigned char>(text[0])) != 0 ||
      is_hexadecimal) {
    return std::nullopt;
  }
  char* end = nullptr;
  errno = 0;
  const double number = std::strtod(text.c_str(), &end);
  if (end != text.c_str() + text.size()) {
    return std::nullopt;
  }
  // ERANGE is also told of numbers that lose digits near zero.
  const bool is_lost = errno == ERANGE && (number == 0.0 || std::isinf(number));
  return is_lost ? std::numeric_limits<double>::infinity() : number;
}

}  // namespace sac

#endif
