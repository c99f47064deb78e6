#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "spherical_actuator_calibration/assessment/calibration_grade.hpp"
#include "spherical_actuator_calibration/assessment/torque_linearity.hpp"
#include "spherical_actuator_calibration/calibration/calibration_config.hpp"
#include "spherical_actuator_calibration/calibration/calibration_session.hpp"
#include "spherical_actuator_calibration/calibration/session_progress.hpp"
#include "spherical_actuator_calibration/storage/session_database.hpp"

namespace sac {

struct PoseToMeasure;

/// The calibration of one unit as it grows: samples, cycles and revisions of the parameters. What a
/// function acknowledges by returning is in the session database; when it throws, nothing has
/// changed. Dates are ISO 8601 with time, given by the caller. Not thread-safe.
class LiveSession {
 public:
  /// Opens the database of the unit, or makes it, and goes on where it ended: samples in use,
  /// parameters in force. Throws ConfigError and DataError as CalibrationSession and
  /// SessionDatabase.
  LiveSession(const CalibratedDescription& start,
              const CalibrationConfig& config,
              const std::string& database_path,
              const std::string& software);

  // Its counter refers to its model.
  LiveSession(const LiveSession&) = delete;
  LiveSession& operator=(const LiveSession&) = delete;

  const CalibrationSession& calibration() const { return session_; }
  const SessionDatabase& database() const { return database_; }
  /// The parameters in force.
  const Revision& revision() const { return revision_; }
  /// Actuator with the parameters in force.
  Actuator actuator() const;

  /// Stores a sample under a new id and takes it. Returns it as stored; one that is in use already,
  /// with the same stamp and values, is not stored again. Throws DataError when it cannot be used
  /// or stored.
  Sample addSample(const Sample& sample, const std::string& date);
  /// Takes a sample out of use; it stays in the database, marked. False when no sample in use has
  /// this id.
  bool removeSample(std::uint32_t id, const std::string& date);
  /// The same for all samples; returns how many there were.
  std::size_t clearSamples(const std::string& date);

  /// Stores windows of a motion; the newest ones are kept (SessionDatabase::addMotion()). Throws
  /// DataError.
  void addMotion(const std::vector<MotionSlice>& windows, const std::string& date) {
    database_.addMotion(windows, date);
  }
  /// Windows that are kept, oldest first. Throws DataError.
  std::vector<MotionSlice> motionWindows() const;
  void forgetMotion() { database_.forgetMotion(); }

  /// Remembers which poses are to be measured, until all samples are refined together or cleared.
  void setPlan(const std::vector<PoseToMeasure>& plan) { database_.setPlan(plan); }
  /// Throws DataError.
  std::vector<PoseToMeasure> plan() const;

  /// What the cycle motion is run on; null: nothing. It is not stored.
  void setMotion(std::shared_ptr<const MotionRecording> motion) {
    session_.setMotion(std::move(motion));
  }

  /// Runs a cycle and stores its report. When it succeeded its parameters are a new revision, in
  /// force.
  CycleReport run(const CycleRequest& request, const std::string& date);
  /// Report of the last cycle ever run.
  std::optional<CycleReport> lastReport() const;

  /// Puts the parameters of the description at the start in force, as a new revision.
  void reset(const std::string& date);
  /// Puts the parameters of an earlier revision in force, as a new revision. Throws DataError when
  /// there is none of this number.
  void restore(std::uint32_t number, const std::string& date);

  /// Without `saved`, `contradicted` and `plan_step`, which only its user knows.
  SessionProgress progress() const;
  /// Of the parameters in force, by the samples held out.
  const GradedCalibration& grade() const;
  /// Of the samples in use.
  const std::optional<TorqueLinearity>& linearity() const { return linearity_; }

  /// The calibrated description, with its record; what contradicts it is told there, too.
  CalibratedDescription description(const std::string& date) const;
  /// Where a description or report of the parameters in force comes from.
  CalibrationOrigin origin(const std::string& date) const;

 private:
  std::optional<MotionEvidence> motionBefore(std::uint32_t number) const;
  void countAnew();
  void searchLinearityAnew();
  void putInForce(const Revision& revision);

  std::string software_;
  SessionDatabase database_;
  Revision revision_;
  CalibrationSession session_;
  // Kept up to date, as they are asked for at every capture.
  std::optional<ProgressCounter> counter_;
  bool is_settled_ = false;
  std::size_t removed_ = 0;                          ///< samples that the parameters rest on
  mutable std::optional<CalibrationGrader> grader_;  ///< nothing: not asked for yet
  mutable std::optional<GradedCalibration> grade_;   ///< nothing: not asked for since it changed
  LinearitySearch linearity_search_;
  std::optional<TorqueLinearity> linearity_;
};

}  // namespace sac
