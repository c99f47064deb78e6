#include "motion_history.hpp"

#include <string>

#include <gtest/gtest.h>

namespace sac {
namespace {

/// After so many windows; joints, poles and coils are known equally well.
msg::MotionProgress progress(unsigned windows, double stddev) {
  msg::MotionProgress message;
  message.told = 1;
  message.message = "Much is told.";
  message.windows = windows;
  message.duration = 0.25 * windows;
  message.reduced_chi_square = 1.02;
  message.wanted_stddev = 1e-4;
  message.time_left = 7.2;
  for (const char* name : {"joints", "poles", "coils"}) {
    msg::GroupUncertainty group;
    group.group = name;
    group.least_known = std::string(name) + "_least";
    group.stddev = stddev;
    group.parameters = 9;
    group.left = stddev > 1e-4 ? 4 : 0;
    message.groups.push_back(group);
  }
  return message;
}

TEST(MotionHistory, KeepsWhatWasToldAfterEachWindow) {
  MotionHistory history;
  msg::MotionProgress first = progress(10, 1e-2);
  first.told = 0;
  history.receive(first);
  history.receive(progress(24, 2e-3));
  history.receive(progress(25, 1e-3));
  history.receive(progress(25, 1e-3));  // it was linearised anew
  ASSERT_EQ(history.curves().size(), 3U);
  EXPECT_EQ(history.curves()[1].group, "poles");
  EXPECT_EQ(history.curves()[1].seconds, (std::vector<double>{6.0, 6.25}));
  EXPECT_EQ(history.curves()[2].stddevs, (std::vector<double>{2e-3, 1e-3}));
}

TEST(MotionHistory, SaysWhatIsTold) {
  MotionHistory history;
  EXPECT_EQ(history.words(), "The node calibration tells of no motion.");
  msg::MotionProgress message = progress(10, 1e-2);
  message.told = 0;
  history.receive(message);
  EXPECT_EQ(history.words(), "Much is told.");
  history.receive(progress(80, 9e-5));
  EXPECT_EQ(history.words(), "Much is told. Misfit over noise, squared: 1.02.");
}

TEST(MotionHistory, BeginsAnewWithAnotherMotion) {
  MotionHistory history;
  history.receive(progress(24, 2e-3));
  history.receive(progress(60, 1e-3));
  history.receive(progress(0, 1e-2));
  history.receive(progress(24, 3e-3));
  EXPECT_EQ(history.curves()[0].stddevs, (std::vector<double>{1e-2, 3e-3}));
}

TEST(MotionHistory, OfAnHourIsNoLargerThanAPicture) {
  MotionHistory history;
  constexpr unsigned kHour = 14400;
  for (unsigned n = 24; n < kHour; ++n) {
    history.receive(progress(n, 1.0 / n));
  }
  EXPECT_LT(history.curves()[0].seconds.size(), 4100U);
  EXPECT_EQ(history.curves()[0].seconds.front(), 6.0);
  EXPECT_EQ(history.curves()[0].seconds.back(), 0.25 * (kHour - 1));
}

TEST(MotionHistory, ListsWhatElseIsFound) {
  MotionHistory history;
  msg::MotionProgress last = progress(80, 9e-5);
  last.dynamics.resize(2);
  last.dynamics[0].name = "current_delay";
  last.dynamics[0].value = 0.00412;
  last.dynamics[0].stddev = 2e-6;
  last.dynamics[0].unit = "s";
  last.dynamics[0].observable = 1;
  history.receive(last);
  ASSERT_EQ(history.dynamics().size(), 1U);
  EXPECT_EQ(history.dynamics()[0], "current_delay = 0.00412 ± 2e-06 s");
}

}  // namespace
}  // namespace sac
