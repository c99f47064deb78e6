#include "tcp_frame.hpp"

#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace sac {
namespace {

using Bytes = std::vector<std::uint8_t>;

constexpr std::uint16_t kTransaction = 0x1502;

/// A request, its bytes, and the right answer (Modbus application protocol V1.1b3, the examples of
/// functions 3, 4, 16 and 23).
struct StandardFrame {
  const char* what;
  TcpFrame frame;
  Bytes bytes;
  Bytes answer;
  std::vector<std::uint16_t> words;
};

std::vector<StandardFrame> standardFrames() {
  return {
      {"read holding registers",
       TcpFrame::read(kTransaction, {17, RegisterTable::kHolding, 0x6b, 3}),
       {0x15, 2, 0, 0, 0, 6, 17, 3, 0, 0x6b, 0, 3},
       {0x15, 2, 0, 0, 0, 9, 17, 3, 6, 2, 0x2b, 0, 0, 0, 0x64},
       {0x22b, 0, 0x64}},
      {"read an input register",
       TcpFrame::read(kTransaction, {17, RegisterTable::kInput, 8, 1}),
       {0x15, 2, 0, 0, 0, 6, 17, 4, 0, 8, 0, 1},
       {0x15, 2, 0, 0, 0, 5, 17, 4, 2, 0, 0x0a},
       {0x0a}},
      {"write registers",
       TcpFrame::write(kTransaction, 17, 1, {0x0a, 0x102}),
       {0x15, 2, 0, 0, 0, 11, 17, 16, 0, 1, 0, 2, 4, 0, 0x0a, 1, 2},
       {0x15, 2, 0, 0, 0, 6, 17, 16, 0, 1, 0, 2},
       {}},
      {"write and read",
       TcpFrame::writeAndRead(
           kTransaction, 0x0e, {0xff, 0xff, 0xff}, {17, RegisterTable::kHolding, 3, 2}),
       {0x15, 2, 0, 0, 0, 17, 17, 23, 0, 3, 0, 2, 0, 0x0e, 0, 3, 6, 0, 0xff, 0, 0xff, 0, 0xff},
       {0x15, 2, 0, 0, 0, 7, 17, 23, 4, 0, 0xfe, 0x0a, 0xcd},
       {0xfe, 0xacd}},
  };
}

TEST(TcpFrame, IsWhatTheStandardSays) {
  for (const StandardFrame& one : standardFrames()) {
    EXPECT_EQ(one.frame.bytes(), one.bytes) << one.what;
    EXPECT_EQ(one.frame.defect(one.answer), "") << one.what;
    EXPECT_EQ(one.frame.exception(one.answer), std::nullopt) << one.what;
    EXPECT_EQ(one.frame.words(one.answer), one.words) << one.what;
  }
}

TEST(TcpFrame, TakesNoOtherAnswer) {
  for (const StandardFrame& one : standardFrames()) {
    // All but what was read is known before.
    const std::size_t known = one.answer.size() - 2 * one.words.size();
    for (std::size_t place = 0; place < known; ++place) {
      for (const unsigned flipped : {0x01U, 0x80U}) {
        Bytes answer = one.answer;
        answer[place] = static_cast<std::uint8_t>(answer[place] ^ flipped);
        EXPECT_NE(one.frame.defect(answer), "") << one.what << ", byte " << place;
      }
    }
    Bytes answer = one.answer;
    answer.push_back(0);
    EXPECT_EQ(one.frame.defect(answer), "a wrong length") << one.what;
    while (!answer.empty()) {
      answer.pop_back();
      EXPECT_EQ(one.frame.defect(answer).empty(), answer == one.answer) << one.what;
    }
  }
}

TEST(TcpFrame, TakesAnExceptionOfTheSameUnitAndFunction) {
  for (const StandardFrame& one : standardFrames()) {
    Bytes answer(one.answer.begin(), one.answer.begin() + 8);
    answer[5] = 3;
    answer[7] |= 0x80;
    EXPECT_NE(one.frame.defect(answer), "") << one.what << ", without its code";
    answer.push_back(2);
    EXPECT_EQ(one.frame.defect(answer), "") << one.what;
    EXPECT_EQ(one.frame.exception(answer), 2) << one.what;
    ++answer[6];
    EXPECT_EQ(one.frame.defect(answer), "a wrong unit id") << one.what;
  }
}

}  // namespace
}  // namespace sac
