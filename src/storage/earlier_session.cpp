#include "spherical_actuator_calibration/storage/earlier_session.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <fstream>
#include <string_view>
#include <vector>

#include <SQLiteCpp/Backup.h>
#include <SQLiteCpp/Database.h>
#include <SQLiteCpp/Exception.h>

#include "busy_timeout.hpp"
#include "files_beside.hpp"
#include "row_access.hpp"
#include "sample_table.hpp"
#include "session_schema.hpp"
#include "spherical_actuator_calibration/actuator/unit_identity.hpp"
#include "spherical_actuator_calibration/base/error.hpp"
#include "spherical_actuator_calibration/base/input_file.hpp"
#include "spherical_actuator_calibration/base/median.hpp"
#include "spherical_actuator_calibration/base/numbering.hpp"
#include "spherical_actuator_calibration/planning/sample_at_pose.hpp"
#include "spherical_actuator_calibration/planning/sample_places.hpp"
#include "storage_error.hpp"

#include <sqlite3.h>

namespace sac {
namespace {

constexpr char kEarlierNotRead[] = "the earlier session cannot be read";

/// No session has more; comparing each sample with each pose would take minutes.
constexpr std::size_t kMostPoses = 10'000;

/// One state of the file, in memory: who works with it waits for no more than this.
void copy(const std::string& path, SQLite::Database& memory) {
  try {
    SQLite::Database file(path, SQLite::OPEN_READONLY, kBusyTimeoutMilliseconds);
    requireFilesBeside(path, sqlite3_db_filename(file.getHandle(), "main"), kEarlierNotRead);
    SQLite::Backup(memory, file).executeStep();
  } catch (const SQLite::Exception& error) {
    if (error.getExtendedErrorCode() == SQLITE_READONLY_ROLLBACK) {
      throw DataError(path +
                      ": its node was ended while it stored something; start it once, which puts "
                      "the file in order.");
    }
    throwStorageError(path, kEarlierNotRead, error);
  }
}

/// Throws DataError unless it is one, and brings it to the present format.
void requireSession(SQLite::Database& database, const std::string& path) {
  try {
    if (!hasSessionSchema(database, path)) {
      throwDamaged(path, "it holds nothing");
    }
    upgradeSessionSchema(database);
  } catch (const SQLite::Exception& error) {
    throwStorageError(path, kEarlierNotRead, error);
  }
}

void requireUnit(const SQLite::Database& database, const Actuator& actuator) {
  RowReader row(database, "SELECT name, serial FROM unit");
  if (!row.next()) {
    throw RowDefect("no unit");
  }
  const std::string name = row.text();
  const std::string serial = row.text();
  if (const auto other = otherUnit(actuator, name, serial)) {
    throw DataError("it is for the " + other->kind + " " + other->its + ", not for " + other->own +
                    ".");
  }
}

/// Where the sample was, within the workspace.
Eigen::Vector3d placeOf(const Sample& sample, const Actuator& actuator) {
  Eigen::Vector3d place = sample.joint_position;
  if (!place.allFinite()) {
    throw RowDefect("Sample " + std::to_string(sample.id) + " has no joint angles");
  }
  if (!actuator.workspace.contains(place, kPoseTolerance)) {
    throw DataError("sample " + std::to_string(sample.id) +
                    " lies beyond the tilt_limit of the workspace that the description has now.");
  }
  const double limit = actuator.workspace.tilt_limit;
  place.head<2>() = place.head<2>().cwiseMax(-limit).cwiseMin(limit);
  return place;
}

CoilPattern checkedPattern(const Sample& sample, const Actuator& actuator, double threshold) {
  CoilPattern pattern = patternOf(sample, threshold);
  if (!pattern.empty() && pattern.back().coil >= actuator.coils.size()) {
    throw DataError("sample " + std::to_string(sample.id) + " has current in coil " +
                    std::to_string(numberOf(pattern.back().coil)) + " of the " +
                    std::to_string(actuator.coils.size()) + " that there are.");
  }
  return pattern;
}

PoseToMeasure& poseOf(const Sample& sample,
                      const Actuator& actuator,
                      SamplePlaces& places,
                      PosesToMeasure& poses) {
  const std::size_t place = places.placeOf(sample);
  if (place < poses.size()) {
    return poses[place];
  }
  if (poses.size() == kMostPoses) {
    throw DataError("it has more than " + std::to_string(kMostPoses) + " poses.");
  }
  poses.push_back({placeOf(sample, actuator), {}, sample.validation});
  return poses.back();
}

EarlierSession sessionOf(const std::vector<Sample>& samples,
                         const Actuator& actuator,
                         double threshold) {
  EarlierSession session;
  std::vector<double> currents;
  SamplePlaces places;
  for (const Sample& sample : samples) {
    const CoilPattern pattern = checkedPattern(sample, actuator, threshold);
    for (const SignedCoil& coil : pattern) {
      currents.push_back(std::abs(sample.current[static_cast<Eigen::Index>(coil.coil)]));
    }
    std::vector<CoilPattern>& patterns = poseOf(sample, actuator, places, session.poses).patterns;
    if (!pattern.empty() &&
        std::find(patterns.begin(), patterns.end(), pattern) == patterns.end()) {
      patterns.push_back(pattern);
    }
  }
  if (session.poses.empty()) {
    throw DataError("it holds no samples in use.");
  }
  if (!currents.empty()) {
    constexpr double kStepsPerAmpere = 100.0;
    session.current = std::round(kStepsPerAmpere * medianOf(currents)) / kStepsPerAmpere;
  }
  return session;
}

}  // namespace

bool isDatabase(const std::string& path) {
  constexpr std::string_view kMagic("SQLite format 3\0", 16);
  if (!unreadableKind(path).empty()) {
    return false;
  }
  std::array<char, kMagic.size()> beginning{};
  std::ifstream file(path, std::ios::binary);
  file.read(beginning.data(), beginning.size());
  return file && std::string_view(beginning.data(), beginning.size()) == kMagic;
}

EarlierSession loadEarlierSession(const std::string& path,
                                  const Actuator& actuator,
                                  double current_threshold) {
  SQLite::Database memory(":memory:", SQLite::OPEN_READWRITE | SQLite::OPEN_CREATE);
  copy(path, memory);
  requireSession(memory, path);
  try {
    requireUnit(memory, actuator);
    return sessionOf(sample_table::inUse(memory), actuator, current_threshold);
  } catch (const SQLite::Exception& error) {
    throwStorageError(path, kEarlierNotRead, error);
  } catch (const RowDefect& defect) {
    throwDamaged(path, defect.what());
  } catch (const DataError& error) {
    throw DataError(path + ": " + error.what());
  }
}

}  // namespace sac
