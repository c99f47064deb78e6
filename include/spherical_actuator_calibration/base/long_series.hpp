#pragma once

#include <algorithm>
#include <cstddef>
#include <initializer_list>
#include <iterator>
#include <new>
#include <type_traits>
#include <utility>

#include "spherical_actuator_calibration/base/paged_memory.hpp"

namespace sac {

/// A list that grows at its end, and may become longer than what a process wants in its memory: see
/// PagedMemory. Used like std::vector; values must be such that their bytes may be moved. Iterators
/// are pointers, and last until the list grows: pages of what they pass leave the memory later than
/// of what is asked for by its place.
template <typename T>
class LongSeries {
  static_assert(std::is_trivially_destructible_v<T>);

 public:
  using value_type = T;
  using iterator = T*;
  using const_iterator = const T*;

  LongSeries() = default;
  LongSeries(std::initializer_list<T> values) : LongSeries(values.begin(), values.end()) {}
  LongSeries(std::size_t count, const T& value) {
    for (std::size_t n = 0; n < count; ++n) {
      push_back(value);
    }
  }
  template <typename Iterator, typename = typename std::iterator_traits<Iterator>::pointer>
  LongSeries(Iterator first, Iterator last) {
    for (; first != last; ++first) {
      push_back(*first);
    }
  }
  LongSeries(const LongSeries& other) : LongSeries() {
    memory_.reserve(other.size_ * sizeof(T));
    for (std::size_t n = 0; n < other.size_; ++n) {
      push_back(other[n]);
    }
  }
  LongSeries(LongSeries&& other) noexcept
      : memory_(std::move(other.memory_)), size_(std::exchange(other.size_, 0)) {}
  LongSeries& operator=(LongSeries other) noexcept {
    std::swap(memory_, other.memory_);
    std::swap(size_, other.size_);
    return *this;
  }
  ~LongSeries() = default;

  std::size_t size() const { return size_; }
  bool empty() const { return size_ == 0; }
  const T& operator[](std::size_t n) const { return *at(n); }
  T& operator[](std::size_t n) { return *at(n); }
  const T& front() const { return *at(0); }
  T& front() { return *at(0); }
  const T& back() const { return *at(size_ - 1); }
  T& back() { return *at(size_ - 1); }

  const T* begin() const { return data(); }
  const T* end() const { return data() + size_; }
  T* begin() { return data(); }
  T* end() { return data() + size_; }

  // Named as in std::vector, for its algorithms.
  void push_back(const T& value) {  // NOLINT(readability-identifier-naming)
    T kept(value);                  // it may be of this list, which may move
    makeRoom(size_ + 1);
    new (at(size_)) T(std::move(kept));
    ++size_;
  }
  template <typename... Arguments>
  T& emplace_back(Arguments&&... arguments) {  // NOLINT(readability-identifier-naming)
    push_back(T(std::forward<Arguments>(arguments)...));
    return back();
  }
  /// Leaves the first ones, of as many at the least.
  void truncate(std::size_t count) { size_ = count; }
  void clear() { size_ = 0; }

  friend bool operator==(const LongSeries& one, const LongSeries& other) {
    return std::equal(one.begin(), one.end(), other.begin(), other.end());
  }
  friend bool operator!=(const LongSeries& one, const LongSeries& other) { return !(one == other); }

 private:
  T* data() const { return reinterpret_cast<T*>(memory_.data()); }
  T* at(std::size_t n) const {
    memory_.touch(n * sizeof(T));
    return data() + n;
  }
  void makeRoom(std::size_t count) {
    if (count * sizeof(T) > memory_.capacity()) {
      memory_.reserve((count + count / 2 + 8) * sizeof(T));
    }
  }

  PagedMemory memory_;
  std::size_t size_ = 0;
};

}  // namespace sac
