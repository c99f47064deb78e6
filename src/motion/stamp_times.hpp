#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

#include "spherical_actuator_calibration/measurement/sample.hpp"

namespace sac {

/// Stamps of a stream in seconds from an origin, made as they are asked for: a list of them would
/// be as large as the stamps.
class StampTimes {
 public:
  /// Keeps a reference. `stamps`: increasing.
  StampTimes(Stamp origin, const std::vector<Stamp>& stamps) : origin_(origin), stamps_(&stamps) {}

  std::size_t size() const { return stamps_->size(); }
  bool empty() const { return stamps_->empty(); }
  double operator[](std::size_t n) const { return secondsBetween(origin_, (*stamps_)[n]); }
  double front() const { return (*this)[0]; }
  double back() const { return (*this)[size() - 1]; }
  /// The first that is not before a time; size(): none.
  std::size_t firstFrom(double time) const {
    return static_cast<std::size_t>(std::lower_bound(stamps_->begin(),
                                                     stamps_->end(),
                                                     time,
                                                     [this](Stamp stamp, double at) {
                                                       return secondsBetween(origin_, stamp) < at;
                                                     }) -
                                    stamps_->begin());
  }
  /// The first that is later than a time; size(): none.
  std::size_t firstAfter(double time) const {
    return static_cast<std::size_t>(std::upper_bound(stamps_->begin(),
                                                     stamps_->end(),
                                                     time,
                                                     [this](double at, Stamp stamp) {
                                                       return at < secondsBetween(origin_, stamp);
                                                     }) -
                                    stamps_->begin());
  }

 private:
  Stamp origin_;
  const std::vector<Stamp>* stamps_;
};

}  // namespace sac
