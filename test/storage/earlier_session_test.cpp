#include "spherical_actuator_calibration/storage/earlier_session.hpp"

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>
#include <sys/stat.h>

#include "spherical_actuator_calibration/base/error.hpp"
#include "spherical_actuator_calibration/storage/session_database.hpp"
#include "storage/database_examples.hpp"
#include "support/error_message.hpp"
#include "support/temporary_folder.hpp"

namespace sac {
namespace {

using database_examples::kCoils;
using database_examples::kDate;

constexpr double kThreshold = 0.05;  // [A]
const Eigen::Vector3d here(0.1, 0.2, 0.3);
const Eigen::Vector3d there(0.4, 0.0, 0.0);

/// Current [A] of each coil, counted from 0, that has one.
using Currents = std::vector<std::pair<Eigen::Index, double>>;

class EarlierSessionTest : public ::testing::Test {
 protected:
  std::string path() const { return folder_.path("session.db"); }
  Actuator actuator() const { return identity_.start.actuator; }

  void measure(const Eigen::Vector3d& q, const Currents& currents, bool validation = false) {
    SessionDatabase database(path(), identity_);
    Sample sample = database_examples::sample(database.nextSampleId(), kCoils);
    sample.joint_position = q;
    sample.validation = validation;
    sample.current.setZero();
    for (const auto& [coil, current] : currents) {
      sample.current[coil] = current;
    }
    database.addSample(sample, kDate);
  }
  EarlierSession load() const { return loadEarlierSession(path(), actuator(), kThreshold); }
  std::string refusal(const Actuator& of) const {
    return errorMessage<DataError>([&] { loadEarlierSession(path(), of, kThreshold); });
  }
  void expectRefusal(const std::string& part, const Actuator& of) const {
    const std::string message = refusal(of);
    EXPECT_NE(message.find(part), std::string::npos) << message;
    EXPECT_EQ(message.rfind(path() + ": ", 0), 0U) << message;
  }

  TemporaryFolder folder_;
  const SessionIdentity identity_ = database_examples::identity();
};

TEST_F(EarlierSessionTest, IsMeasuredAgainAsItWas) {
  const Eigen::Vector3d nearby = here + Eigen::Vector3d(0.01, 0.0, 0.0);
  measure(here, {});
  measure(nearby, {{0, 2.001}, {3, 0.001}});
  measure(nearby, {{0, -2.001}});
  measure(here, {{1, 1.999}, {2, -2.0}});
  measure(here, {{1, 2.0}, {2, -1.998}});
  measure(here, {{3, 2.0}});
  SessionDatabase(path(), identity_).removeSample(6, kDate);
  measure(here, {{2, 2.0}}, true);
  measure(there, {{2, 2.0}}, true);
  const std::string before = contentOf(path());
  const EarlierSession session = load();
  EXPECT_EQ(session.current, 2.0);
  const PosesToMeasure expected{{here, {{{0, 1}}, {{0, -1}}, {{1, 1}, {2, -1}}}, false},
                                {here, {{{2, 1}}}, true},
                                {there, {{{2, 1}}}, true}};
  EXPECT_EQ(session.poses, expected);
  EXPECT_EQ(contentOf(path()), before);
}

TEST_F(EarlierSessionTest, WithoutCurrentsItHasNone) {
  measure(here, {});
  EXPECT_EQ(load().current, 0.0);
  EXPECT_TRUE(load().poses.at(0).patterns.empty());
}

TEST_F(EarlierSessionTest, WhatAHandMetBeyondTheEdgeIsMovedThere) {
  const double limit = actuator().workspace.tilt_limit;
  measure({-limit - 0.02, limit + 0.01, 9.0}, {});
  EXPECT_EQ(load().poses.at(0).joint_position, Eigen::Vector3d(-limit, limit, 9.0));
  Actuator narrower = actuator();
  narrower.workspace.tilt_limit = limit - 0.1;
  expectRefusal("beyond the tilt_limit", narrower);
}

TEST_F(EarlierSessionTest, IsReadWhileANodeWorksWithIt) {
  measure(here, {});
  SessionDatabase database(path(), identity_);
  EXPECT_EQ(load().poses.size(), 1U);
  database.addSample(database_examples::sample(2, kCoils), kDate);
  EXPECT_EQ(database.samplesInUse().size(), 2U);
}

TEST_F(EarlierSessionTest, OfAnEarlierFormat) {
  measure(here, {{0, 2.0}});
  database_examples::change(path(),
                            "ALTER TABLE planned_poses DROP COLUMN validation;"
                            "ALTER TABLE cycles DROP COLUMN error_unit;"
                            "ALTER TABLE cycles DROP COLUMN registration; PRAGMA user_version = 7");
  EXPECT_EQ(load().poses.size(), 1U);
  EXPECT_EQ(database_examples::query(path(), "PRAGMA user_version"), "7");
}

TEST_F(EarlierSessionTest, WhatDoesNotSuitIsRefused) {
  { const SessionDatabase database(path(), identity_); }
  expectRefusal("it holds no samples in use", actuator());
  measure(here, {{23, 2.0}});
  Actuator other = actuator();
  other.coils.pop_back();
  expectRefusal("coil 24 of the 23", other);
  other = actuator();
  other.serial = "SA-002";
  expectRefusal("for the unit SA-001, not for SA-002", other);
  other.name = "cube";
  expectRefusal("not for cube", other);
}

TEST_F(EarlierSessionTest, WhatIsNoSessionIsRefused) {
  expectRefusal("cannot be read", actuator());
  std::ofstream(path()) << "no database";
  EXPECT_FALSE(isDatabase(path()));
  expectRefusal("damaged", actuator());
  std::filesystem::remove(path());
  ASSERT_EQ(::mkfifo((path() + "-journal").c_str(), 0600), 0);
  { std::ofstream(path()) << std::string("SQLite format 3\0", 16); }
  EXPECT_TRUE(isDatabase(path()));
  expectRefusal("FIFO", actuator());
  EXPECT_FALSE(isDatabase(path() + "-journal"));
  EXPECT_FALSE(isDatabase(folder_.path("none")));
}

TEST_F(EarlierSessionTest, WhatIsDamagedOrForeignIsRefused) {
  measure(here, {{0, 2.0}});
  database_examples::change(path(), "UPDATE samples SET joint_2 = 'here'");
  expectRefusal("where a number is wanted", actuator());
  database_examples::change(path(), "CREATE VIEW more AS SELECT * FROM samples");
  expectRefusal("more", actuator());
  database_examples::change(path(), "PRAGMA application_id = 1");
  expectRefusal("not a session database", actuator());
}

}  // namespace
}  // namespace sac
