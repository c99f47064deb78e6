#include "spherical_actuator_calibration/ros/recording/recording_reader.hpp"

#include <algorithm>
#include <cstdint>
#include <exception>
#include <iterator>
#include <memory>

#include "bag_files.hpp"
#include "bag_reader.hpp"
#include "damaged_recording.hpp"
#include "recorded_samples.hpp"
#include "recorded_topics.hpp"
#include "recorded_unit.hpp"
#include "spherical_actuator_calibration/Calibrate.h"
#include "spherical_actuator_calibration/CalibrationReport.h"
#include "spherical_actuator_calibration/PlanPoses.h"
#include "spherical_actuator_calibration/actuator/actuator.hpp"
#include "spherical_actuator_calibration/base/error.hpp"
#include "spherical_actuator_calibration/ros/conversion/message_decoder.hpp"
#include "spherical_actuator_calibration/ros/conversion/messages.hpp"
#include "spherical_actuator_calibration/ros/conversion/time_conversion.hpp"
#include "spherical_actuator_calibration/ros/recording/recorded_streams.hpp"

namespace sac {
namespace {

/// Reads all groups of bags, one after the other, into one list of samples.
class Reader {
 public:
  Reader(const Actuator& nominal, const RecordingOptions& options)
      : nominal_(nominal),
        options_(options),
        topics_(options.ns),
        streams_(nominal, options.frames, options.samples),
        recorded_samples_(nominal, options.frames) {}

  Recording read(const std::vector<std::unique_ptr<BagFile>>& bags) {
    BagGroup all;
    for (const auto& bag : bags) {
      topics_.requireTypes(*bag);
      all.push_back(bag.get());
    }
    checkIdentity(all);
    const std::vector<BagGroup> groups = groupBags(bags, topics_.prefix());
    for (std::size_t k = 0; k < groups.size(); ++k) {
      readGroup(groups[k], {k, groups.size()});
    }
    recording_.motion = streams_.takeMotion();
    complete(pathsOf(all));
    return std::move(recording_);
  }

 private:
  /// Which of how many groups of bags.
  struct Step {
    std::size_t index;
    std::size_t count;
  };

  void readGroup(const BagGroup& group, const Step& step) {
    const bool from_samples = takesSamples(group);
    if (!from_samples) {
      topics_.requireStreams(group, nominal_.has_joints, options_.motion == MotionUse::kAlways);
      streams_.repeat(takenLive(group));
    }
    streams_.keepMotion(options_.motion == MotionUse::kAlways ||
                        (options_.motion == MotionUse::kWithoutTorques &&
                         !topics_.isRecorded(group, TopicRole::kTorque)));
    streams_.keepSamples(!from_samples);
    readUndamaged(pathsOf(group),
                  [&] { readMessages(group, rolesToRead(group, from_samples), step); });
    streams_.finish();
    append(streams_.takeSamples());
    append(recorded_samples_.takeSamples());
  }

  bool takesSamples(const BagGroup& group) const {
    if (options_.source == SampleSource::kStreams || options_.source == SampleSource::kDwells) {
      return false;
    }
    const bool are_recorded = topics_.isRecorded(group, TopicRole::kSamples);
    if (options_.source == SampleSource::kSamples && !are_recorded) {
      throw DataError(pathsOf(group) + ": the topic " + topics_.name(TopicRole::kSamples) +
                      " was not recorded; --from streams takes the samples from the streams.");
    }
    return are_recorded;
  }

  /// Samples that a node took of the streams of the group, and which stretches it took them of.
  std::vector<Sample> takenLive(const BagGroup& group) {
    if (!topics_.isRecorded(group, TopicRole::kSamples)) {
      return {};
    }
    if (options_.source == SampleSource::kDwells) {
      recording_.report.notes.emplace_back(
          "Every rest gives samples to calibrate from, also those that the session held out to "
          "judge by: dwells do not tell which.");
      return {};
    }
    RecordedSamples recorded(nominal_, options_.frames);
    readUndamaged(pathsOf(group), [&] {
      BagReader reader(group, {topics_.name(TopicRole::kSamples)});
      BagMessage message;
      while (reader.next(message)) {
        recorded.add(decodeSample(message));
      }
    });
    std::vector<Sample> samples = recorded.takeSamples();
    const bool tell_their_rest = std::all_of(
        samples.begin(), samples.end(), [](const Sample& sample) { return sample.dwell != 0; });
    if (!tell_their_rest) {
      recording_.report.notes.emplace_back(
          "The recorded samples do not tell which rest they are of, so that every rest gives its "
          "own: the result is not that of the session.");
      return {};
    }
    recording_.report.notes.push_back(std::to_string(samples.size()) +
                                      " samples that were taken live are made again of the streams "
                                      "(of every rest: --from dwells).");
    return samples;
  }

  std::vector<TopicRole> rolesToRead(const BagGroup& group, bool from_samples) const {
    // What a driver has set tells what currents do better than what it was asked for.
    const TopicRole commands = topics_.covers(group, TopicRole::kSetpoints, TopicRole::kCommands)
                                   ? TopicRole::kSetpoints
                                   : TopicRole::kCommands;
    if (from_samples && options_.motion == MotionUse::kAlways) {
      return {TopicRole::kSamples,
              TopicRole::kJointStates,
              TopicRole::kOrientation,
              TopicRole::kCurrents,
              commands};
    }
    if (from_samples) {
      return {TopicRole::kSamples};
    }
    if (modelledCoils(nominal_) == 0) {
      return {TopicRole::kJointStates, TopicRole::kOrientation};
    }
    return {TopicRole::kJointStates,
            TopicRole::kOrientation,
            TopicRole::kTorque,
            TopicRole::kCurrents,
            commands};
  }

