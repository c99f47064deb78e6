#include "spherical_actuator_calibration/ros/view/sample_mirror.hpp"

#include <utility>

#include <gtest/gtest.h>

#include "spherical_actuator_calibration/ros/conversion/messages.hpp"

namespace sac {
namespace {

msg::CalibrationSample sampleOf(std::uint32_t id) {
  msg::CalibrationSample sample;
  sample.id = id;
  return sample;
}

msg::CalibrationStatus statusOf(std::uint32_t orientations, std::vector<std::uint32_t> torques) {
  msg::CalibrationStatus status;
  status.orientation_samples = orientations;
  status.torque_samples = std::move(torques);
  return status;
}

TEST(SampleMirror, AsksForSamplesThatItDidNotSeeComeOrGo) {
  SampleMirror mirror;
  EXPECT_FALSE(mirror.takeRequest());
  mirror.receive(statusOf(2, {2, 0}));
  EXPECT_TRUE(mirror.takeRequest());
  EXPECT_FALSE(mirror.takeRequest());
  mirror.repeatRequest();
  EXPECT_TRUE(mirror.takeRequest());
  mirror.set({sampleOf(1), sampleOf(2)});
  EXPECT_EQ(mirror.samples().size(), 2U);
  mirror.receive(sampleOf(3));
  mirror.receive(statusOf(3, {2, 1}));
  EXPECT_FALSE(mirror.takeRequest());
  mirror.receive(statusOf(3, {2, 0}));
  EXPECT_TRUE(mirror.takeRequest());
}

TEST(SampleMirror, WhatIsOutOfUseDisappearsAndWhatCameMeanwhileStays) {
  SampleMirror mirror;
  for (const std::uint32_t id : {1U, 2U, 3U}) {
    mirror.receive(sampleOf(id));
  }
  mirror.receive(statusOf(2, {}));
  EXPECT_TRUE(mirror.takeRequest());
  mirror.receive(sampleOf(4));
  mirror.set({sampleOf(1)});
  EXPECT_EQ(mirror.samples().size(), 2U);
  mirror.receive(statusOf(0, {}));
  EXPECT_TRUE(mirror.takeRequest());
  mirror.set({});
  EXPECT_TRUE(mirror.samples().empty());
}

TEST(SampleMirror, ChangesAreToldOnce) {
  SampleMirror mirror;
  EXPECT_FALSE(mirror.takeChange());
  mirror.receive(sampleOf(1));
  EXPECT_TRUE(mirror.takeChange());
  EXPECT_FALSE(mirror.takeChange());
  mirror.set({});
  EXPECT_TRUE(mirror.takeChange());
}

}  // namespace
}  // namespace sac
