#include "plan_table.hpp"

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <sstream>
#include <string>

#include "row_access.hpp"
#include "spherical_actuator_calibration/base/numbering.hpp"

namespace sac::plan_table {
namespace {

/// Of patternText().
CoilPattern patternOf(const std::string& text) {
  CoilPattern pattern;
  std::istringstream words(text);
  std::int32_t number = 0;
  while (words >> number) {
    const std::int64_t coil = std::abs(std::int64_t{number});
    pattern.push_back({indexOf(static_cast<std::size_t>(coil)).value_or(0), number < 0 ? -1 : 1});
  }
  if (pattern.empty() || patternText(pattern) != text) {
    throw RowDefect("\"" + text + "\" stands where a planned pattern of coils is wanted");
  }
  return pattern;
}

}  // namespace

void replace(const SQLite::Database& database, const PosesToMeasure& plan) {
  RowWriter(database, "DELETE FROM planned_patterns").write();
  RowWriter(database, "DELETE FROM planned_poses").write();
  RowWriter pose(database,
                 "INSERT INTO planned_poses (position, joint_1, joint_2, joint_3, validation) "
                 "VALUES (?, ?, ?, ?, ?)");
  RowWriter pattern(database,
                    "INSERT INTO planned_patterns (pose, position, coils) VALUES (?, ?, ?)");
  for (std::size_t n = 0; n < plan.size(); ++n) {
    pose.put(n);
    for (const double angle : plan[n].joint_position) {
      pose.put(angle);
    }
    pose.put(plan[n].validation).write();
    for (std::size_t k = 0; k < plan[n].patterns.size(); ++k) {
      pattern.put(n).put(k).put(patternText(plan[n].patterns[k])).write();
    }
  }
}

PosesToMeasure find(const SQLite::Database& database) {
  PosesToMeasure plan;
  RowReader pose(database,
                 "SELECT position, joint_1, joint_2, joint_3, validation FROM planned_poses "
                 "ORDER BY position");
  while (pose.next()) {
    const std::int64_t position = pose.integer();
    PoseToMeasure& one = plan.emplace_back();
    for (double& angle : one.joint_position) {
      angle = pose.number();
    }
    one.validation = pose.flag();
    RowReader pattern(
        database, "SELECT coils FROM planned_patterns WHERE pose = ? ORDER BY position", position);
    while (pattern.next()) {
      one.patterns.push_back(patternOf(pattern.text()));
    }
  }
  return plan;
}

}  // namespace sac::plan_table
