#pragma once

#include <limits>
#include <string>

namespace sac {

/// Values that a setting may take, for people as well as for the check. Never contains NaN or ±∞.
struct ValueRange {
  double minimum = -std::numeric_limits<double>::infinity();
  double maximum = std::numeric_limits<double>::infinity();
  std::string unit = {};          ///< as it follows the values in a message; may be empty
  bool minimum_excluded = false;  ///< the minimum itself is not allowed
  bool maximum_excluded = false;  ///< the maximum itself is not allowed

  /// Every finite value.
  static ValueRange finite(const std::string& unit = {});
  /// minimum ≤ value ≤ maximum.
  static ValueRange closed(double minimum, double maximum, const std::string& unit = {});
  /// minimum < value < maximum.
  static ValueRange open(double minimum, double maximum, const std::string& unit = {});
  /// 0 < value.
  static ValueRange positive(const std::string& unit = {});
  /// 0 ≤ value.
  static ValueRange nonNegative(const std::string& unit = {});

  bool contains(double value) const;

  /// For people: "[-1.5708, 1.5708] rad", "(0, inf) A".
  std::string text() const;
};

/// Throws ConfigError "`key`: 2.1 is outside [-1.5708, 1.5708] rad." (or "… is not finite.") unless
/// the range contains the value.
void requireInRange(const std::string& key, double value, const ValueRange& range);

}  // namespace sac
