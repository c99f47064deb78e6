#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "spherical_actuator_calibration/measurement/measurements.hpp"
#include "spherical_actuator_calibration/measurement/sample.hpp"
#include "spherical_actuator_calibration/streams/dwell_detector.hpp"
#include "spherical_actuator_calibration/streams/reading_steps.hpp"
#include "spherical_actuator_calibration/streams/sample_builder_options.hpp"
#include "spherical_actuator_calibration/streams/sample_builder_report.hpp"
#include "spherical_actuator_calibration/streams/stamp_filter.hpp"
#include "spherical_actuator_calibration/streams/stream_buffer.hpp"

namespace sac {

class RepeatedSamples;

/// Where a capture on demand stands.
struct CaptureProgress {
  enum class State {
    kWaiting,  ///< more measurements are needed; `message` says what is missing
    kDone,
    kRefused,  ///< there will be none; `message` says why
  };
  State state = State::kWaiting;
  std::optional<Sample> sample;  ///< with kDone, id 0
  std::string message;           ///< a sentence; with kDone what limits the sample, or empty
};

/// Makes samples out of streams of stamped measurements: one per dwell and current pattern.
///
/// The samples depend on the measurements and their stamps only, not on how the streams interleave
/// on arrival, as long as no stream is behind another by `stream_timeout` and no clock is reset. A
/// dwell is evaluated when every stream has passed its end, or when the newest stamp of any stream
/// has passed it by `stream_timeout`. Memory is bounded by `largest_dwell`.
///
/// A reset of a stream's clock ends the present dwell of all streams and forgets what they held.
class SampleBuilder {
 public:
  /// `coils`: number of coils; with 0, currents are ignored. Throws ConfigError when the options
  /// are not valid. Without joints their measurements are ignored, and the measured orientations
  /// tell where the rotor is and when it rests; see trackedSample(). That of a dwell is averaged
  /// over all of its rest, so that its samples share the error.
  SampleBuilder(const SampleBuilderOptions& options, std::size_t coils, bool has_joints = true);
  SampleBuilder(const SampleBuilder&) = delete;
  SampleBuilder& operator=(const SampleBuilder&) = delete;
  ~SampleBuilder();

  /// Samples are made of the measurements that these were made of, until finish(): in a recording
  /// of the streams they come out the same, with their ids. Other options than those of then act:
  /// what does not rest or is not steady by them is left out. Without any, every dwell makes
  /// samples again. To be called where no measurement was added since the begin or finish().
  /// `taken` must tell their dwell.
  void repeat(const std::vector<Sample>& taken);

  void add(const JointMeasurement& measurement);
  void add(const OrientationMeasurement& measurement);
  void add(const TorqueMeasurement& measurement);
  void add(const CurrentMeasurement& measurement);

  /// No more measurements follow: evaluates what is left. Measurements may be added afterwards, in
  /// another base of time.
  void finish();

  /// One sample of the present dwell, averaged over `duration` seconds from stamp `from` on, or
  /// from where rotor and currents have settled. Where measurements of the dwell came too late, it
  /// counts as a dwell that begins after them. The sample depends on the measurements up to its end
  /// and `guard_before_motion` only, so that repeat() finds it again. Ask again while it waits; it
  /// waits no longer than the rotor may need to come to rest (kPatience) and refuses then. Changes
  /// nothing.
  CaptureProgress capture(Stamp from, double duration) const;
  /// How long a capture waits for rest and for steady currents, in seconds of stamps.
  static constexpr double kPatience = 2.0;

  /// Newest accepted stamp of all streams, since the last reset of a clock.
  std::optional<Stamp> newest() const { return newest_; }

  /// Samples made since the last call, ids counted from 1 in the order of their stamps.
  std::vector<Sample> takeSamples();

  /// What was received, dropped and discarded so far.
  const SampleBuilderReport& report() const { return report_; }

 private:
  /// One stream: what came, what of it was good, and what of that is still needed.
  struct Stream {
    StreamStatistics* statistics = nullptr;
    StreamBuffer* buffer = nullptr;
    StampFilter filter;
    std::optional<Stamp> horizon;  ///< newest accepted stamp
  };

  bool accept(Stream& stream, Stamp stamp, std::optional<DropReason> defect);
  Stamp largestLag() const;
  void store(Stream& stream, Stamp stamp, const double* values);
  void endTimeBase();
  void followOrientation(Stamp stamp, const Eigen::Quaterniond& q_stator_rotor);
  const Stream& readings() const { return buffers_.has_joints ? joints_ : orientations_; }
  void queue(const std::optional<StampInterval>& dwell);
  void closeDwellOfSilentJoints();
  void evaluateReadyDwells();
  bool isReady(const StampInterval& dwell) const;
  std::string silentStream() const;
  std::optional<StampInterval> presentInTime() const;
  Stamp settledSince(const StampInterval& dwell) const;
  bool allPassed(Stamp stamp) const;
  CaptureProgress captured(const StampInterval& dwell, const StampInterval& span) const;
  void evaluateFront();
  void takeRepeated(Stamp until, const std::optional<StampInterval>& dwell);
  Stamp oldestNeeded() const;

  SampleBuilderOptions options_;
  std::size_t coils_;
  Stamp largest_gap_;
  Stamp stream_timeout_;

  SampleBuilderReport report_;
  MeasurementBuffers buffers_;
  std::array<ReadingSteps, 3> joint_steps_;
  Eigen::Quaterniond tracked_ = Eigen::Quaterniond::Identity();  ///< of a rotor without joints
  Eigen::Vector3d turned_ = Eigen::Vector3d::Zero();             ///< see MeasurementBuffers
  Stream joints_;
  Stream orientations_;
  Stream torques_;
  Stream currents_;
  DwellDetector detector_;
  std::optional<Stamp> newest_;                ///< of all streams
  std::optional<Stamp> newest_behind_;         ///< of those that came too late
  std::deque<StampInterval> queued_;           ///< dwells that wait for the other streams
  std::unique_ptr<RepeatedSamples> repeated_;  ///< where samples are made again
  std::vector<Sample> samples_;
  std::uint32_t next_id_ = 1;
};

}  // namespace sac
