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

TEST(PrintableText, ShowsWhatTurnsOrBreaksALine) {
  EXPECT_EQ(printable("\u202egnp.exe"), "\\xe2\\x80\\xaegnp.exe");
  for (const char* sign : {"\u200e", "\u200f", "\u2028", "\u2029", "\u202a", "\u2066", "\u2069"}) {
    EXPECT_EQ(printable(sign).size(), 12U) << sign;
  }
  for (const char* sign : {"\u200d", "\u2010", "\u2027", "\u202f", "\u2065", "\u206a", "\u1028"}) {
    EXPECT_EQ(printable(sign), sign);
  }
}

TEST(PrintableText, QuotesOneShortLine) {
  EXPECT_EQ(excerpt("coil 3: 2.5 µm"), "coil 3: 2.5 µm");
  EXPECT_EQ(excerpt("a\nFATAL: forged\tline"), "a\\x0aFATAL: forged\\x09line");
  EXPECT_EQ(excerpt(std::string(80, 'x')), std::string(80, 'x'));
  EXPECT_EQ(excerpt(std::string(81, 'x')), std::string(80, 'x') + "...");
  std::string wide;
  for (int n = 0; n < 100; ++n) {
    wide += "µ";
  }
  EXPECT_EQ(excerpt(wide), wide.substr(0, 160) + "...");
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
