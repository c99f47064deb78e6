#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "spherical_actuator_calibration/calibration/cycle_request.hpp"
#include "spherical_actuator_calibration/calibration/sample_counts.hpp"
#include "spherical_actuator_calibration/calibration/sample_coverage.hpp"
#include "spherical_actuator_calibration/estimation/calibration_model.hpp"
#include "spherical_actuator_calibration/estimation/calibration_state.hpp"
#include "spherical_actuator_calibration/estimation/estimation_problem.hpp"
#include "spherical_actuator_calibration/measurement/sample.hpp"

namespace sac {

/// How well the samples in use look at the joint, a pole or a coil (message Coverage).
struct Coverage {
  std::uint32_t samples = 0;  ///< that tell something about it; held-out ones never count
  std::uint32_t wanted = 1;   ///< samples from which on it is seen well enough
  bool identified = false;    ///< all its parameters are

  bool isSeenWell() const { return samples >= wanted; }
};

/// How far a calibration session has come (message CalibrationStatus).
struct SessionProgress {
  Coverage joint;               ///< see SampleCounts::usefulOrientations()
  std::vector<Coverage> poles;  ///< torque samples in which an excited coil reaches the pole
  std::vector<Coverage> coils;  ///< torque samples in which the excited coil reaches some pole
  std::vector<CycleRequest> next_cycles;      ///< see nextCycles()
  std::size_t samples = 0;                    ///< in use
  std::size_t joint_samples = 0;              ///< that the cycle of the joint would take
  std::vector<std::size_t> samples_per_coil;  ///< see SampleCounts::perCoil()
  std::uint32_t orientation_samples = 0;      ///< that carry an orientation
  std::vector<std::uint32_t> torque_samples;  ///< that carry a torque, per coil that they excite
  std::uint32_t validation_samples = 0;       ///< held out
  bool joint_done = false;                    ///< the joint is identified
  bool poles_done = false;                    ///< poles are identified
  std::vector<bool> coil_done;                ///< per coil
  bool refined = false;                       ///< by the refinement, since the last other cycle
  bool complete = false;                      ///< all is identified, and isSettled() (session)
  bool saved = false;                         ///< the parameters in force are in a file
  bool refused = false;                       ///< the last cycle: samples contradict something
  bool contradicted = false;                  ///< held-out samples disagree with what is in force
  std::size_t removed = 0;                    ///< of fittedSamples() (session): not in use any more
  bool judged = false;                        ///< they agree, and judge all of it
  bool good = false;                          ///< and nothing else speaks against it
  std::string plan_step;  ///< of the plan or the motion that is followed; empty: none

  /// Whether samples excite a coil: motion, which tells the same, comes beside them only where it
  /// is asked for.
  bool hasTorques() const;
  /// Whether the joint, every pole and every coil is identified.
  bool isAllIdentified() const;
};

/// Counts the samples in use one by one, so that a capture costs the same however many there are.
/// What they look at follows from the parameters in force: other parameters, or a sample less, and
/// it is to be counted anew. Keeps a reference to the model.
class ProgressCounter {
 public:
  ProgressCounter(const CalibrationModel& model,
                  const CalibrationState& state,
                  const EstimationOptions& options);

  void add(const Sample& sample);
  void add(const std::vector<Sample>& samples);

  /// What samples and parameters tell of the progress; `refined`, `complete`, `saved`,
  /// `refused`, `contradicted`, `removed`, `judged`, `good` and `plan_step` are not in them.
  SessionProgress progress() const;

 private:
  Coverage coverage(std::size_t samples,
                    std::size_t wanted,
                    Eigen::Index first,
                    Eigen::Index last) const;
  void addCoverage(SessionProgress& progress) const;

  const CalibrationModel& model_;
  std::vector<bool> identified_;  ///< per coordinate
  double current_threshold_;
  SampleCounts counts_;
  CoverageCounter seen_;
  std::size_t samples_ = 0;
  std::uint32_t orientation_samples_ = 0;
  std::uint32_t validation_samples_ = 0;
  std::vector<std::uint32_t> torque_samples_;
};

/// The progress with these samples.
SessionProgress progressOf(const CalibrationModel& model,
                           const std::vector<Sample>& samples,
                           const CalibrationState& state,
                           const EstimationOptions& options);

}  // namespace sac
