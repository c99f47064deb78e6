#pragma once

#include <atomic>
#include <cstddef>
#include <memory>
#include <utility>

#include "spherical_actuator_calibration/drivers/coil_driver.hpp"
#include "spherical_actuator_calibration/ros/node/periodic_thread.hpp"

namespace sac {

/// An amplifier and what drives it. Not to be copied: the driver keeps a reference.
struct DrivenAmplifier {
  DrivenAmplifier(const CurrentAmplifierOptions& options,
                  std::size_t coils,
                  std::unique_ptr<ModbusTransport> link)
      : transport(std::move(link)), driver(options, coils, *transport) {}

  std::unique_ptr<ModbusTransport> transport;
  CoilDriver driver;
};

/// Goes on measuring currents that were confirmed to be zero, while the program takes leave of its
/// master and ends: an amplifier may give current again until then. The first measurement that is
/// not zero is told on the standard error, where nothing of ROS is needed, and lateEndFails().
class ZeroWatch {
 public:
  /// `rate` in Hz.
  ZeroWatch(std::shared_ptr<DrivenAmplifier> amplifier, double rate);

  /// Measures for the last time. True when all measurements were zero.
  bool end();

 private:
  void look();

  std::shared_ptr<DrivenAmplifier> amplifier_;
  std::atomic<bool> is_zero_{true};
  PeriodicThread thread_;  ///< last, so that it ends first
};

}  // namespace sac
