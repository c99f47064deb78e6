#include "spherical_actuator_calibration/ros/recording/recorded_streams.hpp"

#include "spherical_actuator_calibration/actuator/actuator.hpp"
#include "spherical_actuator_calibration/base/error.hpp"
#include "spherical_actuator_calibration/ros/conversion/frame_names.hpp"
#include "spherical_actuator_calibration/ros/conversion/messages.hpp"

namespace sac {
namespace {

void requireSomeInFrame(const std::string& topic,
                        std::uint64_t received,
                        const std::string& other_frame,
                        std::uint64_t in_other_frame,
                        const std::string& frame) {
  if (received == 0 && in_other_frame > 0) {
    throw DataError(topic + " " + otherFrame(other_frame, frame) +
                    "; transform it, or name its frame in the configuration (frames).");
  }
}

}  // namespace

RecordedStreams::RecordedStreams(const Actuator& nominal,
                                 const MeasurementFrames& frames,
                                 const SampleBuilderOptions& options)
    : nominal_(nominal),
      frames_(frames),
      reader_(nominal, frames),
      builder_(options, modelledCoils(nominal), nominal.has_joints),
      motion_(modelledCoils(nominal)) {}

template <typename Measurement>
void RecordedStreams::take(const Measurement& measurement) {
  if (keeps_samples_) {
    builder_.add(measurement);
  }
  if (keeps_motion_) {
    motion_.add(measurement);
  }
}

void RecordedStreams::add(const sensor_msgs::JointState& message) {
  if (!nominal_.has_joints) {
    return;
  }
  if (const JointMeasurement* measurement = reader_.read(message)) {
    take(*measurement);
    return;
  }
  ++counts_.incomplete_joint_states;
  other_joints_ = message.name;
}

void RecordedStreams::add(const geometry_msgs::QuaternionStamped& message) {
  if (const OrientationMeasurement* measurement = reader_.read(message)) {
    take(*measurement);
    return;
  }
  ++counts_.orientations_in_other_frame;
  other_orientation_frame_ = message.header.frame_id;
}

void RecordedStreams::add(const geometry_msgs::Vector3Stamped& message) {
  if (const TorqueMeasurement* measurement = reader_.read(message)) {
    if (keeps_samples_) {
      builder_.add(*measurement);
    }
    return;
  }
  ++counts_.torques_in_other_frame;
  other_torque_frame_ = message.header.frame_id;
}

void RecordedStreams::add(const msg::CoilCurrents& message) {
  if (const CurrentMeasurement* measurement = reader_.read(message)) {
    take(*measurement);
  }
  currents_ = message.current.size();
}

void RecordedStreams::addCommand(const msg::CoilCurrents& message) {
  if (keeps_motion_) {
    motion_.add(reader_.readCommand(message));
  }
}

bool RecordedStreams::any() const {
  const SampleBuilderReport& streams = builder_.report();
  return nominal_.has_joints
             ? streams.joints.received > 0 || counts_.incomplete_joint_states > 0
             : streams.orientations.received > 0 || counts_.orientations_in_other_frame > 0;
}

RecordedStreamsReport RecordedStreams::report() const {
  RecordedStreamsReport report = counts_;
  report.samples = builder_.report();
  return report;
}

void RecordedStreams::requireUsable(const std::string& files) const {
  const SampleBuilderReport& streams = builder_.report();
  if (nominal_.has_joints && streams.joints.received == 0) {
    std::string names;
    for (const std::string& name : other_joints_) {
      names += " " + name;
    }
    throw DataError(files + ": joint_states names the joints" + (names.empty() ? " -" : names) +
                    ", but the description has " + nominal_.joints[0].name + " " +
                    nominal_.joints[1].name + " " + nominal_.joints[2].name + ".");
  }
  requireSomeInFrame(files + ": measured_orientation",
                     streams.orientations.received,
                     other_orientation_frame_,
                     counts_.orientations_in_other_frame,
                     frames_.stator);
  requireSomeInFrame(files + ": measured_torque",
                     streams.torques.received,
                     other_torque_frame_,
                     counts_.torques_in_other_frame,
                     frames_.rotor);
  const StreamStatistics& currents = streams.currents;
  if (currents.received > 0 && currents.droppedFor(DropReason::kWrongSize) == currents.received) {
    throw DataError(coilMismatch(files, "coil_currents has", currents_, modelledCoils(nominal_)));
  }
}

std::vector<std::string> RecordedStreams::missing() const {
  const SampleBuilderReport& streams = builder_.report();
  std::vector<std::string> missing;
  if (streams.orientations.received == 0) {
    missing.emplace_back(nominal_.has_joints
                             ? "No orientation is recorded: the joint cannot be calibrated."
                             : "No orientation is recorded: nothing tells where the rotor is.");
  }
  if (modelledCoils(nominal_) == 0) {
    return missing;
  }
  if (streams.torques.received == 0) {
    missing.emplace_back("No torque is recorded: poles and coils cannot be calibrated.");
  } else if (streams.currents.received == 0) {
    missing.emplace_back("No coil current is recorded: poles and coils cannot be calibrated.");
  }
  return missing;
}

std::string coilMismatch(const std::string& files,
                         const std::string& what,
                         std::size_t recorded,
                         std::size_t described) {
  return files + ": " + what + " " + std::to_string(recorded) +
         " currents, but the description has " + std::to_string(described) +
         " coils; give the description of the actuator that was recorded.";
}

}  // namespace sac
