#pragma once

#include <optional>
#include <vector>

#include <Eigen/Core>

#include "spherical_actuator_calibration/estimation/linearization.hpp"
#include "spherical_actuator_calibration/estimation/sequential_update.hpp"

namespace sac {

/// What samples tell, one after the other: the estimate of all coordinates and their covariance
/// after each, for a small part of the time of an estimation over all of them. Both are those of
/// one Gauss–Newton step over all samples and the prior from the point of linearisation, with the
/// weights of that point, errors that a dwell shares included (SequentialUpdate).
///
/// Rounding grows with the variance of the prior over that of the noise. Against normal equations
/// of 80 samples, from tolerances of manufacture: 1e-11 rad and 1e-9 of the covariance with noise
/// of 3e-4 rad, 5e-10 rad and 4e-7 with 1e-6 rad. Noise of 1e-8 rad leaves 2e-5 rad, less leaves
/// nothing.
///
/// What an orientation map leaves open is less by the tracker's noise, here of the samples so far:
/// with a map it is exact where that noise is the same in all, from the first sample on.
///
/// It judges nothing: no sample is an outlier, no coordinate is held, a stated uncertainty that is
/// too small stays so. What comes into force is what a cycle finds.
class IncrementalEstimate {
 public:
  /// Linearises at the prior. Every coordinate has its prior uncertainty; one without any is known.
  /// Keeps a reference to the model. Throws DataError when the prior is not of the model's
  /// coordinates.
  IncrementalEstimate(const CalibrationModel& model,
                      ParameterBelief prior,
                      const EstimationOptions& options);

  /// Takes a sample in; one that is held out tells nothing. Samples of one dwell follow each other.
  /// Throws DataError when the sample is not valid, or has a torque that the model has not.
  void add(const Sample& sample);

  /// After all samples so far.
  ParameterBelief belief() const;

  /// Whether the estimate has left the neighbourhood of the point of linearisation [rad], where the
  /// linear model holds within the noise of usual samples. Then relinearize().
  bool hasMovedFar() const;
  /// Starts again from the present estimate as the point of linearisation; `samples`: all so far.
  void relinearize(const std::vector<Sample>& samples);

 private:
  void restart(const Eigen::VectorXd& at);

  const CalibrationModel& model_;
  EstimationOptions options_;
  ParameterBelief prior_;
  std::vector<bool> nothing_held_;
  ChosenCoordinates every_;
  Eigen::VectorXd at_;                      ///< the point of linearisation
  std::optional<ModelPoint> point_;         ///< the model there
  TrackerNoise tracker_;                    ///< of the samples so far
  std::optional<SequentialUpdate> update_;  ///< of the coordinates, less at_
  std::optional<Sample> dwell_;   ///< the first sample of the dwell, where it shares errors
  LinearizedObservation linear_;  ///< of the observation at hand
  WhitenedObservation whitened_;
};

}  // namespace sac
