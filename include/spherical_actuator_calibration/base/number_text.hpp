#pragma once

#include <optional>
#include <string>

namespace sac {

// Doubles as text and back, the same in every locale.

/// Fewest digits that give back the double to the last bit, with an exponent where that is shorter.
std::string shortestText(double value);

/// At most so many significant digits, 1 to 17, as %g prints them.
std::string roundedText(double value, int digits);

/// The text as a number, with neither blanks nor a plus sign before it; one that no double can hold
/// becomes infinity. Nothing: the text, or its end, is something else.
std::optional<double> parsedNumber(const std::string& text);

}  // namespace sac
