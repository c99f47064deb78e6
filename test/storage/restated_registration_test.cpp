// Uncertainties of a session rest on what was stated of registrations when it was calibrated.
#include <string>

#include <gtest/gtest.h>

#include "spherical_actuator_calibration/storage/live_session.hpp"
#include "storage/database_examples.hpp"
#include "support/scenarios.hpp"
#include "support/temporary_folder.hpp"

namespace sac {
namespace {

using database_examples::kDate;

class RestatedRegistration : public ::testing::Test {
 protected:
  LiveSession with(double tracker) const {
    CalibrationConfig config;
    stateRegistration(config, {tracker, 0.0, 0.0});
    return {{scenarios::paperNominal()}, config, folder_.path("session.db"), "0.1.0"};
  }

  static void addAll(LiveSession& session) {
    for (Sample sample : scenarios::heldOutSession()) {
      sample.id = 0;
      session.addSample(sample, kDate);
    }
  }

  TemporaryFolder folder_;
};

TEST_F(RestatedRegistration, IsAsUncertainAsRegistrationWasStatedUntilItIsCalibratedAgain) {
  {
    LiveSession session = with(1e-3);
    addAll(session);
    ASSERT_TRUE(session.run({Cycle::kRefine}, kDate).success);
    EXPECT_EQ(session.grade().grade, Grade::kGood) << session.grade().reason;
  }
  EXPECT_EQ(with(1e-3).grade().grade, Grade::kGood);
  LiveSession session = with(4e-3);
  EXPECT_EQ(session.grade().grade, Grade::kUsable);
  EXPECT_NE(session.grade().reason.find("stated otherwise"), std::string::npos)
      << session.grade().reason;
  ASSERT_TRUE(session.run({Cycle::kRefine}, kDate).success);
  EXPECT_EQ(session.grade().grade, Grade::kGood) << session.grade().reason;
}

TEST_F(RestatedRegistration, OfAnEarlierFormatIsNotKnown) {
  {
    LiveSession session = with(1e-3);
    addAll(session);
    session.run({Cycle::kJoint}, kDate);
  }
  database_examples::change(folder_.path("session.db"),
                            "ALTER TABLE cycles DROP COLUMN error_unit;"
                            "ALTER TABLE cycles DROP COLUMN registration; PRAGMA user_version = 8");
  LiveSession session = with(2e-3);
  EXPECT_TRUE(session.lastReport()->registration.empty());
  session.run({Cycle::kJoint}, kDate);
  EXPECT_NE(session.lastReport()->registration.find("stator_tracker: 0.002"), std::string::npos);
}

}  // namespace
}  // namespace sac
