#pragma once

#include <cstddef>
#include <vector>

#include <Eigen/Core>

#include "spherical_actuator_calibration/motion/motion_streams.hpp"

namespace sac {

/// Integral of currents over an interval, with weights that rise from 0 to 1, and that fall.
struct HatSums {
  Eigen::ArrayXd rising;   ///< [A·s]
  Eigen::ArrayXd falling;  ///< [A·s]
};

/// Currents that follow commands by a lag of first order, step by step in time.
class FollowedCommands {
 public:
  /// Keeps references. `times`: of the commands, increasing [s]; each acts later by the delay.
  FollowedCommands(const std::vector<double>& times,
                   const StreamCurrents& commands,
                   double delay,
                   double lag);

  /// At a time when the currents have come to what is commanded.
  void start(double time);
  /// On to a later time.
  void advance(double time);
  /// The same, with the sums of what is between.
  void advance(double time, HatSums& sums);
  const Eigen::ArrayXd& current() const { return current_; }

 private:
  /// Piece by piece, each told to a visitor before it is passed.
  template <typename Visitor>
  void pass(double time, const Visitor& visitor);
  void approach(double time);
  void add(double end, double begin_of_all, double length_of_all, HatSums& sums) const;
  void take();

  const std::vector<double>& times_;
  const StreamCurrents& commands_;
  double delay_;
  double lag_;
  std::size_t next_ = 0;  ///< command that acts next
  double time_ = 0.0;
  Eigen::ArrayXd command_;  ///< that acts
  Eigen::ArrayXd current_;
};

}  // namespace sac
