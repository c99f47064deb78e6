#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "spherical_actuator_calibration/actuator/description_file.hpp"
#include "spherical_actuator_calibration/base/atomic_file.hpp"
#include "spherical_actuator_calibration/emulation/session_simulator.hpp"
#include "spherical_actuator_calibration/measurement/registration.hpp"

namespace sac {

/// Names of the tf2 frames of one actuator.
struct FrameNames {
  std::string stator = "stator";
  std::string rotor = "rotor";
  std::string tracker = "tracker";
  std::string marker = "marker";
  std::string ft_sensor = "ft_sensor";
};

/// Of the chunks of a recording.
enum class BagCompression { kNone, kLz4 };

/// How a session is recorded.
struct SessionBagOptions {
  std::string ns = "/actuator";  ///< namespace of the actuator's topics
  FrameNames frames;
  Registration registration;  ///< recorded on /tf_static, and used for the measured_* topics
  Stamp begin = 0;            ///< of the session: stamp of what is latched
  BagCompression compression = BagCompression::kLz4;
  OverwritePolicy overwrite = OverwritePolicy::kRefuse;
};

/// Records the measurements of a session in a rosbag, as a recorder on a live system would: the raw
/// streams, measured_orientation and measured_torque as the bridge derives them, at the start the
/// description, its parameters, and the registrations on /tf_static, all latched. Each message is
/// recorded a little later than its stamp, by the latency of its stream.
///
/// The bag is written under a temporary name ("….active") and has its own from close() on; without
/// close() nothing remains. Throws DataError, naming the file, when it exists already and the
/// policy refuses, or when the disk does not take it.
class SessionBagWriter : public MeasurementSink {
 public:
  SessionBagWriter(const std::string& path,
                   const CalibratedDescription& nominal,
                   const SessionBagOptions& options);
  ~SessionBagWriter() override;

  void add(const JointMeasurement& measurement) override;
  void add(const MarkerPoseMeasurement& measurement) override;
  void add(const WrenchMeasurement& measurement) override;
  void add(const CurrentMeasurement& measurement) override;

  /// Completes the bag and gives it its name. Call once, after the last measurement.
  void close();

  /// Messages recorded so far.
  std::uint64_t messages() const;

 private:
  class Recording;
  std::unique_ptr<Recording> recording_;
};

}  // namespace sac