  void readMessages(const BagGroup& group, const std::vector<TopicRole>& roles, const Step& step) {
    BagReader reader(group, topics_.names(roles));
    const ros::Time begin = reader.begin();
    const double duration = secondsBetween(begin, reader.end());
    TopicLookup lookup(topics_);
    std::uint64_t count = 0;
    BagMessage message;
    while (reader.next(message)) {
      readMessage(lookup.role(*message.connection), message);
      if (++count % kProgressStep == 0) {
        tellProgress(step, secondsBetween(begin, message.time) / duration);
      }
    }
    tellProgress(step, 1.0);
  }

  void tellProgress(const Step& step, double share) const {
    if (options_.progress) {
      options_.progress((static_cast<double>(step.index) + std::min(share, 1.0)) /
                        static_cast<double>(step.count));
    }
  }

  void readMessage(TopicRole role, const BagMessage& message) {
    switch (role) {
      case TopicRole::kJointStates:
        return streams_.add(decoder_.decode(message.data, joint_state_));
      case TopicRole::kOrientation:
        return streams_.add(decoder_.decode(message.data, orientation_));
      case TopicRole::kTorque:
        return streams_.add(decoder_.decode(message.data, torque_));
      case TopicRole::kCurrents:
        return streams_.add(decoder_.decode(message.data, currents_));
      case TopicRole::kCommands:
      case TopicRole::kSetpoints:
        return streams_.addCommand(decoder_.decode(message.data, currents_));
      case TopicRole::kSamples:
        return recorded_samples_.add(decodeSample(message));
      case TopicRole::kParameters:
        return takeUnit(decoder_.decode(message.data, parameters_));
    }
  }

  const msg::CalibrationSample& decodeSample(const BagMessage& message) {
    const bool is_earlier = message.connection->md5sum == kEarlierSampleMd5;
    return decoder_.decode(message.data, sample_, is_earlier ? kLaterSampleBytes : 0);
  }

  void append(std::vector<Sample> samples) {
    std::move(samples.begin(), samples.end(), std::back_inserter(recording_.samples));
  }

  /// Before anything else: a recording of another unit must not be told to lack coils.
  void checkIdentity(const BagGroup& bags) {
    for (BagFile* file : bags) {
      readUndamaged(file->path, [&] {
        BagReader reader({file}, {topics_.name(TopicRole::kParameters)});
        BagMessage message;
        while (reader.next(message)) {
          reading_ = file->path;
          readMessage(TopicRole::kParameters, message);
        }
      });
    }
  }

  void takeUnit(const RecordedUnit& unit) {
    requireSameUnit(reading_, unit, nominal_);
    recorded_serial_ = unit.serial.empty() ? recorded_serial_ : unit.serial;
  }

  void complete(const std::string& files) {
    RecordingReport& report = recording_.report;
    report.has_streams = streams_.any();
    report.has_samples = recorded_samples_.report().received > 0;
    report.streams = streams_.report();
    report.samples = recorded_samples_.report();
    noteIdentity();
    if (report.has_streams) {
      streams_.requireUsable(files);
      report.missing = streams_.missing();
    }
    recorded_samples_.requireUsable(files);
    const std::size_t renumbered = makeIdsUnique(recording_.samples);
    if (renumbered > 0) {
      report.notes.push_back(std::to_string(renumbered) +
                             " samples have the number of another one and got a new one.");
    }
  }

  void noteIdentity() {
    std::vector<std::string>& notes = recording_.report.notes;
    if (recorded_serial_.empty() && !nominal_.serial.empty()) {
      notes.push_back("The recording does not say which unit it is of; it is taken as one of " +
                      nominal_.serial + ".");
    } else if (!recorded_serial_.empty() && nominal_.serial.empty()) {
      notes.push_back("The recording is of unit " + recorded_serial_ +
                      "; the description names none.");
    }
  }

  const Actuator& nominal_;
  const RecordingOptions& options_;
  RecordedTopics topics_;
  RecordedStreams streams_;
  RecordedSamples recorded_samples_;
  Recording recording_;
  std::string recorded_serial_;
  std::string reading_;  ///< path of the bag whose identity is being checked

  // Storage that is reused from message to message.
  MessageDecoder decoder_;
  sensor_msgs::JointState joint_state_;
  geometry_msgs::QuaternionStamped orientation_;
  geometry_msgs::Vector3Stamped torque_;
  msg::CoilCurrents currents_;
  msg::CalibrationSample sample_;
  RecordedUnit parameters_;
};

}  // namespace

Recording readRecordings(const OpenRecordings& recordings,
                         const Actuator& nominal,
                         const RecordingOptions& options) {
  return Reader(nominal, options).read(recordings.bags());
}

Recording readRecordings(const std::vector<std::string>& paths,
                         const Actuator& nominal,
                         const RecordingOptions& options) {
  return readRecordings(OpenRecordings(paths), nominal, options);
}

}  // namespace sac
