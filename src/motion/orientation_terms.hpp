#pragma once

#include <cstddef>
#include <map>
#include <vector>

#include <Eigen/Core>

#include "motion_span.hpp"
#include "spherical_actuator_calibration/estimation/whitened_observation.hpp"
#include "tracker_term.hpp"

namespace sac {

/// One orientation of the tracker. There are many of them: what they tell is summed up in groups.
struct OrientationTerm {
  float square = 0.0F;  ///< squared whitened residual where it was linearised, over three
  bool active = true;
  bool is_known = false;    ///< readings are there
  bool was_active = false;  ///< when its group was summed up
};

/// What whitened orientations tell as their mean.
struct OrientationMean {
  Eigen::Vector3d residual = Eigen::Vector3d::Zero();  ///< sum
  Eigen::Matrix3Xd jacobian;                           ///< sum, by the coordinates they tell of
  double count = 0.0;

  void add(const OrientationMean& other);
};

/// Orientations one after the other, of a window's length at most.
struct OrientationGroup {
  std::size_t span = 0;
  std::size_t first = 0;  ///< in its span
  std::size_t term = 0;   ///< of the first
  std::size_t count = 0;
  std::size_t cell = 0;  ///< of groups that only what is held out has parted
  bool held_out = false;
  std::size_t window = 0;  ///< in which it is held out

  // Of those that are active, where they were linearised.
  InformationSum sum{0};  ///< robustly weighted
  OrientationMean mean;
  double squares = 0.0;  ///< of their residuals
};

/// A stretch of time whose orientations are held out.
struct HeldOutStretch {
  std::size_t span = 0;
  double begin = 0.0;  ///< by the stamps of orientations
  double end = 0.0;
  std::size_t window = 0;
};

/// The orientations of a recording while the rotor moves, since those of a rest are measurements of
/// a dwell, which are independent of a motion only as long as it does without: linearised one by
/// one, and kept in sums of a window's length, whose size does not depend on the tracker's rate.
/// Robust weights are those of where they were linearised.
class OrientationTerms {
 public:
  /// Keeps references. Of the options the length of a window is that of a group.
  OrientationTerms(const CalibrationModel& model,
                   const MotionPlaces& places,
                   const std::vector<MotionSpan>& spans,
                   const MotionOptions& options,
                   const std::vector<HeldOutStretch>& held_out);

  const CalibrationModel& model() const { return model_; }
  const std::vector<OrientationTerm>& terms() const { return terms_; }
  std::vector<OrientationTerm>& terms() { return terms_; }
  const std::vector<OrientationGroup>& groups() const { return groups_; }
  const std::vector<Eigen::Index>& coordinates() const { return coordinates_; }

  /// Squared scale below which a misfit counts in full.
  void setScale(double scale) { scale_ = scale; }
  /// `stddev`: of the tracker, per component [rad].
  void linearize(const Eigen::VectorXd& x, double stddev, unsigned threads);
  /// Of what serves, at x, in the coordinates that orientations tell of.
  InformationSum sum(const Eigen::VectorXd& x);
  /// The mean of what is held out in each window.
  std::map<std::size_t, OrientationMean> heldOut(const Eigen::VectorXd& x);
  /// Residual of a mean at x.
  Eigen::Vector3d residualAt(const Eigen::VectorXd& x, const OrientationMean& mean) const {
    return mean.residual + mean.jacobian * apart(x);
  }
  /// χ² of the means over a window's time of what serves, at x: drift and wrong joints show there,
  /// white noise does not. Of nothing where these are too few to tell.
  WindowMeansMisfit misfit(const Eigen::VectorXd& x, double coordinates) const;
  void admitHeldOut();

 private:
  void group(std::size_t span,
             const MotionOptions& options,
             const std::vector<HeldOutStretch>& held_out);
  void sumUp(TrackerTerm& tracker, OrientationGroup& group);
  void sumUpWhatChanged();
  Eigen::VectorXd apart(const Eigen::VectorXd& x) const {
    const Eigen::VectorXd moved = x - linearized_at_;
    return moved(coordinates_);
  }

  const CalibrationModel& model_;
  const MotionPlaces& places_;
  const std::vector<MotionSpan>& spans_;
  std::vector<Eigen::Index> coordinates_;
  std::vector<OrientationTerm> terms_;
  std::vector<OrientationGroup> groups_;
  double scale_ = 1.0;
  double summed_scale_ = 1.0;  ///< when they were summed up
  double whitening_ = 1.0;
  unsigned threads_ = 1;
  Eigen::VectorXd linearized_at_;
};

/// Coordinates that orientations of the tracker tell of, ascending: of joints and their sensors, of
/// registrations, and its delay.
std::vector<Eigen::Index> orientingCoordinates(const ParameterSpace& space,
                                               const MotionPlaces& places);

/// Weight of a misfit whose square over its scale is s: beyond twice the scale it counts linearly
/// (Huber).
double robustWeight(double s);

}  // namespace sac
