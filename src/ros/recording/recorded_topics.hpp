#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "bag_files.hpp"

namespace sac {

/// What a topic of a recording is read for.
enum class TopicRole {
  kJointStates,
  kOrientation,
  kTorque,
  kCurrents,
  kSamples,
  kParameters,
  kCommands,
  kSetpoints,
};
inline constexpr std::size_t kTopicRoles = 8;

/// The topics of one actuator in recordings.
class RecordedTopics {
 public:
  /// `ns`: the actuator's namespace, with or without slashes around it.
  explicit RecordedTopics(const std::string& ns);

  /// "/actuator/": what the names of all topics begin with.
  const std::string& prefix() const { return prefix_; }
  const std::string& name(TopicRole role) const { return names_[static_cast<std::size_t>(role)]; }
  std::vector<std::string> names(const std::vector<TopicRole>& roles) const;

  bool isRecorded(const BagGroup& group, TopicRole role) const;
  /// Whether a topic is recorded for as long as another one, which need not be recorded at all.
  bool covers(const BagGroup& group, TopicRole role, TopicRole other) const;

  /// Throws DataError, naming file, topic and type, when a topic has another type than it must.
  void requireTypes(const BagFile& file) const;

  /// Throws DataError, saying what is missing and where else it is recorded, unless the group has
  /// joint angles and orientations or torques, without joints orientations. Where motion is asked
  /// for, currents will do as well.
  void requireStreams(const BagGroup& group, bool has_joints, bool takes_motion) const;

 private:
  std::vector<ros::Time> endsOf(const BagGroup& group, TopicRole role) const;

  std::string prefix_;
  std::array<std::string, kTopicRoles> names_;
};

/// Throws DataError, naming file, topic and type, when a topic has another type, or another version
/// of it.
void requireMessageType(const BagFile& file,
                        const BagTopic& topic,
                        const std::string& datatype,
                        const std::string& md5sum);

/// CalibrationSample as releases before 0.2 recorded it: without the last fields, so many bytes.
inline constexpr char kEarlierSampleMd5[] = "98178712bd5d9155a3f4f20d78530a4b";
inline constexpr std::size_t kLaterSampleBytes = 40;

/// Finds the role of messages without comparing names, by their connections. Valid as long as the
/// bags are open.
class TopicLookup {
 public:
  explicit TopicLookup(const RecordedTopics& topics) : topics_(topics) {}

  /// Throws DataError when the topic has no role.
  TopicRole role(const BagConnection& connection);

 private:
  const RecordedTopics& topics_;
  std::vector<std::pair<const BagConnection*, TopicRole>> known_;
};

/// "a.bag, b.bag"
std::string pathsOf(const BagGroup& group);

}  // namespace sac
