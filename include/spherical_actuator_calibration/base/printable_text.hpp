#pragma once

#include <memory>
#include <ostream>
#include <string>

namespace sac {

/// Text that a terminal shows and does not obey: control characters but line feed and tab, those
/// that break lines or turn the direction of writing, and bytes that are no UTF-8, become "\x1b".
/// Names and messages from files, recordings and other nodes may hold such.
std::string printable(const std::string& text);

/// What a message quotes of a text from outside: printable, in one line, at most 80 characters and
/// "...".
std::string excerpt(const std::string& text);

/// As long as it lives, all that is written to a stream is printable().
class PrintableOutput {
 public:
  explicit PrintableOutput(std::ostream& stream);
  ~PrintableOutput();
  PrintableOutput(const PrintableOutput&) = delete;
  PrintableOutput& operator=(const PrintableOutput&) = delete;

 private:
  class Buffer;

  std::ostream& stream_;
  std::streambuf* const original_;
  const std::unique_ptr<Buffer> filter_;
};

}  // namespace sac
