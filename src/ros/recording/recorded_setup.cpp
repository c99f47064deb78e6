#include "spherical_actuator_calibration/ros/recording/recorded_setup.hpp"

#include <algorithm>
#include <cstddef>
#include <exception>

#include <ros/message_traits.h>
#include <std_msgs/String.h>

#include "bag_files.hpp"
#include "bag_reader.hpp"
#include "damaged_recording.hpp"
#include "spherical_actuator_calibration/base/error.hpp"
#include "spherical_actuator_calibration/base/yaml_reader.hpp"
#include "spherical_actuator_calibration/ros/conversion/message_decoder.hpp"
#include "spherical_actuator_calibration/ros/conversion/topic_names.hpp"

namespace sac {
namespace {

/// More than any description or configuration has [bytes].
constexpr std::size_t kLargestText = std::size_t{16} << 20U;

/// A text, and where it was recorded: "session.bag: /actuator/calibration_config".
struct RecordedText {
  std::string text;
  std::string place;
};

void requireString(const BagTopic& topic, const std::string& place) {
  if (topic.datatype != ros::message_traits::datatype<std_msgs::String>() ||
      topic.md5sum != ros::message_traits::md5sum<std_msgs::String>()) {
    throw DataError(place + " is recorded as " + topic.datatype +
                    ", but must be std_msgs/String; give the description by --actuator and the "
                    "configuration by --config.");
  }
}

/// The texts of one recording, without repetitions one after the other: a node that came back says
/// the same again.
void readTexts(BagFile& file,
               const std::string& topic,
               const std::string& place,
               std::vector<RecordedText>& texts) {
  MessageDecoder decoder;
  std_msgs::String message;
  BagReader reader({&file}, {topic});
  BagMessage recorded;
  while (reader.next(recorded)) {
    if (recorded.data.size() > kLargestText) {
      throw DataError(place + " holds " + std::to_string(recorded.data.size()) + " bytes; " +
                      std::to_string(kLargestText) + " are the most that is read.");
    }
    const std::string& text = decoder.decode(recorded.data, message).data;
    if (texts.empty() || text != texts.back().text) {
      texts.push_back({text, place});
    }
    if (texts.size() > 1) {
      throw DataError(place + ": another one is recorded in " + texts.front().place +
                      "; say by --actuator and --config which ones are meant.");
    }
  }
}

std::optional<RecordedText> recordedText(const OpenRecordings& recordings,
                                         const std::string& topic) {
  std::vector<RecordedText> texts;
  for (const auto& file : recordings.bags()) {
    const auto found = std::find_if(file->topics.begin(),
                                    file->topics.end(),
                                    [&](const BagTopic& other) { return other.name == topic; });
    if (found == file->topics.end()) {
      continue;
    }
    const std::string place = file->path + ": " + topic;
    requireString(*found, place);
    readUndamaged(place, [&] { readTexts(*file, topic, place, texts); });
  }
  return texts.empty() ? std::nullopt : std::optional(texts.front());
}

/// A file of one's own may name another one; who made a recording may not choose what is read here.
void requireNoFileNamed(const RecordedText& recorded) {
  const YamlMap file = YamlMap::parse(recorded.text, recorded.place);
  if (!file.hasMap("actuator") || !file.map("actuator").hasMap("torque_curve")) {
    return;
  }
  const YamlMap curve = file.map("actuator").map("torque_curve");
  if (curve.has("table") && !curve.hasMap("table")) {
    curve.fail("table", "a recording holds its table and names no file.");
  }
}

}  // namespace

RecordedSetup recordedSetup(const OpenRecordings& recordings,
                            const std::string& ns,
                            const SetupParts& parts) {
  RecordedSetup setup;
  if (parts.description) {
    if (const auto text = recordedText(recordings, topicPrefix(ns) + kDescriptionTopic)) {
      requireNoFileNamed(*text);
      setup.description = parseDescription(text->text, text->place);
    }
  }
  if (parts.config) {
    if (const auto text = recordedText(recordings, topicPrefix(ns) + kConfigTopic)) {
      setup.config = parseCalibrationConfig(text->text, text->place);
    }
  }
  return setup;
}

}  // namespace sac
