#include "unit_table.hpp"

#include <optional>

#include "row_access.hpp"
#include "spherical_actuator_calibration/base/error.hpp"
#include "storage_error.hpp"

namespace sac::unit_table {
namespace {

constexpr char kTextName[] = "the actuator description";

/// Text of all that the stored coordinates and uncertainties rest on.
std::string essenceOf(CalibratedDescription description) {
  description.actuator.workspace = Workspace{};
  description.calibration = std::nullopt;
  return renderDescription(description, kTextName);
}

/// What an operator calls the unit.
std::string nameOf(const std::string& name, const std::string& serial) {
  return "\"" + name + "\"" +
         (serial.empty() ? " without serial" : " with serial \"" + serial + "\"");
}

}  // namespace

void insert(const SQLite::Database& database,
            const CalibratedDescription& start,
            const EffectSelection& effects) {
  RowWriter row(database,
                "INSERT INTO unit (id, name, serial, description, effects) VALUES (1, ?, ?, ?, ?)");
  row.put(start.actuator.name).put(start.actuator.serial);
  row.put(renderDescription(start, kTextName)).put(describe(effects)).write();
}

void check(const SQLite::Database& database,
           const std::string& path,
           const CalibratedDescription& start,
           const EffectSelection& effects) {
  RowReader row(database, "SELECT name, serial, description, effects FROM unit");
  if (!row.next()) {
    throwDamaged(path, "no unit");
  }
  const std::string name = row.text();
  const std::string serial = row.text();
  if (name != start.actuator.name || serial != start.actuator.serial) {
    throw DataError(path + ": this is the session of the actuator " + nameOf(name, serial) +
                    ", but the description is of " +
                    nameOf(start.actuator.name, start.actuator.serial) +
                    "; give the description of that unit, or another directory.");
  }
  // Both texts come from this version's writer, so that a change of format is no difference.
  if (essenceOf(parseDescription(row.text(), path)) != essenceOf(start)) {
    throw DataError(path + ": this session was started with another description of " +
                    nameOf(name, serial) +
                    "; give the one it was started with, or another directory.");
  }
  const std::string started_with = row.text();
  if (started_with != describe(effects)) {
    throw DataError(path + ": this session models the laboratory effects \"" + started_with +
                    "\", but the configuration asks for \"" + describe(effects) +
                    "\"; set effects and registration (lab.launch has arguments for it) as they "
                    "were, or give another directory.");
  }
}

}  // namespace sac::unit_table
