#include "session_schema.hpp"

#include <cstdint>

#include "cycle_table.hpp"
#include "row_access.hpp"
#include "spherical_actuator_calibration/base/error.hpp"
#include "storage_error.hpp"
#include "table_text.hpp"

namespace sac {
namespace {

/// "SACS" in ASCII: marks the file as ours.
constexpr std::int64_t kApplicationId = 0x53414353;
constexpr std::int64_t kSchemaVersion = 10;

// Numbers are in columns of type ANY: one of type REAL would turn −0 into 0.
// Which cycles there are is said by cycleName() alone.
constexpr char kCycles[] = R"sql(
CREATE TABLE cycles (
  id INTEGER PRIMARY KEY,
  date TEXT NOT NULL,
  software TEXT NOT NULL,
  cycle TEXT NOT NULL,
  coil INTEGER NOT NULL,
  success INTEGER NOT NULL,
  message TEXT NOT NULL,
  samples_used INTEGER NOT NULL,
  samples_rejected INTEGER NOT NULL,
  iterations INTEGER NOT NULL,
  error_measure TEXT NOT NULL CHECK (error_measure IN ('orientation', 'torque', 'standardized')),
  reduced_chi_square ANY,
  condition_number ANY,
  solve_time ANY,
  orientation_uncertainty ANY,
  torque_uncertainty ANY,
  contradicted INTEGER NOT NULL DEFAULT 0,
  degrees_of_freedom INTEGER NOT NULL DEFAULT 0,
  in_force INTEGER,
  registration TEXT NOT NULL DEFAULT '',
  error_unit TEXT NOT NULL DEFAULT ''
) STRICT;
)sql";

constexpr char kDoubts[] = R"sql(
CREATE TABLE cycle_doubts (
  cycle INTEGER NOT NULL REFERENCES cycles (id),
  position INTEGER NOT NULL,
  sentence TEXT NOT NULL,
  PRIMARY KEY (cycle, position)
) STRICT, WITHOUT ROWID;
)sql";

constexpr char kMotionWindows[] = R"sql(
CREATE TABLE motion_windows (
  id INTEGER PRIMARY KEY,
  date TEXT NOT NULL,
  first INTEGER NOT NULL,
  last INTEGER NOT NULL,
  coils INTEGER NOT NULL,
  joints BLOB NOT NULL,
  currents BLOB NOT NULL,
  orientations BLOB NOT NULL
) STRICT;
)sql";

constexpr char kMotionSummaries[] = R"sql(
CREATE TABLE cycle_motions (
  cycle INTEGER PRIMARY KEY REFERENCES cycles (id),
  duration ANY,
  windows INTEGER NOT NULL,
  used INTEGER NOT NULL,
  window_values INTEGER NOT NULL,
  orientations INTEGER NOT NULL,
  orientations_rejected INTEGER NOT NULL,
  joint_1_stddev ANY, joint_2_stddev ANY, joint_3_stddev ANY,
  current_stddev ANY,
  orientation_stddev ANY,
  response_delay ANY, response_lag ANY, response_delay_stddev ANY,
  held_out_windows INTEGER NOT NULL,
  held_out_rejected INTEGER NOT NULL,
  held_out_orientations INTEGER NOT NULL,
  held_out_orientation_rms ANY,
  held_out_torque_rms ANY,
  held_out_reduced_chi_square ANY,
  held_out_probability ANY,
  window_chi_square ANY,
  orientation_chi_square ANY
) STRICT;

CREATE TABLE cycle_windows_left_out (
  cycle INTEGER NOT NULL REFERENCES cycles (id),
  position INTEGER NOT NULL,
  reason TEXT NOT NULL,
  windows INTEGER NOT NULL,
  PRIMARY KEY (cycle, position)
) STRICT, WITHOUT ROWID;

CREATE TABLE cycle_window_residuals (
  cycle INTEGER NOT NULL REFERENCES cycles (id),
  position INTEGER NOT NULL,
  window INTEGER NOT NULL,
  quantity TEXT NOT NULL,
  residual ANY,
  standardized ANY,
  rejected INTEGER NOT NULL,
  reason TEXT NOT NULL,
  PRIMARY KEY (cycle, position)
) STRICT, WITHOUT ROWID;

CREATE TABLE cycle_windows_held_out (
  cycle INTEGER NOT NULL REFERENCES cycles (id),
  position INTEGER NOT NULL,
  window INTEGER NOT NULL,
  error_x ANY, error_y ANY, error_z ANY,
  standardized ANY,
  rejected INTEGER NOT NULL,
  PRIMARY KEY (cycle, position)
) STRICT, WITHOUT ROWID;
)sql";

constexpr char kPlan[] = R"sql(
CREATE TABLE planned_poses (
  position INTEGER PRIMARY KEY,
  joint_1 ANY NOT NULL, joint_2 ANY NOT NULL, joint_3 ANY NOT NULL,
  validation INTEGER NOT NULL DEFAULT 0
) STRICT;

