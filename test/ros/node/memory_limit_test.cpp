#include "spherical_actuator_calibration/ros/node/memory_limit.hpp"

#include <cstddef>
#include <cstdlib>
#include <memory>
#include <new>

#include <gtest/gtest.h>

namespace sac {
namespace {

constexpr std::size_t kMegabyte = 1'000'000;

bool canHave(std::size_t megabytes) {
  const std::unique_ptr<char[]> memory(new (std::nothrow) char[megabytes * kMegabyte]);
  return memory != nullptr;
}

// In a process of its own, as the limit stays.
TEST(MemoryLimit, HoldsForWhatIsTakenFromThenOn) {
  ::testing::FLAGS_gtest_death_test_style = "threadsafe";
  EXPECT_EXIT(
      {
        const bool before = canHave(700);
        limitMemory(500.0);
        std::_Exit(before && canHave(300) && !canHave(700) ? 0 : 1);
      },
      ::testing::ExitedWithCode(0),
      "");
}

}  // namespace
}  // namespace sac
