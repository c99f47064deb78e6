#pragma once

#include <functional>
#include <string>
#include <vector>

#include <rosbag/bag.h>
#include <rosbag/view.h>

#include "spherical_actuator_calibration/actuator/actuator.hpp"
#include "spherical_actuator_calibration/emulation/session_simulator.hpp"
#include "spherical_actuator_calibration/measurement/sample.hpp"
#include "spherical_actuator_calibration/measurement/session_plan.hpp"
#include "spherical_actuator_calibration/ros/conversion/messages.hpp"
#include "spherical_actuator_calibration/ros/conversion/msg_conversion.hpp"
#include "spherical_actuator_calibration/ros/emulation_node/session_bag_writer.hpp"

/// Recordings with known content, and what can go wrong with them.
namespace sac::bags {

/// Records a session of the nominal actuator at sensor noise: some poses, and the first coil
/// excited at some more.
inline void recordSession(const std::string& path,
                          const Actuator& actuator,
                          std::uint64_t seed = 1,
                          SessionPlanOptions plan_options = {}) {
  plan_options.joint_poses = 4;
  plan_options.main_coil_poses = 3;
  plan_options.coil_poses = 0;
  plan_options.validation_poses = 0;
  const SessionPlan plan = planSession(actuator, plan_options, seed);
  SimulationOptions simulation;
  simulation.seed = seed;
  SessionBagOptions options;
  options.registration = simulation.registration;
  options.begin = simulation.begin;
  SessionBagWriter writer(path, {actuator}, options);
  simulateSession(actuator, plan, simulation, writer);
  writer.close();
}

/// Copies one message to another bag, changed or not, or leaves it out.
using Editor = std::function<void(const rosbag::MessageInstance&, rosbag::Bag&)>;

inline void keep(const rosbag::MessageInstance& message, rosbag::Bag& out) {
  out.write(message.getTopic(), message.getTime(), message, message.getConnectionHeader());
}

/// Copies a bag message by message.
inline void edit(const std::string& from, const std::string& to, const Editor& editor) {
  const rosbag::Bag in(from);
  rosbag::Bag out(to, rosbag::bagmode::Write);
  rosbag::View view(in);
  for (const rosbag::MessageInstance& message : view) {
    editor(message, out);
  }
  out.close();
}

/// Applies `change` to each message of one topic, counted from 0 (change(message, n)); keeps all
/// others.
template <typename Message, typename Change>
Editor changing(const std::string& topic, Change change) {
  return [topic, change, count = std::size_t{0}](const rosbag::MessageInstance& message,
                                                 rosbag::Bag& out) mutable {
    if (message.getTopic() != topic) {
      return keep(message, out);
    }
    Message changed = *message.instantiate<Message>();
    change(changed, count++);
    out.write(topic, message.getTime(), changed);
  };
}

/// Leaves out the topics named.
inline Editor without(const std::vector<std::string>& topics) {
  return [topics](const rosbag::MessageInstance& message, rosbag::Bag& out) {
    for (const std::string& topic : topics) {
      if (message.getTopic() == topic) {
        return;
      }
    }
    keep(message, out);
  };
}

/// Writes messages of /actuator/samples, one a second from `begin` [s], and the parameters of the
/// actuator.
inline void writeSamples(const std::string& path,
                         const Actuator& actuator,
                         const std::vector<msg::CalibrationSample>& samples,
                         double begin = 1000.0) {
  rosbag::Bag bag(path, rosbag::bagmode::Write);
  ros::Time stamp(begin);
  bag.write("/actuator/parameters", stamp, parametersToRos(actuator));
  for (const msg::CalibrationSample& sample : samples) {
    bag.write("/actuator/samples", stamp, sample);
    stamp += ros::Duration(1.0);
  }
  bag.close();
}

inline std::vector<msg::CalibrationSample> messagesOf(const std::vector<Sample>& samples) {
  std::vector<msg::CalibrationSample> messages;
  messages.reserve(samples.size());
  for (const Sample& sample : samples) {
    messages.push_back(sampleToRos(sample));
  }
  return messages;
}

}  // namespace sac::bags
