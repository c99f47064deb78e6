#include "spherical_actuator_calibration/base/paged_memory.hpp"

#include <cstring>
#include <new>
#include <utility>

#include "mapped_file.hpp"

namespace sac {
namespace {

/// So many bytes at the most are in memory without a file.
constexpr std::size_t kFew = std::size_t{4} << 20U;

constexpr std::align_val_t kAlignment{64};

}  // namespace

PagedMemory::PagedMemory() = default;

PagedMemory::PagedMemory(PagedMemory&& other) noexcept {
  swap(other);
}

PagedMemory& PagedMemory::operator=(PagedMemory&& other) noexcept {
  PagedMemory moved(std::move(other));
  swap(moved);
  return *this;
}

PagedMemory::~PagedMemory() {
  if (file_ == nullptr) {
    ::operator delete(data_, kAlignment);
  }
}

void PagedMemory::swap(PagedMemory& other) noexcept {
  std::swap(data_, other.data_);
  std::swap(capacity_, other.capacity_);
  std::swap(file_, other.file_);
  std::swap(touched_, other.touched_);
}

void PagedMemory::reserve(std::size_t bytes) {
  if (bytes <= capacity_) {
    return;
  }
  if (bytes <= kFew || !reserveInFile(bytes)) {
    reserveInMemory(bytes);
  }
}

bool PagedMemory::reserveInFile(std::size_t bytes) {
  static_assert(MappedFile::kPiece == std::size_t{1} << kPieceBits);
  if (file_ != nullptr) {
    if (!file_->grow(bytes)) {
      return false;
    }
  } else {
    std::unique_ptr<MappedFile> file = MappedFile::make(bytes);
    if (file == nullptr) {
      return false;
    }
    PagedMemory moved;
    moved.file_ = std::move(file);
    if (capacity_ > 0) {
      std::memcpy(moved.file_->data(), data_, capacity_);
    }
    swap(moved);
  }
  data_ = file_->data();
  capacity_ = bytes;
  touched_ = file_->touched();
  return true;
}

void PagedMemory::reserveInMemory(std::size_t bytes) {
  PagedMemory moved;
  moved.data_ = static_cast<char*>(::operator new(bytes, kAlignment));
  moved.capacity_ = bytes;
  if (capacity_ > 0) {
    std::memcpy(moved.data_, data_, capacity_);
  }
  swap(moved);
}

void PagedMemory::countTouched(std::size_t piece) const {
  file_->touch(piece);
}

}  // namespace sac
