#include "spherical_actuator_calibration/planning/session_plan_file.hpp"

#include <string>

#include <gtest/gtest.h>

#include "spherical_actuator_calibration/base/atomic_file.hpp"
#include "spherical_actuator_calibration/base/error.hpp"
#include "spherical_actuator_calibration/planning/session_plan_record.hpp"
#include "support/scenarios.hpp"
#include "support/temporary_folder.hpp"

namespace sac {
namespace {

class SessionPlanFile : public ::testing::Test {
 protected:
  SessionPlanFile() {
    record_.actuator = actuator_.name;
    record_.cycle = "refine";
    record_.current = 1.5;
    record_.orientation_stddev = 1e-3;
    record_.torque_stddev = 1e-3;
    record_.plan.worst_parameter = "coil_1/polar";
    record_.plan.stddev_bound = 1.9e-4;
    PlannedPose weighing{Eigen::Vector3d(0.1, -0.2, 1.5), {0, 3, 11}, {}};
    weighing.patterns = {{{0, 1}, {3, -1}}, {{3, 1}, {11, 1}}};
    record_.plan.poses = {weighing, {Eigen::Vector3d(0.0, 0.3, 0.0), {2, 5}, {}}};
  }

  SessionPlanRecord loaded(const std::string& text) {
    writeFileAtomically(folder_.path("plan.yaml"), text, OverwritePolicy::kReplace);
    return loadSessionPlan(folder_.path("plan.yaml"));
  }

  /// Carried out by the actuator.
  SessionPlan session() {
    writeFileAtomically(
        folder_.path("plan.yaml"), renderSessionPlan(record_), OverwritePolicy::kReplace);
    return loadPlannedSession(folder_.path("plan.yaml"), actuator_);
  }

  void expectRefusal(const std::string& part) {
    try {
      session();
      ADD_FAILURE() << part;
    } catch (const ConfigError& error) {
      EXPECT_EQ(std::string(error.what()), folder_.path("plan.yaml") + ": " + part);
    }
  }

  /// The file's text with one part replaced.
  std::string textWith(const std::string& part, const std::string& other) const {
    std::string text = renderSessionPlan(record_);
    text.replace(text.find(part), part.size(), other);
    return text;
  }

  Actuator actuator_ = scenarios::paperNominal();
  SessionPlanRecord record_;
  TemporaryFolder folder_;
};

TEST_F(SessionPlanFile, GivesBackPatternsAndBound) {
  const SessionPlanRecord again = loaded(renderSessionPlan(record_));
  ASSERT_EQ(again.plan.poses.size(), 2U);
  EXPECT_EQ(again.plan.poses[0].patterns, record_.plan.poses[0].patterns);
  EXPECT_EQ(again.plan.poses[0].coils, record_.plan.poses[0].coils);
  EXPECT_TRUE(again.plan.poses[1].patterns.empty());
  EXPECT_EQ(again.plan.stddev_bound, record_.plan.stddev_bound);
}

TEST_F(SessionPlanFile, IsCarriedOutWithItsSigns) {
  const SessionPlan session = this->session();
  ASSERT_EQ(session.dwells.size(), 2U);
  ASSERT_EQ(session.dwells[0].patterns.size(), 2U);
  const Eigen::VectorXd& first = session.dwells[0].patterns[0];
  EXPECT_EQ(first[0], 1.5);
  EXPECT_EQ(first[3], -1.5);
  EXPECT_EQ(first.cwiseAbs().sum(), 3.0);
  ASSERT_EQ(session.dwells[1].patterns.size(), 2U);
  EXPECT_EQ(session.dwells[1].patterns[1][5], 1.5);
  EXPECT_EQ(session.dwells[1].patterns[1].cwiseAbs().sum(), 1.5);
}

TEST_F(SessionPlanFile, NamesThePatternThatIsNone) {
  for (const char* pattern :
       {"1 -4", "+1 +", "+1 -4x", "+0 -4", "+4 -1", "+1 -1", "+1 -5", "+1 4"}) {
    try {
      loaded(textWith("+1 -4", pattern));
      ADD_FAILURE() << pattern;
    } catch (const ConfigError& error) {
      EXPECT_NE(std::string(error.what()).find("patterns"), std::string::npos) << error.what();
    }
  }
}

TEST_F(SessionPlanFile, IsRefusedWhereACoilIsMissing) {
  record_.plan.poses[1].coils[1] = 24;
  expectRefusal("pose 2: it excites coil 25 of the 24 that there are.");
}

TEST_F(SessionPlanFile, IsRefusedBeyondTheWorkspace) {
  record_.plan.poses[0].joint_position[1] = -actuator_.workspace.tilt_limit;
  EXPECT_NO_THROW(session());
  record_.plan.poses[0].joint_position[1] = -0.625;
  expectRefusal("pose 1: a tilt of 0.625 rad is beyond the workspace's tilt_limit of 0.6 rad.");
}

TEST_F(SessionPlanFile, IsRefusedOfAnotherUnit) {
  record_.serial = "A8";
  actuator_.serial = "A7";
  expectRefusal("it is for the unit A8, not for A7.");
  record_.serial.clear();
  EXPECT_NO_THROW(session());
  record_.actuator = "cube";
  expectRefusal("it is for the actuator cube, not for " + actuator_.name + ".");
}

TEST_F(SessionPlanFile, IsRefusedWithoutPoses) {
  record_.plan.poses.clear();
  expectRefusal("it has no pose.");
}

}  // namespace
}  // namespace sac
