#include "file_content.hpp"

#include <algorithm>
#include <functional>
#include <string>

#include <sys/types.h>

#include <unistd.h>

namespace sac {
namespace {

constexpr std::size_t kBlock = 65536;  // holds whole pages of every size

std::size_t hashOf(std::string_view bytes) {
  return std::hash<std::string_view>()(bytes);
}

/// Reads until the block is full or there is no more; what cannot be read is as good as cut off.
std::size_t readBlock(int descriptor, std::uint64_t place, std::string& block) {
  std::size_t size = 0;
  while (size < block.size()) {
    const ssize_t count = ::pread(
        descriptor, block.data() + size, block.size() - size, static_cast<off_t>(place + size));
    if (count <= 0) {
      return size;
    }
    size += static_cast<std::size_t>(count);
  }
  return size;
}

}  // namespace

FileContent::FileContent(int descriptor, std::size_t page) : page_(page) {
  std::string block(kBlock, '\0');
  std::size_t size = kBlock;
  for (std::uint64_t place = 0; size == kBlock; place += size) {
    size = readBlock(descriptor, place, block);
    for (std::size_t begin = 0; begin < size; begin += page_) {
      const std::size_t length = std::min(page_, size - begin);
      pages_.push_back(hashOf(std::string_view(block).substr(begin, length)));
    }
  }
}

bool FileContent::mayHold(std::uint64_t place, std::string_view bytes) const {
  const std::uint64_t number = place / page_;
  return !isPage(place, bytes) || number >= pages_.size() || pages_[number] == hashOf(bytes);
}

void FileContent::put(std::uint64_t place, std::string_view bytes) {
  if (!isPage(place, bytes)) {
    is_known_ = false;
    return;
  }
  const std::uint64_t number = place / page_;
  if (number >= pages_.size()) {
    // What is passed over is written later, or another than what stands there then.
    pages_.resize(number + 1);
  }
  pages_[number] = hashOf(bytes);
}

bool FileContent::isPage(std::uint64_t place, std::string_view bytes) const {
  return bytes.size() == page_ && place % page_ == 0;
}

}  // namespace sac
