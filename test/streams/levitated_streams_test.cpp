#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "spherical_actuator_calibration/base/pi.hpp"
#include "spherical_actuator_calibration/base/rotations.hpp"
#include "spherical_actuator_calibration/streams/sample_builder.hpp"
#include "streams/scripted_dwell.hpp"
#include "support/synthetic_streams.hpp"

namespace sac {
namespace {

using synthetic::Script;
using synthetic::Sensors;

/// The streams of a rotor without joints.
synthetic::Streams streamsOf(const Script& script, const Sensors& sensors = {}) {
  synthetic::Streams streams = synthetic::record(script, sensors, 3);
  streams.joints.clear();
  return streams;
}

double apart(const Sample& sample, const Eigen::Vector3d& place) {
  return rotationLog(sample.R_stator_rotor * Script::orientation(place).transpose()).norm();
}

TEST(LevitatedStreams, OrientationsTellRestAndPlace) {
  const Eigen::Vector3d place(0.3, -0.2, 1.0);
  SampleBuilder builder({}, kCoils, false);
  const std::vector<Sample> samples = samplesOf(builder, streamsOf(twoPatterns(place)));
  ASSERT_EQ(samples.size(), 4U);
  for (const Sample& sample : samples) {
    EXPECT_TRUE(sample.has_orientation);
    EXPECT_LT(apart(sample, place), 3e-4);
    EXPECT_EQ(sample.joint_position, samples.front().joint_position);
    EXPECT_LT((sample.joint_position - place).norm(), 4e-4);
    // 120 Hz over 2.5 s of rest, 0.5 mrad each: the mean of all of it, which all share.
    EXPECT_NEAR(sample.orientation_stddev, 5e-4 / std::sqrt(300.0), 8e-6);
    EXPECT_EQ(sample.joint_stddev, Eigen::Vector3d::Constant(sample.orientation_stddev));
    EXPECT_EQ(sample.joint_shared_stddev, sample.joint_stddev);
    EXPECT_EQ(sample.dwell, samples.front().dwell);
  }
  EXPECT_LT((samples[1].torque - Script::torque(samples[1].current)).norm(), 2e-3);
  EXPECT_EQ(builder.report().dwells, 1U);
  EXPECT_EQ(builder.report().joints.received, 0U);
}

TEST(LevitatedStreams, JointMeasurementsAreIgnored) {
  const Eigen::Vector3d place(0.3, -0.2, 1.0);
  synthetic::Streams streams = synthetic::record(twoPatterns(place), {}, 3);
  for (JointMeasurement& measurement : streams.joints) {
    measurement.position.setRandom();
  }
  SampleBuilder builder({}, kCoils, false);
  EXPECT_EQ(samplesOf(builder, streams).size(), 4U);
  EXPECT_EQ(builder.report().joints.received, 0U);
}

TEST(LevitatedStreams, ATurnAndAHalfAwayIsNoJump) {
  for (const double spin : {kPi, -kPi, 3.1415}) {
    const Eigen::Vector3d place(0.1, 0.2, spin);
    SampleBuilder builder({}, kCoils, false);
    const std::vector<Sample> samples = samplesOf(builder, streamsOf(twoPatterns(place)));
    ASSERT_EQ(samples.size(), 4U) << spin;
    EXPECT_LT(apart(samples[1], place), 3e-4);
  }
}

TEST(LevitatedStreams, AnOrientationFarTiltedIsAsGood) {
  const Eigen::Vector3d place(0.4, 1.4, -1.0);
  SampleBuilder builder({}, kCoils, false);
  const std::vector<Sample> samples = samplesOf(builder, streamsOf(twoPatterns(place)));
  ASSERT_EQ(samples.size(), 4U);
  EXPECT_LT(apart(samples[1], place), 3e-4);
}

TEST(LevitatedStreams, ARotorThatDriftsGivesNoSample) {
  const Script script = Script(kCoils)
                            .moveTo({0.1, 0.0, 0.0})
                            .rest(0.5)
                            .driftBy({0.0, 0.002, 0.0}, 2.0)
                            .rest(0.5)
                            .moveTo({-0.1, 0.0, 0.0});
  SampleBuilder builder({}, kCoils, false);
  EXPECT_TRUE(samplesOf(builder, streamsOf(script)).empty());
  ASSERT_FALSE(builder.report().events.empty());
  EXPECT_EQ(builder.report().events.front().reason.substr(0, 33),
            "The measured orientation moved by");
}

TEST(LevitatedStreams, ACaptureAveragesItsOwnSpan) {
  const Eigen::Vector3d place(0.3, -0.2, 1.0);
  const Script script = Script(kCoils).moveTo(place).rest(0.8).excite(0, 2.0, 4.0);
  SampleBuilder builder({}, kCoils, false);
  synthetic::feed(builder, streamsOf(script));
  const CaptureProgress progress = builder.capture(synthetic::stampAt(2.5), 1.0);
  ASSERT_EQ(progress.state, CaptureProgress::State::kDone) << progress.message;
  EXPECT_LT(apart(*progress.sample, place), 3e-4);
  EXPECT_NEAR(progress.sample->joint_stddev[0], 5e-4 / std::sqrt(120.0), 1.5e-5);
  // Another capture of the dwell measures the orientation anew.
  EXPECT_TRUE(progress.sample->joint_shared_stddev.isZero(0.0));
}

TEST(LevitatedStreams, WithoutATrackerACaptureTellsWhatIsMissing) {
  synthetic::Streams streams = streamsOf(twoPatterns({0.3, -0.2, 1.0}));
  streams.orientations.clear();
  SampleBuilder builder({}, kCoils, false);
  synthetic::feed(builder, streams);
  EXPECT_EQ(builder.capture(synthetic::stampAt(2.0), 0.5).message,
            "No orientation has come: is measured_orientation published?");
}

TEST(LevitatedStreams, SamplesAreFoundAgain) {
  const Script script = twoPatterns({0.3, -0.2, 1.0});
  SampleBuilder builder({}, kCoils, false);
  const std::vector<Sample> taken = samplesOf(builder, streamsOf(script));
  SampleBuilder again({}, kCoils, false);
  again.repeat(taken);
  const std::vector<Sample> repeated = samplesOf(again, streamsOf(script));
  ASSERT_EQ(repeated.size(), taken.size());
  for (std::size_t n = 0; n < taken.size(); ++n) {
    EXPECT_EQ(repeated[n].joint_position, taken[n].joint_position);
    EXPECT_EQ(repeated[n].torque, taken[n].torque);
    EXPECT_EQ(repeated[n].joint_shared_stddev, taken[n].joint_shared_stddev);
  }
}

}  // namespace
}  // namespace sac
