#pragma once

#include <cstddef>
#include <vector>

#include "spherical_actuator_calibration/core/sample.hpp"

namespace spherical_actuator_calibration {

/// Smallest and largest of the values in a moving window, by monotonic queues: amortised constant
/// time per value, no allocation once the queues have grown to the window.
class SlidingExtremes {
 public:
  /// Adds a value; stamps increase.
  void add(Stamp stamp, double value);
  /// Forgets the values older than `stamp`.
  void dropBefore(Stamp stamp);
  void clear();

  /// Largest minus smallest value; at least one must be held.
  double spread() const;

 private:
  struct Entry {
    Stamp stamp;
    double value;
  };
  /// Queue of entries whose values rise (or fall) strictly from front to back.
  struct Queue {
    std::vector<Entry> entries;
    std::size_t head = 0;

    bool empty() const { return head == entries.size(); }
    void dropBefore(Stamp stamp);
    void push(const Entry& entry);
    void clear();
  };

  Queue rising_;   ///< front: the smallest value
  Queue falling_;  ///< front: the largest value
};

}  // namespace spherical_actuator_calibration
