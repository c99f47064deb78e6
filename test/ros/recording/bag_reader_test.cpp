#include "bag_reader.hpp"

#include <algorithm>
#include <cstdint>
#include <new>
#include <random>
#include <stdexcept>
#include <string>
#include <tuple>
#include <vector>

#include <geometry_msgs/Vector3Stamped.h>
#include <gtest/gtest.h>
#include <rosbag/bag.h>
#include <rosbag/view.h>

#include "damaged_recording.hpp"
#include "support/error_message.hpp"
#include "support/temporary_folder.hpp"

namespace sac {
namespace {

/// A message as somebody got it: time and topic of its record, and its bytes.
using Handed = std::tuple<std::uint64_t, std::string, std::string>;

const std::vector<std::string> wanted_topics = {"/a", "/b", "/c"};

class BagReaderTest : public testing::Test {
 protected:
  struct Recording {
    rosbag::compression::CompressionType compression = rosbag::compression::Uncompressed;
    int messages = 2000;
    int disorder = 0;  ///< of the times of records [ms]
    std::uint64_t seed = 1;
  };

  /// Several messages at the same time, of different topics and of the same; chunks of some dozens.
  std::string record(const std::string& name, const Recording& recording) const {
    const std::string path = folder_.path(name);
    rosbag::Bag bag(path, rosbag::bagmode::Write);
    bag.setCompression(recording.compression);
    bag.setChunkThreshold(4096);
    std::mt19937_64 generator(recording.seed);
    std::uniform_int_distribution<int> late(0, recording.disorder);
    std::uniform_int_distribution<std::size_t> topic(0, wanted_topics.size());
    for (int n = 0; n < recording.messages; ++n) {
      geometry_msgs::Vector3Stamped message;
      message.header.seq = static_cast<std::uint32_t>(n);
      message.header.frame_id = name;
      const std::size_t k = topic(generator);
      const std::int64_t milliseconds = 1000 + n / 4 + late(generator);
      bag.write(k < wanted_topics.size() ? wanted_topics[k] : "/not_wanted",
                ros::Time(1e-3 * static_cast<double>(milliseconds)),
                message);
    }
    bag.close();
    return path;
  }

  static std::vector<Handed> byView(const std::vector<std::string>& paths) {
    std::vector<std::unique_ptr<rosbag::Bag>> bags;
    rosbag::View view;
    for (const std::string& path : paths) {
      bags.push_back(std::make_unique<rosbag::Bag>(path));
      view.addQuery(*bags.back(), rosbag::TopicQuery(wanted_topics));
    }
    std::vector<Handed> handed;
    for (const rosbag::MessageInstance& message : view) {
      std::string bytes(message.size(), '\0');
      ros::serialization::OStream stream(
          static_cast<std::uint8_t*>(static_cast<void*>(bytes.data())), message.size());
      message.write(stream);
      handed.emplace_back(message.getTime().toNSec(), message.getTopic(), bytes);
    }
    return handed;
  }

  static std::vector<Handed> byReader(const std::vector<std::string>& paths,
                                      std::size_t most_unpacked = std::size_t{1} << 20U) {
    const auto bags = openBags(paths);
    BagGroup group;
    for (const auto& bag : bags) {
      group.push_back(bag.get());
    }
    BagReader reader(group, wanted_topics, most_unpacked);
    std::vector<Handed> handed;
    BagMessage message;
    while (reader.next(message)) {
      handed.emplace_back(message.time.toNSec(), message.connection->topic, message.data);
    }
    EXPECT_FALSE(reader.next(message));
    if (handed.empty()) {
      throw std::logic_error("no message was handed out");
    }
    EXPECT_EQ(reader.begin().toNSec(), std::get<0>(handed.front()));
    EXPECT_EQ(reader.end().toNSec(), std::get<0>(handed.back()));
    return handed;
  }

