#pragma once

#include <cstddef>
#include <vector>

#include <Eigen/Core>

#include "spherical_actuator_calibration/measurement/stamp_interval.hpp"

namespace sac {

/// Recent measurements of one stream, oldest first: a stamp and `width` numbers each, stored one
/// after the other. Stamps increase strictly. Once it has grown to the longest span held, adding
/// allocates nothing.
class StreamBuffer {
 public:
  /// Entries [first, last) of the buffer; valid until it changes.
  struct Range {
    std::size_t first = 0;
    std::size_t last = 0;
    std::size_t size() const { return last - first; }
  };

  explicit StreamBuffer(std::size_t width) : width_(width) {}

  std::size_t width() const { return width_; }
  std::size_t size() const { return stamps_.size() - head_; }
  bool empty() const { return size() == 0; }

  Stamp stamp(std::size_t index) const { return stamps_[head_ + index]; }
  Stamp newest() const { return stamps_.back(); }
  /// The `width` numbers of one entry.
  Eigen::Map<const Eigen::VectorXd> values(std::size_t index) const {
    return Eigen::Map<const Eigen::VectorXd>(values_.data() + (head_ + index) * width_,
                                             static_cast<Eigen::Index>(width_));
  }

  /// Appends `width` numbers. `stamp` must be newer than newest().
  void push(Stamp stamp, const double* values);
  /// Forgets everything older than `stamp`.
  void dropBefore(Stamp stamp);
  void clear();

  /// Entries whose stamp lies in the interval, ends included.
  Range within(const StampInterval& interval) const;

 private:
  void compact();

  std::size_t width_;
  std::size_t head_ = 0;  ///< entries before it are forgotten
  std::vector<Stamp> stamps_;
  std::vector<double> values_;
};

/// The four streams that samples are made from.
struct MeasurementBuffers {
  explicit MeasurementBuffers(std::size_t coils) : currents(coils) {}

  StreamBuffer joints{3};  ///< raw sensor angles [rad]
  /// Where the rotor has none, `joints` holds the sum of the rotation vectors from each measured
  /// orientation to the next, stator frame: what moves with the rotor, in any pose alike.
  bool has_joints = true;
  /// Resolution of the readings, as they tell it (ReadingSteps) [rad]; 0: none.
  Eigen::Vector3d joint_step = Eigen::Vector3d::Zero();
  StreamBuffer orientations{4};  ///< unit quaternion q_stator_rotor as x, y, z, w
  StreamBuffer torques{3};       ///< rotor frame [N·m]
  StreamBuffer currents;         ///< per coil [A]
};

}  // namespace sac
