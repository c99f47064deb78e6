#include "spherical_actuator_calibration/storage/session_database.hpp"

#include <utility>

#include "cycle_table.hpp"
#include "motion_table.hpp"
#include "plan_table.hpp"
#include "revision_table.hpp"
#include "row_access.hpp"
#include "sample_table.hpp"
#include "session_connection.hpp"
#include "spherical_actuator_calibration/calibration/calibration_session.hpp"
#include "spherical_actuator_calibration/calibration/cycle_selection.hpp"
#include "unit_table.hpp"

namespace sac {
namespace {

constexpr char kNotRead[] = "the session cannot be read";

CalibrationState startState(const SessionIdentity& identity) {
  return CalibrationSession(identity.start, {}, identity.config).startState();
}

/// Present time, ISO 8601.
std::string presentDate(const SQLite::Database& database) {
  RowReader row(database, "SELECT strftime('%Y-%m-%dT%H:%M:%SZ', 'now')");
  row.next();
  return row.text();
}

void fillNewDatabase(const SQLite::Database& database, const SessionIdentity& identity) {
  unit_table::insert(database, identity.start, identity.config.effects);
  Revision revision;
  revision.date = presentDate(database);
  revision.software = identity.software;
  revision.source = identity.start.calibration ? "identified" : "nominal";
  revision.origin = "start";
  revision.state = startState(identity);
  revision_table::insert(database, revision, {});
}

/// "The sample 3 was not stored".
std::string notStored(const std::string& what) {
  return what + " was not stored";
}

std::string nameOf(const CycleReport& report) {
  return cycleText({report.cycle, report.coil});
}

}  // namespace

/// The open database and what is written with everything.
struct SessionDatabase::Tables {
  SessionConnection connection;
  std::string software;

