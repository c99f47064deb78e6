#pragma once

#include <cstddef>
#include <cstdint>
#include <mutex>

#include <ros/callback_queue.h>
#include <ros/node_handle.h>
#include <ros/publisher.h>
#include <ros/spinner.h>
#include <ros/time.h>
#include <ros/wall_timer.h>

namespace sac {

/// Commands one coil, in a thread of its own: faster than the coil driver's watchdog, also while a
/// window is busy. It commands only while a coil is excited, so that others may at other times, and
/// never for longer than it was told: a panel that hangs does not keep a coil warm.
class CoilExciter {
 public:
  explicit CoilExciter(const ros::NodeHandle& node);
  ~CoilExciter();
  CoilExciter(const CoilExciter&) = delete;
  CoilExciter& operator=(const CoilExciter&) = delete;

  /// `coil` of `coils`, counted from 1, carries `current` [A] for `seconds` at most; 0: none does.
  void excite(std::uint32_t coil, std::size_t coils, double current, double seconds);
  /// Zero at once.
  void stop() { excite(0, 0, 0.0, 0.0); }
  /// The coil that is excited, counted from 1; 0: none.
  std::uint32_t coil() const;

 private:
  void beat();
  void publish() const;

  mutable std::mutex mutex_;  ///< of what follows
  ros::Publisher publisher_;
  std::uint32_t coil_ = 0;
  std::size_t coils_ = 0;
  double current_ = 0.0;
  ros::SteadyTime end_;
  ros::CallbackQueue queue_;
  ros::WallTimer timer_;
  ros::AsyncSpinner thread_;
};

}  // namespace sac
