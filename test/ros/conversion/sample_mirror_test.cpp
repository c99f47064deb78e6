#include "spherical_actuator_calibration/ros/conversion/sample_mirror.hpp"

#include <cstddef>
#include <string>
#include <utility>

#include <gtest/gtest.h>

#include "spherical_actuator_calibration/base/error.hpp"
#include "spherical_actuator_calibration/ros/conversion/messages.hpp"
#include "support/error_message.hpp"

namespace sac {
namespace {

constexpr std::size_t kCoils = 3;

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
  SampleMirror mirror(kCoils);
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
  SampleMirror mirror(kCoils);
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
  SampleMirror mirror(kCoils);
  EXPECT_FALSE(mirror.takeChange());
  mirror.receive(sampleOf(1));
  EXPECT_TRUE(mirror.takeChange());
  EXPECT_FALSE(mirror.takeChange());
  mirror.set({});
  EXPECT_TRUE(mirror.takeChange());
}

TEST(SampleMirror, SamplesOfAnotherActuatorAreRefused) {
  SampleMirror mirror(kCoils);
  msg::CalibrationSample sample = sampleOf(1);
  sample.current.resize(500000);
  EXPECT_EQ(errorMessage<DataError>([&] { mirror.receive(sample); }),
            "it has 500000 currents, and the actuator 3 coils");
  mirror.set({sample});
  EXPECT_TRUE(mirror.samples().empty());
  sample.current.resize(kCoils);
  mirror.receive(sample);
  EXPECT_EQ(mirror.samples().size(), 1U);
}

TEST(SampleMirror, FloodsCostBoundedMemory) {
  SampleMirror mirror(kCoils);
  msg::CalibrationSample sample;
  sample.header.frame_id = std::string(1000, 'x');
  constexpr std::uint32_t kSent = SampleMirror::kMost + 100;
  for (std::uint32_t id = 1; id <= kSent; ++id) {
    sample.id = id;
    mirror.receive(sample);
  }
  EXPECT_EQ(mirror.samples().size(), SampleMirror::kMost);
  EXPECT_EQ(mirror.samples().count(1), 0U);
  EXPECT_EQ(mirror.samples().count(kSent), 1U);
  EXPECT_EQ(mirror.samples().begin()->second.header.frame_id, "");
  mirror.set({});
  EXPECT_EQ(mirror.samples().size(), SampleMirror::kMost);
}

}  // namespace
}  // namespace sac
