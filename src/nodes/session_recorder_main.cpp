#include <iterator>
#include <sstream>
#include <string>
#include <vector>

#include <ros/wall_timer.h>

#include "spherical_actuator_calibration/base/error.hpp"
#include "spherical_actuator_calibration/base/yaml_reader.hpp"
#include "spherical_actuator_calibration/ros/conversion/parameter_map.hpp"
#include "spherical_actuator_calibration/ros/node/node_main.hpp"
#include "spherical_actuator_calibration/ros/node/termination.hpp"
#include "spherical_actuator_calibration/ros/recording/session_recorder.hpp"

#include <malloc.h>

namespace {

constexpr double kLookPeriod = 1.0;      // [s]
constexpr int kLargeBlock = 128 * 1024;  // [byte]

std::vector<std::string> wordsOf(const std::string& text) {
  std::istringstream stream(text);
  return {std::istream_iterator<std::string>(stream), std::istream_iterator<std::string>()};
}

/// Private parameters: `output`, the bag to write, and `topics`, separated by blanks.
void record(const ros::NodeHandle& node, const ros::NodeHandle& private_node) {
  const sac::YamlMap map = sac::privateParameters(private_node);
  const std::string output = map.nonEmptyText("output");
  const std::vector<std::string> topics = wordsOf(map.nonEmptyText("topics"));
  map.finish();
  sac::SessionRecorder recorder(node, topics, output);
  const ros::WallTimer look = node.createWallTimer(ros::WallDuration(kLookPeriod),
                                                   [&](const ros::WallTimerEvent& /*event*/) {
                                                     const std::string failure = recorder.failure();
                                                     if (!failure.empty()) {
                                                       throw sac::DataError(failure);
                                                     }
                                                   });
  sac::spinUntilTermination();
  recorder.finish();
}

}  // namespace

/// scripts/record_session starts it.
int main(int argc, char** argv) {
  // Set, it stays: else memory of long messages that are gone would be kept for others.
  ::mallopt(M_MMAP_THRESHOLD, kLargeBlock);
  return sac::runNode(argc, argv, "session_recorder", record);
}
