#include "xml_limits.hpp"

#include <algorithm>

namespace sac {
namespace {

/// What is no element: how it begins, and how it ends.
struct Span {
  const char* begin;
  const char* end;
};

// The most special first.
constexpr Span kSpans[] = {{"<!--", "-->"}, {"<![CDATA[", "]]>"}, {"<!", ">"}, {"<?", "?>"}};

/// Behind the end of a span that begins at `place`; `place` where none does.
std::size_t behindSpan(const std::string& text, std::size_t place) {
  for (const Span& span : kSpans) {
    const std::string begin = span.begin;
    if (text.compare(place, begin.size(), begin) == 0) {
      const std::size_t end = text.find(span.end, place + begin.size());
      return end == std::string::npos ? text.size() : end + std::string(span.end).size();
    }
  }
  return place;
}

/// Number of attributes of the tag that begins at `place`, which becomes that behind it.
std::size_t takeTag(const std::string& text, std::size_t& place) {
  std::size_t attributes = 0;
  while (place < text.size() && text[place] != '>') {
    const char sign = text[place++];
    if (sign == '=') {
      ++attributes;
    } else if (sign == '"' || sign == '\'') {
      const std::size_t end = text.find(sign, place);
      place = end == std::string::npos ? text.size() : end + 1;
    }
  }
  return attributes;
}

}  // namespace

std::size_t lineOfManyAttributes(const std::string& text) {
  std::size_t place = text.find('<');
  while (place != std::string::npos) {
    const std::size_t begin = place;
    place = behindSpan(text, begin);
    if (place == begin && takeTag(text, place) > kMostAttributes) {
      const auto end = text.begin() + static_cast<std::ptrdiff_t>(begin);
      return 1 + static_cast<std::size_t>(std::count(text.begin(), end, '\n'));
    }
    place = text.find('<', place);
  }
  return 0;
}

}  // namespace sac
