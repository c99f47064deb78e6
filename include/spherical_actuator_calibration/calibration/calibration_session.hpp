#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "spherical_actuator_calibration/actuator/description_file.hpp"
#include "spherical_actuator_calibration/calibration/calibration_config.hpp"
#include "spherical_actuator_calibration/calibration/calibration_cycles.hpp"
#include "spherical_actuator_calibration/calibration/calibration_report.hpp"
#include "spherical_actuator_calibration/calibration/held_out_judge.hpp"
#include "spherical_actuator_calibration/calibration/held_out_validation.hpp"
#include "spherical_actuator_calibration/calibration/motion_evidence.hpp"
#include "spherical_actuator_calibration/calibration/orientation_map_choice.hpp"
#include "spherical_actuator_calibration/estimation/calibration_model.hpp"
#include "spherical_actuator_calibration/estimation/calibration_state.hpp"
#include "spherical_actuator_calibration/estimation/workspace_uncertainty.hpp"
#include "spherical_actuator_calibration/measurement/sample.hpp"
#include "spherical_actuator_calibration/motion/motion_recording.hpp"

namespace sac {

/// Where a calibration comes from; the core can know none of it.
struct CalibrationOrigin {
  std::string date;  ///< ISO 8601, with time
  std::vector<RecordingSource> recordings;
  std::string software;  ///< version of this package
  /// Of the result; without it one more than that of the description at the start.
  std::optional<std::uint32_t> revision = std::nullopt;
};

/// The calibration of one actuator from its samples: runs cycles one after the other, each from the
/// result of those before it. Samples may come and go between cycles.
class CalibrationSession {
 public:
  /// Starts from a description. What a calibrated description states with a standard deviation
  /// counts as identified by it; all else is uncertain by the manufacturing tolerance. Throws
  /// ConfigError when description or configuration, DataError when a sample is not valid.
  CalibrationSession(CalibratedDescription start,
                     std::vector<Sample> samples,
                     CalibrationConfig config);

  /// Takes up a session again: samples (with what is held out as it was) and parameters in force,
  /// with the reports of the cycles that led to them. Throws as above, and DataError when the state
  /// does not belong to the description.
  CalibrationSession(CalibratedDescription start,
                     std::vector<Sample> samples,
                     CalibrationConfig config,
                     CalibrationState state,
                     std::vector<CycleReport> reports);

  const CalibratedDescription& start() const { return start_; }
  /// With the orientation map in force.
  const CalibrationModel& model() const { return model_; }
  const CalibrationConfig& config() const { return config_; }
  const std::vector<Sample>& samples() const { return samples_; }
  const CalibrationState& state() const { return state_; }

  /// The sample as it would be taken: checked, and held out when it is its turn
  /// (CalibrationConfig::hold_out_every). Throws DataError when it cannot be used.
  Sample prepared(Sample sample) const;
  /// Takes a prepared sample.
  void add(Sample sample) {
    samples_.push_back(std::move(sample));
    map_of_samples_.reset();
  }
  /// False when there is no sample with this id.
  bool remove(std::uint32_t id);
  void clearSamples() {
    samples_.clear();
    map_of_samples_.reset();
  }
  /// What the cycle motion takes; nothing where no motion was recorded.
  void setMotion(std::shared_ptr<const MotionRecording> motion) { motion_ = std::move(motion); }
  const MotionRecording* motion() const { return motion_.get(); }

  /// Parameters of the description at the start, as if no cycle had run.
  CalibrationState startState() const;
  /// Puts other parameters in force, with what a motion among their cycles told. Throws DataError
  /// when they do not belong to the description.
  void resume(CalibrationState state,
              std::vector<CycleReport> reports,
              std::optional<MotionEvidence> motion_evidence = std::nullopt);

  /// What the last successful cycle `motion` told; a refinement takes it beside the samples.
  const std::optional<MotionEvidence>& motionEvidence() const { return motion_evidence_; }
  /// The same, where the last cycle that succeeded is such a refinement; null: it is not.
  const MotionEvidence* joinedMotion() const;

  /// Runs one cycle. Its parameters are in force afterwards if it succeeded.
  const CycleReport& run(const CycleRequest& request);
  /// Of all cycles run, in their order.
  const std::vector<CycleReport>& reports() const { return reports_; }

  /// True when every cycle succeeded, or a later one of its kind or a refinement did, and
  /// openParameters() is empty.
  bool isComplete() const;
  /// True when none of the cycles contradicts the samples, or a later one mended it, and
  /// openParameters() is empty: one that was refused for want of data takes nothing away.
  bool isSettled() const;
  /// Ids of the training samples that the parameters of this session's cycles rest on, with those
  /// that are not in use any more.
  std::set<std::uint32_t> fittedSamples() const;
  /// Parameters that some cycle was to estimate and none could.
  std::vector<std::string> openParameters() const;

  /// All parameters as they are in force: `observable` tells whether they are identified, `initial`
  /// is the nominal value.
  std::vector<ParameterEstimate> parameters() const;

  /// The map of what axes and corrections leave of the orientations, or why there is none
  /// (CalibrationConfig::orientation_map). A joint or refine cycle finds it before it begins, from
  /// the orientations in use alone, and takes orientations and torques with it; so do the cycles
  /// after it.
  const OrientationMapChoice& orientationMap() const { return map_; }

  /// What errors the parameters in force let expect over the workspace, whether the reports tell or
  /// not. Found when it is first asked for, and kept until the parameters change.
  const WorkspaceUncertainty& expectedErrors() const;

  /// Everything in force: geometry, corrections, torque law, orientation map, and what the last
  /// motion has told of the rotor.
  Actuator actuator() const;
  /// Standard deviations of its values; absent where a value is not identified.
  ParameterStddevs stddevs() const;
  /// Of the angle of joints, poles and coils that is known worst [rad], as plans and motions count
  /// it: an azimuth on the polar axis, which nothing can tell, does not count. Infinite where one
  /// is not identified.
  double worstStddev() const;

  /// Judges the samples that were held out, or tells how windows of a motion judged it; where both
  /// have a part in what is in force, the worse of both verdicts. Nothing where none was held out.
  std::optional<HeldOutValidation> validation() const;
  /// The same of samples() as they come. It refers to model(), and is of use until a sample goes or
  /// other parameters come into force.
  HeldOutJudge heldOutJudge() const;

  /// The calibrated description. Axes and offsets that were not identified are those of the start,
  /// to the last bit.
  CalibratedDescription description(const CalibrationOrigin& origin) const;

 private:
  const CycleReport* lastSuccess() const;
  const OrientationMapChoice& mapOfSamples();
  OrientationMapChoice mapOfReports() const;
  OrientationMapChoice chosenMap(const std::vector<Sample>& samples) const;
  CalibrationModel modelWith(std::shared_ptr<const OrientationMap> map) const;
  void putInForce(OrientationMapChoice choice);
  CalibrationRecord record(const CalibrationOrigin& origin) const;

  CalibratedDescription start_;
  std::vector<Sample> samples_;
  std::shared_ptr<const MotionRecording> motion_;
  CalibrationConfig config_;
  CalibrationModel model_;  ///< with the map in force
  CalibrationState state_;
  std::vector<CycleReport> reports_;
  std::optional<MotionEvidence> motion_evidence_;
  OrientationMapChoice map_;                                     ///< in force
  std::optional<OrientationMapChoice> map_of_samples_;           ///< nothing: not searched yet
  mutable std::optional<WorkspaceUncertainty> expected_errors_;  ///< nothing: not asked for yet
};

}  // namespace sac