CREATE TABLE planned_patterns (
  pose INTEGER NOT NULL REFERENCES planned_poses (position),
  position INTEGER NOT NULL,
  coils TEXT NOT NULL,
  PRIMARY KEY (pose, position)
) STRICT, WITHOUT ROWID;
)sql";

constexpr char kTables[] = R"sql(
CREATE TABLE unit (
  id INTEGER PRIMARY KEY CHECK (id = 1),
  name TEXT NOT NULL,
  serial TEXT NOT NULL,
  description TEXT NOT NULL,
  effects TEXT NOT NULL
) STRICT;

CREATE TABLE samples (
  id INTEGER PRIMARY KEY,
  date TEXT NOT NULL,
  removal TEXT CHECK (removal IN ('removed', 'cleared')),
  removal_date TEXT CHECK ((removal IS NULL) = (removal_date IS NULL)),
  stamp INTEGER NOT NULL,
  validation INTEGER NOT NULL,
  joint_1 ANY NOT NULL, joint_2 ANY NOT NULL, joint_3 ANY NOT NULL,
  joint_1_stddev ANY NOT NULL, joint_2_stddev ANY NOT NULL, joint_3_stddev ANY NOT NULL,
  has_orientation INTEGER NOT NULL,
  r11 ANY, r12 ANY, r13 ANY, r21 ANY, r22 ANY, r23 ANY, r31 ANY, r32 ANY, r33 ANY,
  has_torque INTEGER NOT NULL,
  torque_x ANY, torque_y ANY, torque_z ANY,
  duration ANY NOT NULL,
  measurements INTEGER NOT NULL,
  orientation_stddev ANY,
  torque_stddev ANY,
  dwell INTEGER NOT NULL DEFAULT 0,
  joint_1_shared_stddev ANY NOT NULL DEFAULT 0.0,
  joint_2_shared_stddev ANY NOT NULL DEFAULT 0.0,
  joint_3_shared_stddev ANY NOT NULL DEFAULT 0.0,
  torque_shared_stddev ANY DEFAULT 0.0
) STRICT;

CREATE TABLE sample_currents (
  sample INTEGER NOT NULL REFERENCES samples (id),
  coil INTEGER NOT NULL,
  current ANY NOT NULL,
  PRIMARY KEY (sample, coil)
) STRICT, WITHOUT ROWID;

CREATE TABLE cycle_errors (
  cycle INTEGER NOT NULL REFERENCES cycles (id),
  iteration INTEGER NOT NULL,
  error ANY,
  PRIMARY KEY (cycle, iteration)
) STRICT, WITHOUT ROWID;

CREATE TABLE cycle_estimates (
  cycle INTEGER NOT NULL REFERENCES cycles (id),
  position INTEGER NOT NULL,
  name TEXT NOT NULL,
  nominal ANY,
  initial ANY,
  value ANY,
  stddev ANY,
  observable INTEGER NOT NULL,
  unit TEXT NOT NULL DEFAULT '',
  PRIMARY KEY (cycle, position)
) STRICT, WITHOUT ROWID;

CREATE TABLE cycle_residuals (
  cycle INTEGER NOT NULL REFERENCES cycles (id),
  position INTEGER NOT NULL,
  sample INTEGER NOT NULL REFERENCES samples (id),
  quantity TEXT NOT NULL CHECK (quantity IN ('orientation', 'torque')),
  residual ANY,
  standardized ANY,
  rejected INTEGER NOT NULL,
  reason TEXT NOT NULL,
  PRIMARY KEY (cycle, position)
) STRICT, WITHOUT ROWID;

CREATE TABLE revisions (
  number INTEGER PRIMARY KEY CHECK (number >= 0),
  date TEXT NOT NULL,
  software TEXT NOT NULL,
  source TEXT NOT NULL CHECK (source IN ('nominal', 'identified', 'restored')),
  origin TEXT NOT NULL,
  refined INTEGER NOT NULL,
  predecessor INTEGER REFERENCES revisions (number) CHECK (predecessor < number),
  cycle INTEGER UNIQUE REFERENCES cycles (id),
  coordinates BLOB NOT NULL,
  covariance BLOB NOT NULL,
  identified BLOB NOT NULL,
  covariance_of INTEGER REFERENCES revisions (number)
) STRICT;
)sql";

std::int64_t pragma(const SQLite::Database& database, const char* sql) {
  RowReader row(database, sql);
  return row.next() ? row.integer() : 0;
}

/// Of every format that is known.
TableTexts ownTexts() {
  SQLite::Database own(":memory:", SQLite::OPEN_READWRITE | SQLite::OPEN_CREATE);
  createSessionSchema(own);
  TableTexts texts = tableTexts(own);
  // Formats before 4.
  texts["cycles"].insert(
      "cycle TEXT NOT NULL CHECK (cycle IN ('joint', 'poles', 'coil', 'refine'))");
  return texts;
}

}  // namespace

