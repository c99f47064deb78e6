#include "spherical_actuator_calibration/base/printable_text.hpp"

#include <sstream>
#include <string>

#include <gtest/gtest.h>

namespace sac {
namespace {

TEST(PrintableText, KeepsWhatIsText) {
  const std::string text = "Spule 3: 2.5 µm, R̂ → ∞ 𝛼\n\tend";
  EXPECT_EQ(printable(text), text);
}

TEST(PrintableText, ShowsWhatATerminalWouldObey) {
  EXPECT_EQ(printable("\x1b[31mred\x07\r"), "\\x1b[31mred\\x07\\x0d");
  EXPECT_EQ(printable(std::string("a\0b", 3)), "a\\x00b");
  EXPECT_EQ(printable("\x7f"), "\\x7f");
  // A control sequence introducer in one character of UTF-8, and in one byte.
  EXPECT_EQ(printable("\xc2\x9b"
                      "1m"),
            "\\xc2\\x9b1m");
  EXPECT_EQ(printable("\x9b"), "\\x9b");
}

TEST(PrintableText, ShowsBytesThatAreNoCharacter) {
  EXPECT_EQ(printable("\xc3"), "\\xc3");
  EXPECT_EQ(printable("\xe2\x82x"), "\\xe2\\x82x");
  EXPECT_EQ(printable("\xc0\xaf"), "\\xc0\\xaf");           // an overlong "/"
  EXPECT_EQ(printable("\xed\xa0\x80"), "\\xed\\xa0\\x80");  // half of a surrogate
}

TEST(PrintableText, FiltersAStreamAsLongAsItLives) {
  std::ostringstream out;
  {
    const PrintableOutput filter(out);
    out << "a\x1b" << 'c' << 1.5 << "\xc3";
    out << "\xa9\n";
    out << "\x07" << std::flush << "x";
  }
  out << "\x1b";
  EXPECT_EQ(out.str(), "a\\x1bc1.5\xc3\xa9\n\\x07x\x1b");
}

}  // namespace
}  // namespace sac
