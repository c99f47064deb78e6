#pragma once

#include <cstddef>
#include <string>

namespace sac {

/// Of an element; those of robot descriptions have a handful. Parsers look for each attribute among
/// those before it.
inline constexpr std::size_t kMostAttributes = 100;

/// The line, from 1, of the first element with more attributes than that; 0 where there is none.
/// Reads no more of XML than where tags begin and end.
std::size_t lineOfManyAttributes(const std::string& text);

}  // namespace sac
