#include "spherical_actuator_calibration/base/printable_text.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <memory>
#include <streambuf>

namespace sac {
namespace {

using Byte = unsigned char;

Byte byteAt(const std::string& text, std::size_t place) {
  return place < text.size() ? static_cast<Byte>(text[place]) : Byte{0};
}

bool isContinuation(Byte byte) {
  constexpr Byte kMask = 0xC0;
  constexpr Byte kContinuation = 0x80;
  return (byte & kMask) == kContinuation;
}

/// Smallest first byte of characters of some length in UTF-8, and range of their second byte at
/// that first byte and the next (Unicode, table 3-7).
struct Lead {
  Byte first, last;      ///< range of the first byte
  Byte second_smallest;  ///< range of the second
  Byte second_largest;
  std::size_t length;
};

// C2 80 to C2 9F are control characters, too.
constexpr std::array<Lead, 9> kLeads = {{{0xC2, 0xC2, 0xA0, 0xBF, 2},
                                         {0xC3, 0xDF, 0x80, 0xBF, 2},
                                         {0xE0, 0xE0, 0xA0, 0xBF, 3},
                                         {0xE1, 0xEC, 0x80, 0xBF, 3},
                                         {0xED, 0xED, 0x80, 0x9F, 3},
                                         {0xEE, 0xEF, 0x80, 0xBF, 3},
                                         {0xF0, 0xF0, 0x90, 0xBF, 4},
                                         {0xF1, 0xF3, 0x80, 0xBF, 4},
                                         {0xF4, 0xF4, 0x80, 0x8F, 4}}};

/// Characters of three bytes that a terminal obeys: marks of the direction of writing, separators
/// of lines and paragraphs, and what embeds, overrides or isolates a direction.
bool isObeyed(const std::string& text, std::size_t place) {
  struct Range {
    unsigned first, last;
  };
  constexpr std::array<Range, 3> kObeyed{{{0x200E, 0x200F}, {0x2028, 0x202E}, {0x2066, 0x2069}}};
  constexpr unsigned kFirstMask = 0x0F;
  constexpr unsigned kMask = 0x3F;
  constexpr unsigned kBits = 6;
  const unsigned character = ((byteAt(text, place) & kFirstMask) << (2 * kBits)) |
                             ((byteAt(text, place + 1) & kMask) << kBits) |
                             (byteAt(text, place + 2) & kMask);
  return std::any_of(kObeyed.begin(), kObeyed.end(), [character](const Range& range) {
    return character >= range.first && character <= range.last;
  });
}

/// Bytes of the character at `place` that can be shown as it is; 0 when it cannot.
std::size_t shownLength(const std::string& text, std::size_t place) {
  constexpr Byte kFirstPrintable = 0x20;
  constexpr Byte kDelete = 0x7F;
  const Byte byte = byteAt(text, place);
  if (byte <= kDelete) {
    return (byte >= kFirstPrintable && byte != kDelete) || byte == '\n' || byte == '\t' ? 1 : 0;
  }
  for (const Lead& lead : kLeads) {
    if (byte < lead.first || byte > lead.last) {
      continue;
    }
    const Byte second = byteAt(text, place + 1);
    bool fits = second >= lead.second_smallest && second <= lead.second_largest;
    for (std::size_t n = 2; n < lead.length; ++n) {
      fits = fits && isContinuation(byteAt(text, place + n));
    }
    fits = fits && (lead.length != 3 || !isObeyed(text, place));
    return fits ? lead.length : 0;
  }
  return 0;
}

/// Appends a character of so many bytes, or one byte as it is written where there are none, and
/// goes on to the next.
void appendShown(const std::string& text,
                 std::size_t length,
                 std::size_t& place,
                 std::string& shown) {
  constexpr const char* kDigits = "0123456789abcdef";
  constexpr unsigned kDigitBits = 4;
  constexpr unsigned kDigitMask = 0xF;
  if (length > 0) {
    shown.append(text, place, length);
    place += length;
    return;
  }
  const Byte byte = byteAt(text, place++);
  shown += {'\\', 'x', kDigits[byte >> kDigitBits], kDigits[byte & kDigitMask]};
}

}  // namespace

std::string printable(const std::string& text) {
  std::string shown;
  shown.reserve(text.size());
  for (std::size_t place = 0; place < text.size();) {
    appendShown(text, shownLength(text, place), place, shown);
  }
  return shown;
}

std::string excerpt(const std::string& text) {
  constexpr std::size_t kLongest = 80;
  std::string shown;
  std::size_t place = 0;
  for (std::size_t characters = 0; place < text.size() && characters < kLongest; ++characters) {
    const bool is_space = text[place] == '\n' || text[place] == '\t';
    appendShown(text, is_space ? 0 : shownLength(text, place), place, shown);
  }
  return place < text.size() ? shown + "..." : shown;
}

/// Keeps what is written until the end of a line or a flush, so that no character is cut.
class PrintableOutput::Buffer : public std::streambuf {
 public:
  explicit Buffer(std::streambuf* target) : target_(target) {}

 protected:
  int_type overflow(int_type character) override {
    if (!traits_type::eq_int_type(character, traits_type::eof())) {
      pending_.push_back(traits_type::to_char_type(character));
      if (pending_.back() == '\n' && !pass()) {
        return traits_type::eof();
      }
    }
    return traits_type::not_eof(character);
  }

  std::streamsize xsputn(const char* text, std::streamsize size) override {
    pending_.append(text, static_cast<std::size_t>(size));
    const bool is_line = !pending_.empty() && pending_.back() == '\n';
    return is_line && !pass() ? 0 : size;
  }

  int sync() override {
    const bool is_passed = pass();
    return target_->pubsync() == 0 && is_passed ? 0 : -1;
  }

 private:
  /// False when the target does not take it.
  bool pass() {
    const std::string shown = printable(pending_);
    pending_.clear();
    const auto size = static_cast<std::streamsize>(shown.size());
    return target_->sputn(shown.data(), size) == size;
  }

  std::streambuf* const target_;
  std::string pending_;
};

PrintableOutput::PrintableOutput(std::ostream& stream)
    : stream_(stream), original_(stream.rdbuf()), filter_(new Buffer(original_)) {
  stream_.rdbuf(filter_.get());
}

PrintableOutput::~PrintableOutput() {
  stream_.flush();
  stream_.rdbuf(original_);
}

}  // namespace sac
