#pragma once

#include "spherical_actuator_calibration/estimation/estimation_problem.hpp"
#include "spherical_actuator_calibration/estimation/parameter_space.hpp"
#include "spherical_actuator_calibration/motion/motion_streams.hpp"

namespace sac {

/// How well currents that are sampled tell when they act. What a current does between two samples
/// nobody knows, unless commands tell it (CommandResponse): where it steps and then lags, its mean
/// over a time is that of samples that are earlier or later, by up to half an interval.
class CurrentSteps {
 public:
  /// More currents.
  void add(const MotionStreams& streams);
  /// Standard deviation of their delay by that alone [s]. `noise`: of a current [A].
  double delayStddev(double noise) const;
  /// Adds it to the uncertainty of the delay, where that was estimated; the variance added, in the
  /// unit of the coordinate.
  double widen(const ParameterSpace& space, double noise, ParameterBelief& belief) const;

 private:
  void addSampled(const MotionStreams& streams);
  double sampledStddev(double noise) const;

  // Where commands tell steps.
  double told_slopes_ = 0.0;  ///< ∫(dI/dt)² dt
  double told_ = 0.0;         ///< the same times the standard deviation, span by span
  // Of the others.
  double slopes_ = 0.0;    ///< ∫(dI/dt)² dt
  double per_time_ = 0.0;  ///< what the square of noise is multiplied by in half of it
  double changes_ = 0.0;   ///< sum of squared differences from one sample to the next
  double next_ = 0.0;      ///< of their products with the ones before
  double second_ = 0.0;    ///< with those before that
  double duration_ = 0.0;
  double intervals_ = 0.0;
  double values_ = 0.0;     ///< in each sum
  double stretches_ = 0.0;  ///< of some samples each
  double stepping_ = 0.0;   ///< those that show steps
};

}  // namespace sac
