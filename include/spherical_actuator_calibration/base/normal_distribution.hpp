#pragma once

namespace sac {

/// Standard deviations of a normal distribution within which 95 % lie, on both sides.
inline constexpr double kTwoSided95 = 1.959963984540054;

/// Standard deviations beyond which no noise explains a difference: once in a million and more.
inline constexpr double kSignificant = 5.0;

/// Median of the absolute value of a normal distribution of unit standard deviation.
inline constexpr double kMedianOfNormal = 0.6745;

/// Median of the χ² distribution with three degrees of freedom.
inline constexpr double kMedianOfChiSquare3 = 2.366;

}  // namespace sac