  TemporaryFolder folder_;
};

TEST_F(BagReaderTest, HandsOutWhatRosbagDoes) {
  for (const auto compression :
       {rosbag::compression::Uncompressed, rosbag::compression::BZ2, rosbag::compression::LZ4}) {
    const std::string bag = record("session.bag", {compression});
    EXPECT_GT(byReader({bag}).size(), 1000U);
    EXPECT_TRUE(byReader({bag}) == byView({bag}));
  }
}

TEST_F(BagReaderTest, ChunksMayOverlapInTime) {
  for (const int disorder : {5, 100, 2000}) {
    const std::string bag = record("session.bag", {rosbag::compression::LZ4, 2000, disorder, 2});
    EXPECT_TRUE(byReader({bag}) == byView({bag})) << disorder;
    EXPECT_TRUE(byReader({bag}, 0) == byView({bag})) << disorder << ", one chunk at a time";
  }
}

TEST_F(BagReaderTest, BagsSideBySideAreReadAsOne) {
  std::vector<std::string> bags;
  for (const int n : {3, 4, 5, 6, 7, 8, 9}) {
    Recording recording;
    recording.messages = 100 * n;
    recording.disorder = 10 * n;
    recording.seed = static_cast<std::uint64_t>(n);
    bags.push_back(record("part_" + std::to_string(n) + ".bag", recording));
  }
  EXPECT_TRUE(byReader(bags) == byView(bags));
}

TEST_F(BagReaderTest, AChunkLoadedAheadIsToldWhenItsTurnComes) {
  const std::string bag = record("session.bag", {rosbag::compression::LZ4});
  const auto bags = openBags({bag});
  const BagIndex& index = bags.front()->index;
  ASSERT_GT(index.chunks.size(), 4U);
  std::string bytes = contentOf(bag);
  const std::uint64_t position = index.chunks[3].position;
  const FileRecord header = headerOfFile(bags.front()->bytes, position, kLargestChunk);
  bytes[position + header.bytes.size() + 100] ^= 1;  // in what is packed
  const auto damaged = openBags({folder_.write("damaged.bag", bytes)});
  BagReader reader({damaged.front().get()}, wanted_topics);
  const std::vector<Handed> whole = byReader({bag});
  std::size_t handed = 0;
  BagMessage message;
  const std::string told = errorMessage<DataError>([&] {
    for (; reader.next(message); ++handed) {
      EXPECT_EQ(message.data, std::get<2>(whole.at(handed)));
    }
  });
  EXPECT_NE(told.find("damaged.bag: cannot be read as a bag"), std::string::npos) << told;
  ros::Time damage = ros::TIME_MAX;
  for (const ChunkPart& part : index.chunks[3].parts) {
    damage = std::min(damage, part.begin);
  }
  ASSERT_LT(handed, whole.size());
  EXPECT_GE(std::get<0>(whole[handed]), damage.toNSec());
  EXPECT_GT(handed, 0U);
}

TEST_F(BagReaderTest, AReaderMayEndWhileAChunkIsLoaded) {
  const auto bags = openBags({record("session.bag", {rosbag::compression::LZ4})});
  for (int n = 0; n < 20; ++n) {
    BagReader reader({bags.front().get()}, wanted_topics);
    BagMessage message;
    EXPECT_TRUE(reader.next(message));
  }
}

/// Appends a number of four bytes, lowest first.
void append(std::string& bytes, std::size_t number) {
  for (unsigned bits = 0; bits < 32; bits += 8) {
    bytes.push_back(static_cast<char>(number >> bits & 0xFFU));
  }
}

/// A record of a message of connection 7.
std::string messageRecord(const std::string& time) {
  std::string header;
  for (const std::string& field :
       {std::string("conn=\7\0\0\0", 9), "time=" + time, std::string("op=\2")}) {
    append(header, field.size());
    header += field;
  }
  std::string bytes;
  append(bytes, header.size());
  bytes += header;
  append(bytes, 5);
  return bytes + "hello";
}

/// What is found, or what is wrong.
std::string found(MessageRecords& records, const std::string& chunk, std::size_t offset) {
  try {
    return std::string(records.messageAt(chunk, offset));
  } catch (const BagDefect& defect) {
    return std::string("defect: ") + defect.what();
  }
}

TEST(MessageRecords, ARecordAfterAnotherIsJudgedAsIfItWereTheFirst) {
  const std::string first = messageRecord("12345678");
  const std::string second = messageRecord("abcd=fgh");
  std::size_t defects = 0;
  for (std::size_t bit = 0; bit < 8 * second.size(); ++bit) {
    std::string wrong = second;
    wrong[bit / 8] = static_cast<char>(wrong[bit / 8] ^ (1 << bit % 8));
    MessageRecords fresh(7);
    MessageRecords used(7);
    ASSERT_EQ(found(used, first + wrong, 0), "hello");
    const std::string expected = found(fresh, first + wrong, first.size());
    EXPECT_EQ(found(used, first + wrong, first.size()), expected) << "bit " << bit;
    // What is wrong leaves no trace either.
    EXPECT_EQ(found(used, first + wrong, 0), "hello");
    EXPECT_EQ(found(used, first + wrong, first.size()), expected) << "bit " << bit;
    defects += expected.rfind("defect: ", 0) == 0 ? 1 : 0;
  }
  EXPECT_GT(defects, 100U);
}

TEST_F(BagReaderTest, AnIndexThatPointsElsewhereIsTold) {
  const std::string bag = record("session.bag", {});
  const auto bags = openBags({bag});
  const BagChunk& chunk = bags.front()->index.chunks.at(1);
  // The offset of the first message in the index, which follows the chunk.
  const FileRecord header = headerOfFile(bags.front()->bytes, chunk.position, kLargestChunk);
  const FileRecord index = recordOfFile(bags.front()->bytes, header.end, kLargestChunk);
  std::string bytes = contentOf(bag);
  bytes[index.end - index.data().size() + 8] ^= 1;
  const std::string damaged = folder_.write("damaged.bag", bytes);
  const std::string message = errorMessage<DataError>([&] { byReader({damaged}); });
  EXPECT_NE(message.find(damaged + ": cannot be read as a bag"), std::string::npos) << message;
}

TEST(DamagedRecording, ALackOfMemoryIsNoDamage) {
  const auto reading = [](const auto& error) { readUndamaged("a.bag", [&] { throw error; }); };
  EXPECT_THROW(reading(std::bad_alloc()), std::bad_alloc);
  EXPECT_NE(errorMessage<DataError>([&] { reading(std::length_error("long")); }).find("is damaged"),
            std::string::npos);
}

}  // namespace
}  // namespace sac
