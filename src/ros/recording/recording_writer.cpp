#include "spherical_actuator_calibration/ros/recording/recording_writer.hpp"

#include <cstdint>
#include <exception>
#include <filesystem>
#include <system_error>
#include <utility>
#include <vector>

#include <topic_tools/shape_shifter.h>

#include "spherical_actuator_calibration/base/error.hpp"
#include "spherical_actuator_calibration/ros/recording/bag_closing.hpp"

namespace sac {
namespace {

namespace fs = std::filesystem;

constexpr char kTooMany[] = "it is one of more than the disk takes";

/// Of a message with its pointers and names [byte].
std::size_t costOf(std::size_t length) {
  constexpr std::size_t kOfEach = 256;
  return kOfEach + length;
}

std::string activePath(const std::string& path) {
  return path + ".active";
}

/// A message with its type, as rosbag takes it.
topic_tools::ShapeShifter typed(const RecordingWriter::Message& message) {
  const auto field = [&](const char* name) {
    const auto found = message.connection->find(name);
    return found == message.connection->end() ? std::string() : found->second;
  };
  topic_tools::ShapeShifter shape;
  shape.morph(field("md5sum"), field("type"), field("message_definition"), field("latching"));
  // rosbag's streams read from what could be written.
  std::vector<std::uint8_t> bytes = message.content->bytes;
  ros::serialization::IStream stream(bytes.data(), static_cast<std::uint32_t>(bytes.size()));
  shape.read(stream);
  return shape;
}

}  // namespace

RecordingWriter::RecordingWriter(const std::string& path)
    : path_(path), bag_(std::make_unique<rosbag::Bag>()) {
  if (fs::exists(path_) || fs::exists(activePath(path_))) {
    throw DataError(path_ + ": the file exists already.");
  }
  try {
    bag_->setCompression(rosbag::compression::LZ4);
    bag_->open(activePath(path_), rosbag::bagmode::Write);
  } catch (const std::exception& error) {
    closeBag(bag_);
    throw DataError(path_ + ": cannot be written: " + error.what() + ".");
  }
  thread_ = std::thread([this] { writeAll(); });
}

RecordingWriter::~RecordingWriter() {
  try {
    finish();
  } catch (const Error&) {
    // Told by failure().
    return;
  }
}

std::string RecordingWriter::refusal(const std::string& topic, std::size_t length) const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return refusalLocked(topic, length);
}

std::string RecordingWriter::refusalLocked(const std::string& topic, std::size_t length) const {
  if (length > RecordedMessage::kLargest) {
    return "it is " + std::to_string(length) + " bytes long; " +
           std::to_string(RecordedMessage::kLargest) + " are the most that is recorded";
  }
  const auto waiting = bytes_.find(topic);
  const std::size_t before = waiting == bytes_.end() ? 0 : waiting->second;
  return before + costOf(length) > kMostWaiting ? kTooMany : "";
}

std::string RecordingWriter::add(const std::string& topic, Message message) {
  const std::size_t length = message.content->length;
  const std::lock_guard<std::mutex> lock(mutex_);
  std::string reason = refusalLocked(topic, length);
  if (!reason.empty()) {
    return reason;
  }
  if (message.content->bytes.size() != length) {
    return kTooMany;  // when it came
  }
  if (failure_.empty() && !is_over_) {
    bytes_[topic] += costOf(length);
    waiting_.push_back({topic, std::move(message)});
    changed_.notify_one();
  }
  return "";
}

std::string RecordingWriter::failure() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return failure_;
}

void RecordingWriter::finish() {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    is_over_ = true;
    changed_.notify_one();
  }
  if (!thread_.joinable()) {
    return;
  }
  thread_.join();
  const std::string unclosed = closeBag(bag_);
  if (!unclosed.empty() && failure().empty()) {
    fail(unclosed);
  }
  if (!failure().empty()) {
    throw DataError(failure());
  }
  std::error_code error;
  fs::rename(activePath(path_), path_, error);
  if (error) {
    fail(error.message());
    throw DataError(failure());
  }
}

void RecordingWriter::writeAll() {
  std::unique_lock<std::mutex> lock(mutex_);
  while (true) {
    changed_.wait(lock, [this] { return is_over_ || !waiting_.empty(); });
    if (waiting_.empty()) {
      return;
    }
    const Waiting next = std::move(waiting_.front());
    waiting_.pop_front();
    lock.unlock();
    write(next);
    lock.lock();
    bytes_[next.topic] -= costOf(next.message.content->length);
  }
}

void RecordingWriter::write(const Waiting& waiting) {
  if (!failure().empty()) {
    return;
  }
  const Message& message = waiting.message;
  try {
    bag_->write(waiting.topic, message.received, typed(message), message.connection);
  } catch (const std::exception& error) {
    fail(error.what());
  }
}

void RecordingWriter::fail(const std::string& reason) {
  const std::lock_guard<std::mutex> lock(mutex_);
  failure_ = path_ + ": the recording ended: " + reason + ". What came before is in " +
             activePath(path_) + ": rosbag reindex makes it readable.";
}

}  // namespace sac
