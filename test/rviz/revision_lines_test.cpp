#include "revision_lines.hpp"

#include <limits>

#include <gtest/gtest.h>

namespace sac {
namespace {

msg::Revision revision(std::uint32_t number, bool restorable) {
  msg::Revision message;
  message.session = restorable ? "/data/unit-7/session.db" : "/data/unit-7_march/session.db";
  message.restorable = static_cast<std::uint8_t>(restorable);
  message.number = number;
  message.date = "2026-03-01T10:20:30Z";
  message.origin = "start";
  message.error_before = std::numeric_limits<double>::quiet_NaN();
  message.error_after = std::numeric_limits<double>::quiet_NaN();
  return message;
}

TEST(RevisionLines, TellErrorsInTheUnitsOfTheOtherTables) {
  msg::Revision joint = revision(1, true);
  joint.origin = "joint";
  joint.error_before = 0.05;
  joint.error_after = 0.002;
  joint.error_unit = "rad";
  joint.samples_used = 40;
  msg::Revision refined = joint;
  refined.error_unit = "1";
  const std::vector<RevisionLine> lines = revisionLines({joint, refined}, 7);
  EXPECT_EQ(lines[1].error, "50 → 2 mrad, 40 samples");
  EXPECT_EQ(lines[0].error, "0.05 → 0.002, 40 samples");
  EXPECT_EQ(lines[0].date, "2026-03-01 10:20:30");
}

TEST(RevisionLines, CountWindowsOfAMotion) {
  msg::Revision motion = revision(3, true);
  motion.origin = "motion";
  motion.error_before = 4.0;
  motion.error_after = 1.0;
  motion.error_unit = "1";
  motion.samples_used = 591;
  EXPECT_EQ(revisionLines({motion}, 3)[0].error, "4 → 1, 591 windows");
}

TEST(RevisionLines, BeginWithTheNewestAndNameOtherSessions) {
  msg::Revision old = revision(2, false);
  old.drift = "furthest";
  const std::vector<RevisionLine> lines = revisionLines({old, revision(2, true)}, 2);
  EXPECT_EQ(lines[0].name, "2, in force");
  EXPECT_TRUE(lines[0].restorable);
  EXPECT_EQ(lines[0].error, "");
  EXPECT_EQ(lines[1].name, "unit-7_march 2");
  EXPECT_FALSE(lines[1].restorable);
  EXPECT_EQ(lines[1].drift, "furthest");
}

}  // namespace
}  // namespace sac
