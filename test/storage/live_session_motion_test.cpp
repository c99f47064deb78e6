// What a session remembers of a motion.
#include <memory>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "spherical_actuator_calibration/storage/live_session.hpp"
#include "storage/database_examples.hpp"
#include "support/moving_rotor.hpp"
#include "support/scenarios.hpp"
#include "support/temporary_folder.hpp"

namespace sac {
namespace {

using database_examples::kDate;

class LiveSessionMotionTest : public ::testing::Test {
 protected:
  LiveSession open() const {
    return LiveSession({scenarios::paperNominal()}, {}, folder_.path("session.db"), "0.1.0");
  }

  TemporaryFolder folder_;
};

TEST_F(LiveSessionMotionTest, RemembersWhatAMotionTold) {
  {
    LiveSession session = open();
    scenarios::Generator generator(3);
    std::vector<Sample> samples = scenarios::paperSession(
        scenarios::paperTruth(), scenarios::Tracker::kFirstTenPoses, generator);
    samples.resize(40);
    for (Sample& sample : samples) {
      sample.id = 0;
      session.addSample(sample, kDate);
    }
    MovingRotor moving;
    moving.truth = scenarios::paperTruth();
    session.setMotion(std::make_shared<const MotionRecording>(moving.record()));
    ASSERT_TRUE(session.run({Cycle::kMotion}, kDate).success);
    ASSERT_TRUE(session.run({Cycle::kJoint}, kDate).success);
  }
  LiveSession session = open();
  const CycleReport report = session.run({Cycle::kRefine}, kDate);
  ASSERT_TRUE(report.success) << report.message;
  EXPECT_NE(report.message.find("both agree"), std::string::npos) << report.message;
  session.restore(2, kDate);
  EXPECT_TRUE(session.calibration().motionEvidence());
  session.restore(0, kDate);
  EXPECT_FALSE(session.calibration().motionEvidence());
}

// A node that is started again says of a motion what it said before.
TEST_F(LiveSessionMotionTest, JudgesAMotionAfterARestartAsBefore) {
  MovingRotor moving;
  moving.truth = scenarios::paperTruth();
  moving.duration = 12.0;
  GradedCalibration before;
  std::size_t windows = 0;
  {
    LiveSession session = open();
    session.setMotion(std::make_shared<const MotionRecording>(noisy(moving.record())));
    const CycleReport report = session.run({Cycle::kMotion}, kDate);
    ASSERT_TRUE(report.success) << report.message;
    before = session.grade();
    windows = report.residuals.size();
    ASSERT_NE(before.reason.find("held-out windows agree"), std::string::npos) << before.reason;
  }
  const LiveSession session = open();
  EXPECT_EQ(session.lastReport()->residuals.size(), windows);
  EXPECT_GT(windows, 40U);
  EXPECT_EQ(session.grade().grade, before.grade);
  EXPECT_EQ(session.grade().reason, before.reason);
}

}  // namespace
}  // namespace sac
