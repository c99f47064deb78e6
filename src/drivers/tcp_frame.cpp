#include "tcp_frame.hpp"

#include <algorithm>
#include <array>

namespace sac {
namespace {

using Bytes = std::vector<std::uint8_t>;

constexpr std::uint8_t kReadHolding = 3;
constexpr std::uint8_t kReadInput = 4;
constexpr std::uint8_t kWrite = 16;
constexpr std::uint8_t kWriteAndRead = 23;
constexpr std::uint8_t kException = 0x80;  ///< is set in the function of an answer

constexpr std::size_t kHeader = 7;  // [byte]
constexpr std::size_t kExceptionSize = kHeader + 2;
constexpr unsigned kByte = 8;  // [bit]

void append(Bytes& bytes, std::size_t word) {
  bytes.push_back(static_cast<std::uint8_t>((word >> kByte) & 0xffU));
  bytes.push_back(static_cast<std::uint8_t>(word & 0xffU));
}

void append(Bytes& bytes, int word) {
  append(bytes, static_cast<std::size_t>(word));
}

void append(Bytes& bytes, const std::vector<std::uint16_t>& words) {
  bytes.push_back(static_cast<std::uint8_t>(2 * words.size()));
  for (const std::uint16_t word : words) {
    append(bytes, std::size_t{word});
  }
}

/// What stands at a place of an answer.
std::string partAt(std::size_t place) {
  constexpr std::array<const char*, kHeader + 1> kParts{"transaction id",
                                                        "transaction id",
                                                        "protocol id",
                                                        "protocol id",
                                                        "length",
                                                        "length",
                                                        "unit id",
                                                        "function"};
  return place < kParts.size() ? kParts.at(place) : "registers";
}

}  // namespace

TcpFrame TcpFrame::read(std::uint16_t transaction, const RegisterRequest& wanted) {
  TcpFrame frame(transaction, wanted.unit);
  frame.words_read_ = static_cast<std::size_t>(wanted.count);
  Bytes body{wanted.table == RegisterTable::kHolding ? kReadHolding : kReadInput};
  append(body, wanted.address);
  append(body, wanted.count);
  frame.finish(body);
  return frame;
}

TcpFrame TcpFrame::write(std::uint16_t transaction,
                         int unit,
                         int address,
                         const std::vector<std::uint16_t>& words) {
  TcpFrame frame(transaction, unit);
  Bytes body{kWrite};
  append(body, address);
  append(body, words.size());
  append(body, words);
  frame.finish(body);
  return frame;
}

TcpFrame TcpFrame::writeAndRead(std::uint16_t transaction,
                                int address,
                                const std::vector<std::uint16_t>& words,
                                const RegisterRequest& wanted) {
  TcpFrame frame(transaction, wanted.unit);
  frame.words_read_ = static_cast<std::size_t>(wanted.count);
  Bytes body{kWriteAndRead};
  append(body, wanted.address);
  append(body, wanted.count);
  append(body, address);
  append(body, words.size());
  append(body, words);
  frame.finish(body);
  return frame;
}

std::vector<std::uint8_t> TcpFrame::header(std::size_t length) const {
  Bytes bytes;
  append(bytes, std::size_t{transaction_});
  append(bytes, 0);
  append(bytes, length + 1);
  bytes.push_back(static_cast<std::uint8_t>(unit_));
  return bytes;
}

void TcpFrame::finish(const Bytes& body) {
  bytes_ = header(body.size());
  bytes_.insert(bytes_.end(), body.begin(), body.end());
  // A device repeats what it was told to write: function, address and count. What it reads comes
  // after function and number of bytes.
  constexpr std::ptrdiff_t kRepeated = 5;
  Bytes begin(body.begin(), body.begin() + (words_read_ > 0 ? 1 : kRepeated));
  if (words_read_ > 0) {
    begin.push_back(static_cast<std::uint8_t>(2 * words_read_));
  }
  expected_ = header(begin.size() + 2 * words_read_);
  expected_.insert(expected_.end(), begin.begin(), begin.end());
}

std::string TcpFrame::defect(const Bytes& answer) const {
  Bytes expected = expected_;
  std::size_t size = expected_.size() + 2 * words_read_;
  if (answer.size() > kHeader && (answer[kHeader] & kException) != 0) {
    expected = header(2);
    expected.push_back(expected_[kHeader] | kException);
    size = kExceptionSize;
  }
  const auto common = std::min(expected.size(), answer.size());
  const auto differs = std::mismatch(
      expected.begin(), expected.begin() + static_cast<std::ptrdiff_t>(common), answer.begin());
  if (differs.second != answer.begin() + static_cast<std::ptrdiff_t>(common)) {
    return "a wrong " + partAt(static_cast<std::size_t>(differs.second - answer.begin()));
  }
  return answer.size() == size ? "" : "a wrong length";
}

std::optional<int> TcpFrame::exception(const Bytes& answer) const {
  const bool is_one = answer.size() == kExceptionSize && (answer[kHeader] & kException) != 0;
  return is_one ? std::optional<int>(answer.back()) : std::nullopt;
}

std::vector<std::uint16_t> TcpFrame::words(const Bytes& answer) const {
  std::vector<std::uint16_t> words(words_read_);
  auto byte = answer.begin() + static_cast<std::ptrdiff_t>(expected_.size());
  for (std::uint16_t& word : words) {
    const unsigned high = *byte++;
    const unsigned low = *byte++;
    word = static_cast<std::uint16_t>((high << kByte) | low);
  }
  return words;
}

}  // namespace sac
