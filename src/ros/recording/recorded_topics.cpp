#include "recorded_topics.hpp"

#include <algorithm>
#include <set>

#include <geometry_msgs/QuaternionStamped.h>
#include <geometry_msgs/Vector3Stamped.h>
#include <ros/message_traits.h>
#include <sensor_msgs/JointState.h>
#include <spherical_actuator_calibration/CalibrationSample.h>
#include <spherical_actuator_calibration/CoilCurrents.h>

#include "spherical_actuator_calibration/ActuatorParameters.h"
#include "spherical_actuator_calibration/Calibrate.h"
#include "spherical_actuator_calibration/CalibrationReport.h"
#include "spherical_actuator_calibration/PlanPoses.h"
#include "spherical_actuator_calibration/base/error.hpp"
#include "spherical_actuator_calibration/ros/conversion/messages.hpp"
#include "spherical_actuator_calibration/ros/conversion/topic_names.hpp"

namespace sac {
namespace {

/// A topic as the contract has it.
struct TopicType {
  const char* name;
  const char* datatype;
  const char* md5sum;
};

template <typename Message>
TopicType topicType(const char* name) {
  return {name, ros::message_traits::datatype<Message>(), ros::message_traits::md5sum<Message>()};
}

/// By TopicRole.
const std::array<TopicType, kTopicRoles>& topicTypes() {
  static const std::array<TopicType, kTopicRoles> types = {
      topicType<sensor_msgs::JointState>("joint_states"),
      topicType<geometry_msgs::QuaternionStamped>("measured_orientation"),
      topicType<geometry_msgs::Vector3Stamped>("measured_torque"),
      topicType<msg::CoilCurrents>("coil_currents"),
      topicType<msg::CalibrationSample>("samples"),
      topicType<msg::ActuatorParameters>("parameters"),
      topicType<msg::CoilCurrents>("coil_command"),
      topicType<msg::CoilCurrents>("coil_setpoints"),
  };
  return types;
}

/// Namespaces below which a topic of this name and type is recorded.
std::set<std::string> namespacesWith(const BagGroup& group, TopicRole role) {
  const TopicType& type = topicTypes()[static_cast<std::size_t>(role)];
  const std::string end = std::string("/") + type.name;
  std::set<std::string> namespaces;
  for (const BagFile* file : group) {
    for (const BagTopic& topic : file->topics) {
      if (topic.datatype == type.datatype && topic.name.size() >= end.size() &&
          topic.name.compare(topic.name.size() - end.size(), end.size(), end) == 0) {
        const std::string ns = topic.name.substr(0, topic.name.size() - end.size());
        namespaces.insert(ns.empty() ? "/" : ns);
      }
    }
  }
  return namespaces;
}

std::string adviceOnNamespace(const std::set<std::string>& namespaces) {
  if (namespaces.empty()) {
    return "record it, or name the right namespace by --ns.";
  }
  std::string text = "it is recorded below";
  for (const std::string& ns : namespaces) {
    text += " " + ns;
  }
  return text + ": choose by --ns.";
}

}  // namespace

RecordedTopics::RecordedTopics(const std::string& ns) : prefix_(topicPrefix(ns)) {
  for (std::size_t k = 0; k < kTopicRoles; ++k) {
    names_[k] = prefix_ + topicTypes()[k].name;
  }
}

std::vector<std::string> RecordedTopics::names(const std::vector<TopicRole>& roles) const {
  std::vector<std::string> names;
  names.reserve(roles.size());
  for (const TopicRole role : roles) {
    names.push_back(name(role));
  }
  return names;
}

bool RecordedTopics::isRecorded(const BagGroup& group, TopicRole role) const {
  return std::any_of(group.begin(), group.end(), [&](const BagFile* file) {
    return std::any_of(file->topics.begin(), file->topics.end(), [&](const BagTopic& topic) {
      return topic.name == name(role);
    });
  });
}

bool RecordedTopics::covers(const BagGroup& group, TopicRole role, TopicRole other) const {
  const ros::Duration beside(1.0);
  const std::vector<ros::Time> own = endsOf(group, role);
  const std::vector<ros::Time> others = endsOf(group, other);
  return !own.empty() && (others.empty() || (own.front() <= others.front() + beside &&
                                             own.back() + beside >= others.back()));
}

/// Times of the first and the last message; nothing where there is none.
std::vector<ros::Time> RecordedTopics::endsOf(const BagGroup& group, TopicRole role) const {
  std::vector<ros::Time> ends;
  for (const BagFile* file : group) {
    for (const BagTopic& topic : file->topics) {
      if (topic.name == name(role)) {
        ends.push_back(topic.begin);
        ends.push_back(topic.end);
      }
    }
  }
  std::sort(ends.begin(), ends.end());
  return ends;
}

void RecordedTopics::requireTypes(const BagFile& file) const {
  for (const BagTopic& topic : file.topics) {
    const auto found = std::find(names_.begin(), names_.end(), topic.name);
    if (found == names_.end()) {
      continue;
    }
    const TopicType& type = topicTypes()[static_cast<std::size_t>(found - names_.begin())];
    // Of the parameters only the beginning is read, which is the same in every release.
    const bool reads_all = found != names_.begin() + static_cast<int>(TopicRole::kParameters);
    const bool is_earlier =
        topic.name == name(TopicRole::kSamples) && topic.md5sum == kEarlierSampleMd5;
    const bool is_readable = !reads_all || is_earlier;
    requireMessageType(file, topic, type.datatype, is_readable ? topic.md5sum : type.md5sum);
  }
}

void requireMessageType(const BagFile& file,
                        const BagTopic& topic,
                        const std::string& datatype,
                        const std::string& md5sum) {
  if (topic.datatype != datatype) {
    throw DataError(file.path + ": " + topic.name + " is recorded as " + topic.datatype +
                    ", but must be " + datatype + ".");
  }
  if (topic.md5sum != md5sum) {
    throw DataError(file.path + ": " + topic.name + " was recorded with another version of " +
                    datatype + "; convert it by `rosbag fix`.");
  }
}

void RecordedTopics::requireStreams(const BagGroup& group,
                                    bool has_joints,
                                    bool takes_motion) const {
  const TopicRole reading = has_joints ? TopicRole::kJointStates : TopicRole::kOrientation;
  if (!isRecorded(group, reading)) {
    throw DataError(pathsOf(group) + ": no message of " + name(reading) + "; " +
                    adviceOnNamespace(namespacesWith(group, reading)));
  }
  // Momentum tells much without any of both.
  const bool tells_motion = takes_motion && isRecorded(group, TopicRole::kCurrents);
  if (!tells_motion && !isRecorded(group, TopicRole::kOrientation) &&
      !isRecorded(group, TopicRole::kTorque)) {
    throw DataError(pathsOf(group) + ": no message of " + name(TopicRole::kOrientation) +
                    " nor of " + name(TopicRole::kTorque) + "; record at least one of them.");
  }
}

TopicRole TopicLookup::role(const BagConnection& connection) {
  for (const auto& [known, role] : known_) {
    if (known == &connection) {
      return role;
    }
  }
  for (std::size_t k = 0; k < kTopicRoles; ++k) {
    const auto role = static_cast<TopicRole>(k);
    if (topics_.name(role) == connection.topic) {
      known_.emplace_back(&connection, role);
      return role;
    }
  }
  throw DataError("The topic " + connection.topic + " is none of the actuator's.");
}

std::string pathsOf(const BagGroup& group) {
  std::string text;
  for (const BagFile* file : group) {
    text += (text.empty() ? "" : ", ") + file->path;
  }
  return text;
}

}  // namespace sac
