#include <cstdlib>
#include <cstring>
#include <memory>
#include <vector>

#include <geometry_msgs/QuaternionStamped.h>
#include <geometry_msgs/Vector3Stamped.h>
#include <sensor_msgs/JointState.h>
#include <spherical_actuator_calibration/CalibrationSample.h>
#include <spherical_actuator_calibration/CalibrationStatus.h>
#include <spherical_actuator_calibration/CoilCurrents.h>
#include <tf2_msgs/TFMessage.h>

#include "fuzz/fuzz_targets.hpp"
#include "spherical_actuator_calibration/ActuatorParameters.h"
#include "spherical_actuator_calibration/Calibrate.h"
#include "spherical_actuator_calibration/CalibrationReport.h"
#include "spherical_actuator_calibration/actuator/description_file.hpp"
#include "spherical_actuator_calibration/base/error.hpp"
#include "spherical_actuator_calibration/ros/conversion/checked_message.hpp"
#include "spherical_actuator_calibration/ros/conversion/msg_conversion.hpp"
#include "spherical_actuator_calibration/ros/conversion/time_conversion.hpp"
#include "spherical_actuator_calibration/ros/recording/recorded_setup.hpp"
#include "spherical_actuator_calibration/ros/recording/recorded_streams.hpp"
#include "spherical_actuator_calibration/ros/recording/recording_reader.hpp"
#include "spherical_actuator_calibration/streams/sample_builder.hpp"
#include "support/source_dir.hpp"

namespace sac::fuzz {
namespace {

const Actuator& nominal() {
  static const Actuator actuator = loadActuator(SOURCE_DIR "/config/pm_spherical_8x24.yaml");
  return actuator;
}

/// The message in bytes, when they are one. What is read is what the bytes say: written again by
/// roscpp it gives the same bytes.
template <typename Message>
std::unique_ptr<Message> messageIn(const std::uint8_t* data, std::size_t size) {
  Checked<Message> checked;
  readChecked(data, size, checked);
  if (!checked.defect.empty()) {
    return nullptr;
  }
  const std::uint32_t length = ros::serialization::serializationLength(checked.message);
  std::vector<std::uint8_t> again(length);
  ros::serialization::OStream stream(again.data(), length);
  ros::serialization::serialize(stream, checked.message);
  if (length > size || std::memcmp(again.data(), data, length) != 0) {
    std::abort();
  }
  return std::make_unique<Message>(std::move(checked.message));
}

template <typename Message>
void readStream(const std::uint8_t* data, std::size_t size) {
  const auto message = messageIn<Message>(data, size);
  if (!message) {
    return;
  }
  RecordedStreams streams(nominal(), {}, {});
  streams.add(*message);
  message->header.stamp.sec += 1;
  streams.add(*message);
  streams.finish();
  streams.takeSamples();
  secondsBetween(message->header.stamp, ros::Time(1.0));
}

void readSample(const std::uint8_t* data, std::size_t size) {
  const auto message = messageIn<msg::CalibrationSample>(data, size);
  if (message) {
    try {
      const Sample sample = sampleFromRos(*message);
      validate(sample, modelledCoils(nominal()));
      // A stamp of ROS has nanoseconds below one second; of any other there is one.
      stampFromRos(sampleToRos(sample).header.stamp);
    } catch (const Error&) {
    }
  }
}

void readParameters(const std::uint8_t* data, std::size_t size) {
  const auto message = messageIn<msg::ActuatorParameters>(data, size);
  if (message) {
    try {
      actuatorFromRos(*message, nominal());
    } catch (const Error&) {
    }
  }
}

}  // namespace

void readMessages(const std::uint8_t* data, std::size_t size) {
  if (size == 0) {
    return;
  }
  const std::uint8_t* const bytes = data + 1;
  switch (data[0]) {
    case '0':
      return readStream<sensor_msgs::JointState>(bytes, size - 1);
    case '1':
      return readStream<geometry_msgs::QuaternionStamped>(bytes, size - 1);
    case '2':
      return readStream<geometry_msgs::Vector3Stamped>(bytes, size - 1);
    case '3':
      return readStream<msg::CoilCurrents>(bytes, size - 1);
    case '4':
      return readSample(bytes, size - 1);
    case '5':
      return readParameters(bytes, size - 1);
    case '6':
      return static_cast<void>(messageIn<msg::CalibrationReport>(bytes, size - 1));
    case '7':
      return static_cast<void>(messageIn<msg::CalibrationStatus>(bytes, size - 1));
    case '8':
      return static_cast<void>(messageIn<tf2_msgs::TFMessage>(bytes, size - 1));
    default:
      return;
  }
}

void readRecording(const std::uint8_t* data, std::size_t size) {
  const MemoryFile file(data, size);
  // With the samples that were recorded, and made again of the streams.
  RecordingOptions again;
  again.source = SampleSource::kStreams;
  for (const RecordingOptions& options : {RecordingOptions{}, again}) {
    try {
      readRecordings({file.path()}, nominal(), options);
    } catch (const Error&) {
    }
  }
  try {
    recordedSetup(OpenRecordings({file.path()}), "actuator", {});
  } catch (const Error&) {
  }
}

}  // namespace sac::fuzz
