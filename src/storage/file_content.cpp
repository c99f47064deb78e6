#include "file_content.hpp"

#include <functional>
#include <string_view>

#include <sys/types.h>

#include <unistd.h>

namespace sac {
namespace {

constexpr std::size_t kBlock = 65536;

// Places in the header of an SQLite database, where numbers have their highest byte first.
constexpr std::size_t kHeader = 100;
constexpr std::size_t kPageSize = 16;
constexpr std::size_t kChangeCounter = 24;
constexpr std::size_t kPageCount = 28;
constexpr std::size_t kVersionValidFor = 92;

constexpr std::uint32_t kLargestPage = 65536;  // two bytes hold it as 1

}  // namespace

FileContent::FileContent(int descriptor) {
  std::string block(kBlock, '\0');
  for (;;) {
    const ssize_t count =
        ::pread(descriptor, block.data(), block.size(), static_cast<off_t>(size_));
    if (count <= 0) {  // what cannot be read is as good as cut off
      return;
    }
    const std::string_view bytes(block.data(), static_cast<std::size_t>(count));
    if (blocks_.empty()) {
      header_ = bytes.substr(0, kHeader);
    }
    blocks_.push_back(std::hash<std::string_view>()(bytes));
    size_ += bytes.size();
  }
}

bool FileContent::follows(const FileContent& before) const {
  if (*this == before) {
    return true;
  }
  return number(kChangeCounter) == before.number(kChangeCounter) + 1 &&
         number(kVersionValidFor) == number(kChangeCounter) && size_ >= wholeSize();
}

std::uint64_t FileContent::wholeSize() const {
  const std::uint32_t page = number(kPageSize, sizeof(std::uint16_t));
  return std::uint64_t{page == 1 ? kLargestPage : page} * number(kPageCount);
}

std::uint32_t FileContent::number(std::size_t place, std::size_t bytes) const {
  if (header_.size() < place + bytes) {
    return 0;
  }
  constexpr unsigned kBitsOfByte = 8;
  std::uint32_t result = 0;
  for (const char byte : header_.substr(place, bytes)) {
    result = result << kBitsOfByte | static_cast<unsigned char>(byte);
  }
  return result;
}

}  // namespace sac
