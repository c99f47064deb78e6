#include "spherical_actuator_calibration/ros/recording/recording_writer.hpp"

#include <csignal>
#include <filesystem>
#include <string>

#include <boost/make_shared.hpp>
#include <gtest/gtest.h>
#include <rosbag/bag.h>
#include <rosbag/view.h>
#include <sys/resource.h>

#include "spherical_actuator_calibration/base/error.hpp"
#include "support/error_message.hpp"
#include "support/temporary_folder.hpp"

namespace sac {
namespace {

namespace fs = std::filesystem;

RecordingWriter::Message messageOf(std::size_t size, double received = 1.0) {
  const auto content = boost::make_shared<RecordedMessage>();
  content->length = size;
  if (size <= RecordedMessage::kLargest) {
    // Which no compression makes shorter.
    for (std::size_t n = 0; n < size; ++n) {
      content->bytes.push_back(static_cast<std::uint8_t>((n * n * 2654435761U) >> 16U));
    }
  }
  const auto connection = boost::make_shared<ros::M_string>();
  (*connection)["md5sum"] = "0123456789abcdef0123456789abcdef";
  (*connection)["type"] = "std_msgs/String";
  (*connection)["message_definition"] = "string data\n";
  return {ros::Time(received), content, connection};
}

/// Files end at so many bytes as long as it lives, as they do on a full disk.
class FileLimit {
 public:
  explicit FileLimit(rlim_t bytes) : handler_(std::signal(SIGXFSZ, SIG_IGN)) {
    ::getrlimit(RLIMIT_FSIZE, &before_);
    rlimit limit = before_;
    limit.rlim_cur = bytes;
    ::setrlimit(RLIMIT_FSIZE, &limit);
  }
  ~FileLimit() {
    ::setrlimit(RLIMIT_FSIZE, &before_);
    std::signal(SIGXFSZ, handler_);
  }
  FileLimit(const FileLimit&) = delete;
  FileLimit& operator=(const FileLimit&) = delete;

 private:
  rlimit before_ = {};
  void (*handler_)(int);
};

class RecordingWriterTest : public testing::Test {
 protected:
  const TemporaryFolder folder_;
  const std::string path_ = folder_.path("session.bag");
};

TEST_F(RecordingWriterTest, KeepsBytesTypeAndTimeOfEveryMessage) {
  constexpr std::size_t kMessages = 5000;
  {
    RecordingWriter writer(path_);
    for (std::size_t n = 0; n < kMessages; ++n) {
      ASSERT_EQ(writer.add("/stream", messageOf(100 + n % 7, 1.0 + static_cast<double>(n))), "");
    }
    EXPECT_FALSE(fs::exists(path_));
    writer.finish();
  }
  rosbag::Bag bag(path_);
  rosbag::View view(bag);
  ASSERT_EQ(view.size(), kMessages);
  EXPECT_EQ(view.begin()->size(), 100U);
  EXPECT_EQ(view.begin()->getTime(), ros::Time(1.0));
  EXPECT_EQ(view.begin()->getDataType(), "std_msgs/String");
  EXPECT_EQ(view.getEndTime(), ros::Time(static_cast<double>(kMessages)));
}

TEST_F(RecordingWriterTest, FullDiskEndsItWithASentence) {
  const FileLimit limit(rlim_t{3} << 20U);
  RecordingWriter writer(path_);
  for (int n = 0; writer.failure().empty() && n < 100000; ++n) {
    writer.add("/stream", messageOf(100000));
  }
  const std::string message = errorMessage<DataError>([&] { writer.finish(); });
  EXPECT_EQ(message.rfind(path_ + ": the recording ended: ", 0), 0U) << message;
  EXPECT_NE(message.find("rosbag reindex"), std::string::npos) << message;
  EXPECT_TRUE(fs::exists(path_ + ".active"));
  EXPECT_FALSE(fs::exists(path_));
}

TEST_F(RecordingWriterTest, FullDiskAtTheVeryEndIsToldToo) {
  const FileLimit limit(5000);
  RecordingWriter writer(path_);
  writer.add("/stream", messageOf(100000));
  EXPECT_NE(errorMessage<DataError>([&] { writer.finish(); }).find(path_), std::string::npos);
  EXPECT_FALSE(fs::exists(path_));
}

TEST_F(RecordingWriterTest, FloodedTopicLosesItsOwnMessagesOnly) {
  RecordingWriter writer(path_);
  const RecordingWriter::Message large = messageOf(RecordedMessage::kLargest);
  std::string refusal;
  for (int n = 0; refusal.empty() && n < 10000; ++n) {
    refusal = writer.add("/flooded", large);
  }
  EXPECT_EQ(refusal, "it is one of more than the disk takes");
  EXPECT_EQ(writer.refusal("/flooded", RecordedMessage::kLargest + 1).rfind("it is 4194305", 0),
            0U);
  EXPECT_EQ(writer.refusal("/stream", 100), "");
  EXPECT_EQ(writer.add("/stream", messageOf(100)), "");
  EXPECT_EQ(writer.add("/stream", messageOf(RecordedMessage::kLargest + 1)),
            "it is 4194305 bytes long; 4194304 are the most that is recorded");
}

TEST_F(RecordingWriterTest, WhatWasNotCopiedIsNotWritten) {
  RecordingWriter writer(path_);
  const auto content = boost::make_shared<RecordedMessage>();
  content->length = 100;
  EXPECT_EQ(writer.add("/stream", {ros::Time(1.0), content, messageOf(1).connection}),
            "it is one of more than the disk takes");
}

TEST_F(RecordingWriterTest, NothingThatIsThereIsReplaced) {
  folder_.write("session.bag.active", "of a recorder that was killed");
  EXPECT_EQ(errorMessage<DataError>([&] { RecordingWriter writer(path_); }),
            path_ + ": the file exists already.");
  EXPECT_EQ(errorMessage<DataError>([&] {
              RecordingWriter writer(folder_.path("no/s.bag"));
            }).rfind(folder_.path("no/s.bag") + ": cannot be written: ", 0),
            0U);
}

}  // namespace
}  // namespace sac
