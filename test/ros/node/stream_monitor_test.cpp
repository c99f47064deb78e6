#include "spherical_actuator_calibration/ros/node/stream_monitor.hpp"

#include <cmath>
#include <map>
#include <string>

#include <gtest/gtest.h>

namespace sac {
namespace {

using diagnostic_msgs::DiagnosticStatus;

class StreamMonitorTest : public ::testing::Test {
 protected:
  void SetUp() override {
    ros::Time::init();
    ros::Time::setNow(ros::Time(100.0));
  }
  void TearDown() override { ros::Time::shutdown(); }

  diagnostic_updater::DiagnosticStatusWrapper status() {
    diagnostic_updater::DiagnosticStatusWrapper result;
    monitor_.run(result);
    return result;
  }

  static std::string value(const DiagnosticStatus& status, const std::string& key) {
    for (const auto& item : status.values) {
      if (item.key == key) {
        return item.value;
      }
    }
    return "no such key";
  }

  StreamMonitor monitor_{"joint_states", {1e-3, 0.5}};
};

TEST_F(StreamMonitorTest, IsInErrorBeforeTheFirstMeasurement) {
  EXPECT_EQ(status().level, DiagnosticStatus::ERROR);
  EXPECT_TRUE(std::isinf(monitor_.age(ros::Time(100.0))));
}

// One message with such a stamp ended the node that received it.
TEST_F(StreamMonitorTest, LivesOnWithAStampOfAnotherCentury) {
  monitor_.accept(ros::Time(4294967295, 0));
  EXPECT_NEAR(monitor_.age(ros::Time(100.0)), 100.0 - 4294967295.0, 1e-3);
  EXPECT_EQ(value(status(), "accepted"), "1");
}

TEST_F(StreamMonitorTest, ShowsTextThatATerminalWouldObey) {
  monitor_.refuse("it is in the frame \x1b[2J");
  EXPECT_EQ(value(status(), "last refusal"), "it is in the frame \\x1b[2J");
}

TEST_F(StreamMonitorTest, IsGoodWhileMeasurementsCome) {
  monitor_.accept(ros::Time(99.9));
  const auto result = status();
  EXPECT_EQ(result.level, DiagnosticStatus::OK);
  EXPECT_EQ(value(result, "accepted"), "1");
  EXPECT_NEAR(monitor_.age(ros::Time(100.0)), 0.1, 1e-9);
}

TEST_F(StreamMonitorTest, TellsASilentStreamAtOnce) {
  monitor_.accept(ros::Time(99.9));
  ros::Time::setNow(ros::Time(100.6));
  const auto result = status();
  EXPECT_EQ(result.level, DiagnosticStatus::ERROR);
  EXPECT_EQ(result.message, "silent for 0.70 s");
}

TEST_F(StreamMonitorTest, TellsWhyMeasurementsAreRefusedWhileTheyAre) {
  monitor_.accept(ros::Time(99.9));
  monitor_.refuse("it is not finite");
  auto result = status();
  EXPECT_EQ(result.level, DiagnosticStatus::WARN);
  EXPECT_EQ(result.message, "refused: it is not finite");
  monitor_.accept(ros::Time(100.0));
  result = status();
  EXPECT_EQ(result.level, DiagnosticStatus::OK);
  EXPECT_EQ(value(result, "refused"), "1");
  EXPECT_EQ(value(result, "last refusal"), "it is not finite");
}

}  // namespace
}  // namespace sac
