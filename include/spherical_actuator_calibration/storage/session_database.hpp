#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "spherical_actuator_calibration/actuator/description_file.hpp"
#include "spherical_actuator_calibration/calibration/calibration_config.hpp"
#include "spherical_actuator_calibration/calibration/calibration_report.hpp"
#include "spherical_actuator_calibration/estimation/calibration_state.hpp"
#include "spherical_actuator_calibration/measurement/sample.hpp"
#include "spherical_actuator_calibration/motion/motion_slice.hpp"
#include "spherical_actuator_calibration/storage/revision.hpp"

namespace sac {

struct PoseToMeasure;

/// What the database of one unit belongs to.
struct SessionIdentity {
  CalibratedDescription start;  ///< as loaded at the start, nominal or calibrated
  CalibrationConfig config;     ///< its part in the parameters at the start makes revision 0
  std::string software;         ///< version that writes
};

/// Everything that a session must not lose, in one SQLite file (doc/session_database.md): every
/// sample, the report of every cycle, every revision of the parameters, and the newest windows of
/// a motion.
///
/// What a function has written when it returns survives the end of the process and of power. When a
/// function throws, nothing of it is stored, and the next call may succeed: a full disk, say, needs
/// only space. Every function throws DataError, a sentence that names the file. Dates are ISO 8601
/// with time. Not thread-safe.
class SessionDatabase {
 public:
  /// Opens the database at `path`, or makes it with revision 0. Throws ConfigError when the
  /// description is not valid, and DataError when another process has the database open, the file
  /// cannot be opened, is damaged or of a newer version, or belongs to another unit or another
  /// description than `identity`. The workspace may have changed: no stored number depends on it.
  SessionDatabase(const std::string& path, const SessionIdentity& identity);
  ~SessionDatabase();
  SessionDatabase(const SessionDatabase&) = delete;
  SessionDatabase& operator=(const SessionDatabase&) = delete;

  const std::string& path() const;

  /// Stores a sample. Its id must be new.
  void addSample(const Sample& sample, const std::string& date);
  /// Throws DataError unless the file holds what was stored, among it the sample with this id.
  void confirmSample(std::uint32_t id);
  /// Samples that are neither removed nor cleared, in the order of their ids.
  std::vector<Sample> samplesInUse() const;
  /// Marks a sample as removed; false when none in use has this id.
  bool removeSample(std::uint32_t id, const std::string& date);
  /// Marks all samples in use as cleared, and forgets the plan; returns how many there were.
  std::size_t clearSamples(const std::string& date);
  /// Larger than any id ever stored; 1 at first.
  std::uint32_t nextSampleId() const;

  /// Stores windows of a motion. The oldest ones make room for them: some 20 MB are kept.
  void addMotion(const std::vector<MotionSlice>& windows, const std::string& date);
  /// That are kept, oldest first.
  std::vector<MotionSlice> motion() const;
  void forgetMotion();

  /// Stores which poses are to be measured, in the place of an earlier plan.
  void setPlan(const std::vector<PoseToMeasure>& plan);
  /// Empty: none, or all samples were refined together or cleared since.
  std::vector<PoseToMeasure> plan() const;

  /// Stores the report of a cycle that changed nothing. Its residuals name stored samples.
  void addCycle(const CycleReport& report, const std::string& date);
  /// Stores the report of a cycle together with the parameters that it put in force.
  Revision addCycle(const CycleReport& report,
                    const CalibrationState& after,
                    bool refined,
                    const std::string& date);
  /// Report of the last cycle ever stored.
  std::optional<CycleReport> lastCycle() const;
  /// Reports of the cycles that led to a revision, in their order: from the parameters at the
  /// start, or from a reset. Among them those that failed meanwhile, and since it came into force;
  /// a revision that is restored leaves behind what failed after it.
  std::vector<CycleReport> cyclesOfRevision(std::uint32_t number) const;
  /// Number of the last revision that the cycle `motion` made, of those that led to a revision.
  std::optional<std::uint32_t> motionBefore(std::uint32_t number) const;

  /// Stores parameters that no cycle made: a reset, or with `same_as` the earlier revision that
  /// they are taken from, whose cycles then led to them, too.
  Revision addRevision(const CalibrationState& state,
                       const std::string& source,
                       const std::string& origin,
                       bool refined,
                       const std::string& date,
                       std::optional<std::uint32_t> same_as = std::nullopt);
  /// The newest revision: the parameters in force.
  Revision current() const;
  std::optional<Revision> revision(std::uint32_t number) const;
  /// All revisions, oldest first.
  std::vector<RevisionSummary> revisions() const;

 private:
  struct Tables;
  std::unique_ptr<Tables> tables_;
};

}  // namespace sac