  const SQLite::Database& database() const { return connection.database(); }
};

SessionDatabase::SessionDatabase(const std::string& path, const SessionIdentity& identity)
    : tables_(new Tables{SessionConnection(path,
                                           [&identity](SQLite::Database& database) {
                                             fillNewDatabase(database, identity);
                                           }),
                         identity.software}) {
  tables_->connection.read(kNotRead, [&] {
    unit_table::check(tables_->database(), path, identity.start, identity.config.effects);
  });
}

SessionDatabase::~SessionDatabase() = default;

const std::string& SessionDatabase::path() const {
  return tables_->connection.path();
}

void SessionDatabase::addSample(const Sample& sample, const std::string& date) {
  tables_->connection.write(
      notStored("sample " + std::to_string(sample.id)),
      [&](SQLite::Database& database) { sample_table::insert(database, sample, date); });
}

void SessionDatabase::confirmSample(std::uint32_t id) {
  tables_->connection.write(notStored("sample " + std::to_string(id)), [](SQLite::Database&) {});
}

std::vector<Sample> SessionDatabase::samplesInUse() const {
  return tables_->connection.read(kNotRead,
                                  [this] { return sample_table::inUse(tables_->database()); });
}

bool SessionDatabase::removeSample(std::uint32_t id, const std::string& date) {
  bool removed = false;
  tables_->connection.write(
      "sample " + std::to_string(id) + " was not removed",
      [&](SQLite::Database& database) { removed = sample_table::remove(database, id, date); });
  return removed;
}

std::size_t SessionDatabase::clearSamples(const std::string& date) {
  std::size_t count = 0;
  tables_->connection.write("the samples were not cleared", [&](SQLite::Database& database) {
    count = sample_table::clear(database, date);
    plan_table::replace(database, {});
  });
  return count;
}

std::uint32_t SessionDatabase::nextSampleId() const {
  return tables_->connection.read(kNotRead,
                                  [this] { return sample_table::nextId(tables_->database()); });
}

void SessionDatabase::addMotion(const std::vector<MotionSlice>& windows, const std::string& date) {
  tables_->connection.write(notStored("the motion"), [&](SQLite::Database& database) {
    for (const MotionSlice& window : windows) {
      motion_table::insert(database, window, date);
    }
  });
}

std::vector<MotionSlice> SessionDatabase::motion() const {
  return tables_->connection.read(kNotRead,
                                  [this] { return motion_table::all(tables_->database()); });
}

void SessionDatabase::forgetMotion() {
  tables_->connection.write("the motion was not forgotten", motion_table::clear);
}

void SessionDatabase::setPlan(const PosesToMeasure& plan) {
  tables_->connection.write(notStored("the plan"), [&](SQLite::Database& database) {
    plan_table::replace(database, plan);
  });
}

PosesToMeasure SessionDatabase::plan() const {
  return tables_->connection.read(kNotRead,
                                  [this] { return plan_table::find(tables_->database()); });
}

void SessionDatabase::addCycle(const CycleReport& report, const std::string& date) {
  tables_->connection.write(
      notStored("the report of cycle " + nameOf(report)), [&](SQLite::Database& database) {
        const std::uint32_t in_force = revision_table::newestNumber(database);
        cycle_table::insert(database, report, in_force, tables_->software, date);
      });
}

Revision SessionDatabase::addCycle(const CycleReport& report,
                                   const CalibrationState& after,
                                   bool refined,
                                   const std::string& date) {
  Revision revision;
  revision.date = date;
  revision.software = tables_->software;
  revision.source = "identified";
  revision.origin = nameOf(report);
  revision.refined = refined;
  revision.state = after;
  tables_->connection.write(
      notStored("the result of cycle " + nameOf(report)), [&](SQLite::Database& database) {
        const std::uint32_t before = revision_table::newestNumber(database);
        revision.number = before + 1;
        const std::int64_t cycle =
            cycle_table::insert(database, report, before, tables_->software, date);
        revision_table::insert(database, revision, {before, cycle});
        if (refined) {
          plan_table::replace(database, {});
        }
      });
  return revision;
}

std::optional<CycleReport> SessionDatabase::lastCycle() const {
  return tables_->connection.read(kNotRead,
                                  [this] { return cycle_table::last(tables_->database()); });
}

std::vector<CycleReport> SessionDatabase::cyclesOfRevision(std::uint32_t number) const {
  return tables_->connection.read(kNotRead, [&] {
    std::vector<CycleReport> reports;
    const std::vector<std::int64_t> cycles = revision_table::cyclesOf(tables_->database(), number);
    reports.reserve(cycles.size());
    for (const std::int64_t id : cycles) {
      reports.push_back(cycle_table::find(tables_->database(), id));
    }
    return reports;
  });
}

std::optional<std::uint32_t> SessionDatabase::motionBefore(std::uint32_t number) const {
  return tables_->connection.read(
      kNotRead, [&] { return revision_table::lastOfMotion(tables_->database(), number); });
}

Revision SessionDatabase::addRevision(const CalibrationState& state,
                                      const std::string& source,
                                      const std::string& origin,
                                      bool refined,
                                      const std::string& date,
                                      std::optional<std::uint32_t> same_as) {
  Revision revision;
  revision.date = date;
  revision.software = tables_->software;
  revision.source = source;
  revision.origin = origin;
  revision.refined = refined;
  revision.state = state;
  tables_->connection.write(notStored("the revision of the parameters"),
                            [&](SQLite::Database& database) {
                              revision.number = revision_table::newestNumber(database) + 1;
                              revision_table::insert(database, revision, {same_as, std::nullopt});
                            });
  return revision;
}

Revision SessionDatabase::current() const {
  return tables_->connection.read(kNotRead, [this] {
    const SQLite::Database& database = tables_->database();
    const auto newest = revision_table::find(database, revision_table::newestNumber(database));
    if (!newest) {
      throw RowDefect("the newest parameters have no number");
    }
    return *newest;
  });
}

std::optional<Revision> SessionDatabase::revision(std::uint32_t number) const {
  return tables_->connection.read(
      kNotRead, [&] { return revision_table::find(tables_->database(), number); });
}

std::vector<RevisionSummary> SessionDatabase::revisions() const {
  return tables_->connection.read(kNotRead,
                                  [this] { return revision_table::all(tables_->database()); });
}

}  // namespace sac