bool hasSessionSchema(const SQLite::Database& database, const std::string& path) {
  const std::int64_t application = pragma(database, "PRAGMA application_id");
  const std::int64_t version = pragma(database, "PRAGMA user_version");
  const bool is_empty = pragma(database, "SELECT count(*) FROM sqlite_schema") == 0;
  if (application == 0 && version == 0 && is_empty) {
    return false;
  }
  if (application != kApplicationId) {
    throw DataError(path +
                    ": this is not a session database; choose another one, or another directory.");
  }
  if (version > kSchemaVersion) {
    throw DataError(path + ": a newer version of this package made this session database (format " +
                    std::to_string(version) + ", this version knows " +
                    std::to_string(kSchemaVersion) + "); update the package.");
  }
  // Before any table is read: a view can be without end, a trigger take back what is inserted.
  const std::string foreign = foreignObject(database, ownTexts());
  if (!foreign.empty()) {
    throw DataError(path + ": the session database holds " + foreign +
                    " as this package does not make it; put a copy of the file back, or move it "
                    "away to start anew.");
  }
  RowReader check(database, "PRAGMA quick_check(1)");
  const std::string finding = check.next() ? check.text() : "no answer";
  if (finding != "ok") {
    throwDamaged(path, finding);
  }
  return true;
}

bool isEarlierSchema(const SQLite::Database& database) {
  return pragma(database, "PRAGMA user_version") < kSchemaVersion;
}

void upgradeSessionSchema(SQLite::Database& database) {
  const std::int64_t version = pragma(database, "PRAGMA user_version");
  if (version < 2) {
    database.exec(
        "ALTER TABLE revisions ADD COLUMN covariance_of INTEGER REFERENCES revisions (number)");
  }
  if (version < 3) {
    database.exec(
        "ALTER TABLE samples ADD COLUMN dwell INTEGER NOT NULL DEFAULT 0;"
        "ALTER TABLE samples ADD COLUMN joint_1_shared_stddev ANY NOT NULL DEFAULT 0.0;"
        "ALTER TABLE samples ADD COLUMN joint_2_shared_stddev ANY NOT NULL DEFAULT 0.0;"
        "ALTER TABLE samples ADD COLUMN joint_3_shared_stddev ANY NOT NULL DEFAULT 0.0;"
        "ALTER TABLE samples ADD COLUMN torque_shared_stddev ANY DEFAULT 0.0");
  }
  if (version < 4) {
    // The table of cycles named those that it took; a constraint goes with its table only.
    database.exec("CREATE TABLE earlier_cycles AS SELECT * FROM cycles; DROP TABLE cycles");
    database.exec(kCycles);
    database.exec(
        "INSERT INTO cycles SELECT *, 0, 0, NULL, '', '' FROM earlier_cycles; DROP TABLE "
        "earlier_cycles;"
        "ALTER TABLE cycle_estimates ADD COLUMN unit TEXT NOT NULL DEFAULT ''");
  } else if (version < 6) {
    database.exec(
        "ALTER TABLE cycles ADD COLUMN contradicted INTEGER NOT NULL DEFAULT 0;"
        "ALTER TABLE cycles ADD COLUMN degrees_of_freedom INTEGER NOT NULL DEFAULT 0;"
        "ALTER TABLE cycles ADD COLUMN in_force INTEGER");
  }
  if (version >= 4 && version < 9) {
    database.exec("ALTER TABLE cycles ADD COLUMN registration TEXT NOT NULL DEFAULT ''");
  }
  if (version >= 4 && version < 10) {
    database.exec("ALTER TABLE cycles ADD COLUMN error_unit TEXT NOT NULL DEFAULT ''");
  }
  if (version < 10) {
    cycle_table::addErrorUnits(database);
  }
  if (version < 5) {
    database.exec(kMotionWindows);
  }
  if (version < 6) {
    database.exec(kDoubts);
  }
  if (version < 7) {
    database.exec(kMotionSummaries);
    database.exec(kPlan);
  } else if (version < 8) {
    database.exec("ALTER TABLE planned_poses ADD COLUMN validation INTEGER NOT NULL DEFAULT 0");
  }
  database.exec("PRAGMA user_version = " + std::to_string(kSchemaVersion));
}

void createSessionSchema(SQLite::Database& database) {
  database.exec(kCycles);
  database.exec(kTables);
  database.exec(kMotionWindows);
  database.exec(kDoubts);
  database.exec(kMotionSummaries);
  database.exec(kPlan);
  database.exec("PRAGMA application_id = " + std::to_string(kApplicationId));
  database.exec("PRAGMA user_version = " + std::to_string(kSchemaVersion));
}

}  // namespace sac
