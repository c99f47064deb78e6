#pragma once

#include <cstddef>
#include <vector>

#include "spherical_actuator_calibration/measurement/sample.hpp"

namespace sac {

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
  /// Entries whose values rise strictly from front to back: the front is the smallest.
  struct Queue {
    std::vector<Entry> entries;
    std::size_t head = 0;  ///< entries before it are forgotten

    bool empty() const { return head == entries.size(); }
    double front() const { return entries[head].value; }
    void push(const Entry& entry);
    void dropBefore(Stamp stamp);
    void clear();
  };

  Queue smallest_;
  Queue largest_;  ///< of the negated values
};

}  // namespace sac
