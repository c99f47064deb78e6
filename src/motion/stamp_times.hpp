#pragma once

#include <cstddef>

#include "spherical_actuator_calibration/base/long_series.hpp"
#include "spherical_actuator_calibration/measurement/sample.hpp"

namespace sac {

/// Stamps of a stream in seconds from an origin, made as they are asked for: a list of them would
/// be as large as the stamps.
class StampTimes {
 public:
  /// Keeps a reference. `stamps`: increasing.
  StampTimes(Stamp origin, const LongSeries<Stamp>& stamps) : origin_(origin), stamps_(&stamps) {}

  std::size_t size() const { return stamps_->size(); }
  bool empty() const { return stamps_->empty(); }
  double operator[](std::size_t n) const { return secondsBetween(origin_, (*stamps_)[n]); }
  double front() const { return (*this)[0]; }
  double back() const { return (*this)[size() - 1]; }
  /// The first that is not before a time; size(): none.
  std::size_t firstFrom(double time) const {
    return firstThat([time](double at) { return at >= time; });
  }
  /// The first that is later than a time; size(): none.
  std::size_t firstAfter(double time) const {
    return firstThat([time](double at) { return at > time; });
  }

 private:
  /// By halves, as of those behind one of which it holds it holds, too.
  template <typename Holds>
  std::size_t firstThat(const Holds& holds) const {
    std::size_t begin = 0;
    std::size_t end = size();
    while (begin < end) {
      const std::size_t middle = begin + (end - begin) / 2;
      if (holds((*this)[middle])) {
        end = middle;
      } else {
        begin = middle + 1;
      }
    }
    return begin;
  }

  Stamp origin_;
  const LongSeries<Stamp>* stamps_;
};

}  // namespace sac
