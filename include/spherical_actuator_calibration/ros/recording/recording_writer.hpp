#pragma once

#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include <boost/shared_ptr.hpp>
#include <ros/datatypes.h>
#include <ros/time.h>
#include <rosbag/bag.h>

namespace sac {

/// The bytes of a message of any type, as it came; of one that is left out only their number.
struct RecordedMessage {
  static constexpr std::size_t kLargest = std::size_t{4} << 20U;  ///< no reader takes more

  std::vector<std::uint8_t> bytes;
  std::size_t length = 0;
};

/// Writes messages into a bag in a thread of its own, so that a disk that stands still for seconds
/// does not hold up who receives them. What waits for the disk is bounded for each topic, so that
/// one that is flooded costs neither the memory nor the messages of others.
///
/// The bag has the ending .bag.active until it is whole.
class RecordingWriter {
 public:
  /// Bytes of a topic that wait: 20 s of the fastest stream.
  static constexpr std::size_t kMostWaiting = std::size_t{8} << 20U;

  struct Message {
    ros::Time received;
    boost::shared_ptr<const RecordedMessage> content;
    boost::shared_ptr<ros::M_string> connection;  ///< type, definition, sender
  };

  /// Throws DataError, naming the file, when the bag cannot be written or exists already.
  explicit RecordingWriter(const std::string& path);
  ~RecordingWriter();
  RecordingWriter(const RecordingWriter&) = delete;
  RecordingWriter& operator=(const RecordingWriter&) = delete;

  /// Why a message of a topic with so many bytes would be left out now: "it …". Empty where it
  /// would be kept: what is left out need not be copied.
  std::string refusal(const std::string& topic, std::size_t length) const;
  /// Keeps a message of a topic, or says why it is left out.
  std::string add(const std::string& topic, Message message);

  /// What went wrong, a full disk, say, and what to do about it. Empty while nothing has: nothing
  /// is written any more then, so that what was stays readable.
  std::string failure() const;

  /// Writes what waits, and gives the bag its name. Throws DataError with failure(). Nothing more
  /// is added afterwards.
  void finish();

 private:
  struct Waiting {
    std::string topic;
    Message message;
  };

  std::string refusalLocked(const std::string& topic, std::size_t length) const;
  void writeAll();
  void write(const Waiting& waiting);
  void fail(const std::string& reason);

  const std::string path_;
  std::unique_ptr<rosbag::Bag> bag_;
  mutable std::mutex mutex_;  ///< of what follows
  std::condition_variable changed_;
  std::deque<Waiting> waiting_;
  std::map<std::string, std::size_t> bytes_;  ///< that wait, by topic
  std::string failure_;
  bool is_over_ = false;
  std::thread thread_;
};

}  // namespace sac
