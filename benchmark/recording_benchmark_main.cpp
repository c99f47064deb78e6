/// How fast a recording is read: recording_benchmark ACTUATOR.yaml RECORDING.bag [--benchmark_...]

#include <iostream>
#include <string>
#include <vector>

#include <benchmark/benchmark.h>
#include <geometry_msgs/QuaternionStamped.h>
#include <geometry_msgs/Vector3Stamped.h>
#include <rosbag/bag.h>
#include <rosbag/query.h>
#include <rosbag/view.h>
#include <sensor_msgs/JointState.h>
#include <spherical_actuator_calibration/CoilCurrents.h>

#include "../src/ros/recording/bag_reader.hpp"
#include "spherical_actuator_calibration/actuator/description_file.hpp"
#include "spherical_actuator_calibration/ros/conversion/message_decoder.hpp"
#include "spherical_actuator_calibration/ros/conversion/messages.hpp"
#include "spherical_actuator_calibration/ros/recording/recording_reader.hpp"

namespace sac::benchmarks {
namespace {

constexpr const char* kJointStates = "/actuator/joint_states";
constexpr const char* kOrientation = "/actuator/measured_orientation";
constexpr const char* kTorque = "/actuator/measured_torque";
constexpr const char* kCurrents = "/actuator/coil_currents";

template <typename Message>
void instantiateAs(const rosbag::MessageInstance& instance) {
  benchmark::DoNotOptimize(instance.instantiate<Message>());
}

/// Instantiates every message of the streams that calibrate_bag reads, and drops it. Returns their
/// number.
std::int64_t passOver(const std::string& path) {
  rosbag::Bag bag(path);
  const std::vector<std::string> topics{kJointStates, kOrientation, kTorque, kCurrents};
  rosbag::View view(bag, rosbag::TopicQuery(topics));
  std::int64_t count = 0;
  for (const rosbag::MessageInstance& message : view) {
    const std::string& topic = message.getTopic();
    if (topic == kTorque) {
      instantiateAs<geometry_msgs::Vector3Stamped>(message);
    } else if (topic == kJointStates) {
      instantiateAs<sensor_msgs::JointState>(message);
    } else if (topic == kCurrents) {
      instantiateAs<msg::CoilCurrents>(message);
    } else {
      instantiateAs<geometry_msgs::QuaternionStamped>(message);
    }
    ++count;
  }
  return count;
}

/// The same by the package's own reader.
std::int64_t passOverInSequence(const std::string& path) {
  const auto bags = openBags({path});
  BagReader reader({bags.front().get()}, {kJointStates, kOrientation, kTorque, kCurrents});
  MessageDecoder decoder;
  sensor_msgs::JointState joint_state;
  geometry_msgs::QuaternionStamped orientation;
  geometry_msgs::Vector3Stamped torque;
  msg::CoilCurrents currents;
  BagMessage message;
  std::int64_t count = 0;
  while (reader.next(message)) {
    const std::string& topic = message.connection->topic;
    if (topic == kTorque) {
      benchmark::DoNotOptimize(decoder.decode(message.data, torque));
    } else if (topic == kJointStates) {
      benchmark::DoNotOptimize(decoder.decode(message.data, joint_state));
    } else if (topic == kCurrents) {
      benchmark::DoNotOptimize(decoder.decode(message.data, currents));
    } else {
      benchmark::DoNotOptimize(decoder.decode(message.data, orientation));
    }
    ++count;
  }
  return count;
}

void sequentialPass(benchmark::State& state, const std::string& bag) {
  std::int64_t messages = 0;
  for (auto _ : state) {
    messages += passOverInSequence(bag);
  }
  state.SetItemsProcessed(messages);
}

void barePass(benchmark::State& state, const std::string& bag) {
  std::int64_t messages = 0;
  for (auto _ : state) {
    messages += passOver(bag);
  }
  state.SetItemsProcessed(messages);
}

/// What calibrate_bag does to get the samples.
void readSamples(benchmark::State& state, const Actuator& actuator, const std::string& bag) {
  std::uint64_t messages = 0;
  for (auto _ : state) {
    const Recording recording = readRecordings({bag}, actuator, {});
    const SampleBuilderReport& streams = recording.report.streams.samples;
    messages += streams.joints.received + streams.orientations.received + streams.torques.received +
                streams.currents.received;
    if (recording.samples.empty()) {
      state.SkipWithError("the recording gave no samples");
    }
  }
  state.SetItemsProcessed(static_cast<std::int64_t>(messages));
}

}  // namespace
}  // namespace sac::benchmarks

int main(int argc, char** argv) {
  using namespace sac;
  benchmark::Initialize(&argc, argv);
  if (argc != 3) {
    std::cerr << "usage: recording_benchmark ACTUATOR.yaml RECORDING.bag [--benchmark_...]\n";
    return 2;
  }
  try {
    const Actuator actuator = loadActuator(argv[1]);
    const std::string bag = argv[2];
    benchmark::RegisterBenchmark("barePass", benchmarks::barePass, bag)
        ->Unit(benchmark::kMillisecond);
    benchmark::RegisterBenchmark("sequentialPass", benchmarks::sequentialPass, bag)
        ->Unit(benchmark::kMillisecond);
    benchmark::RegisterBenchmark("readSamples", benchmarks::readSamples, actuator, bag)
        ->Unit(benchmark::kMillisecond);
    benchmark::RunSpecifiedBenchmarks();
  } catch (const std::exception& error) {
    std::cerr << "recording_benchmark: " << error.what() << "\n";
    return 1;
  }
  return 0;
}
