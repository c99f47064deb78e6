#include "spherical_actuator_calibration/base/long_series.hpp"

#include <cstdlib>
#include <fstream>
#include <numeric>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include <gtest/gtest.h>
#include <sys/resource.h>

namespace sac {
namespace {

/// Of this process that lie in a file or in shared memory, in its memory now [bytes].
std::size_t fileBytesInMemory() {
  std::ifstream status("/proc/self/status");
  std::string word;
  std::size_t kilobytes = 0;
  while (status >> word) {
    if (word == "RssFile:" || word == "RssShmem:") {
      std::size_t some = 0;
      status >> some;
      kilobytes += some;
    }
  }
  return 1024 * kilobytes;
}

LongSeries<double> counted(std::size_t count) {
  LongSeries<double> series;
  for (std::size_t n = 0; n < count; ++n) {
    series.push_back(static_cast<double>(n));
  }
  return series;
}

bool isCounted(const LongSeries<double>& series) {
  for (std::size_t n = 0; n < series.size(); ++n) {
    if (series[n] != static_cast<double>(n)) {
      return false;
    }
  }
  return true;
}

constexpr std::size_t kMany = 8'000'000;  // 64 MB

TEST(LongSeries, IsUsedLikeAVector) {
  LongSeries<int> series{3, 1, 2};
  series.push_back(series.front());
  EXPECT_EQ(series.size(), 4U);
  EXPECT_EQ(std::vector<int>(series.begin(), series.end()), (std::vector<int>{3, 1, 2, 3}));
  series[1] = 7;
  EXPECT_EQ(std::accumulate(series.begin(), series.end(), 0), 15);
  const LongSeries<int> copy = series;
  series.clear();
  EXPECT_TRUE(series.empty());
  EXPECT_EQ(copy.back(), 3);
  const LongSeries<int> moved = std::move(series);
  EXPECT_TRUE(moved.empty());
}

TEST(LongSeries, OfManyValuesKeepsThemAllAndFewInMemory) {
  const std::size_t before = fileBytesInMemory();
  const LongSeries<double> series = counted(kMany);
  EXPECT_TRUE(isCounted(series));
  const LongSeries<double> copy = series;
  EXPECT_TRUE(isCounted(copy));
  EXPECT_LT(fileBytesInMemory(), before + 12'000'000);
}

TEST(LongSeries, IsReadBySeveralThreadsAtOnce) {
  const LongSeries<double> series = counted(kMany);
  std::vector<char> is_counted(4, 0);
  std::vector<std::thread> threads;
  for (char& one : is_counted) {
    threads.emplace_back([&series, &one] { one = isCounted(series) ? 1 : 0; });
  }
  for (std::thread& thread : threads) {
    thread.join();
  }
  EXPECT_EQ(is_counted, std::vector<char>(4, 1));
}

/// TMPDIR for the time being.
class TemporaryFolder {
 public:
  explicit TemporaryFolder(const std::string& path) {
    const char* before = std::getenv("TMPDIR");
    before_ = before == nullptr ? "" : before;
    ::setenv("TMPDIR", path.c_str(), 1);
  }
  ~TemporaryFolder() { ::setenv("TMPDIR", before_.c_str(), 1); }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;

 private:
  std::string before_;
};

TEST(LongSeries, StaysInMemoryWithoutAFolder) {
  const TemporaryFolder folder("/nonexistent");
  const LongSeries<double> series = counted(kMany / 8);
  EXPECT_TRUE(isCounted(series));
}

/// Files have so many bytes at the most for the time being, as where a disk is full.
class FileLimit {
 public:
  explicit FileLimit(rlim_t bytes) {
    ::getrlimit(RLIMIT_FSIZE, &before_);
    const rlimit limit{bytes, before_.rlim_max};
    ::setrlimit(RLIMIT_FSIZE, &limit);
  }
  ~FileLimit() { ::setrlimit(RLIMIT_FSIZE, &before_); }
  FileLimit(const FileLimit&) = delete;
  FileLimit& operator=(const FileLimit&) = delete;

 private:
  rlimit before_{};
};

TEST(LongSeries, GoesBackToMemoryWhereItsFileCannotGrow) {
  const FileLimit limit(20'000'000);
  const LongSeries<double> series = counted(kMany);
  EXPECT_TRUE(isCounted(series));
}

}  // namespace
}  // namespace sac
