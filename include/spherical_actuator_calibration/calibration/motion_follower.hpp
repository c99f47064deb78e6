#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "spherical_actuator_calibration/calibration/calibration_config.hpp"
#include "spherical_actuator_calibration/calibration/calibration_report.hpp"
#include "spherical_actuator_calibration/calibration/group_uncertainty.hpp"
#include "spherical_actuator_calibration/estimation/calibration_model.hpp"
#include "spherical_actuator_calibration/motion/live_motion.hpp"

namespace sac {

/// What a motion tells of one unit while it goes on, in words of parameters.
class MotionFollower {
 public:
  /// Nominal parameters, as uncertain as the tolerance says: what was calibrated before does not
  /// count. `wanted_stddev`: of each parameter of joints, poles and coils [rad].
  MotionFollower(const Actuator& nominal, const CalibrationConfig& config, double wanted_stddev);

  /// Whether motions of this actuator tell anything: it has joints and a torque model.
  static bool suits(const Actuator& nominal);

  void add(MotionSlice slice) { live_.add(std::move(slice)); }
  const LiveEstimate& estimate() const { return live_.estimate(); }
  double wantedStddev() const { return wanted_stddev_; }
  std::vector<GroupUncertainty> groups() const;
  /// Of such motion, until all is known as well as wanted, where variances fall with the inverse of
  /// the time [s]. Nothing before the first estimate.
  std::optional<double> timeLeft() const;
  /// Whether so many windows serve that the calibration holds some of them out, which judge it; a
  /// fifth more than it wants, since a recording begins and ends its windows elsewhere.
  bool canBeJudged() const;
  /// Whether all is known as well as wanted, and can be judged.
  bool isEnough() const;
  /// What is known, and what is left to what is wanted, in a sentence.
  std::string inWords() const;
  /// Inertia, unbalance, friction and delays.
  std::vector<ParameterEstimate> dynamics() const;

 private:
  GroupUncertainty group(const std::string& name,
                         Eigen::Index first,
                         Eigen::Index end,
                         const Eigen::VectorXd& stddevs) const;

  double wanted_stddev_;
  std::unique_ptr<const CalibrationModel> model_;  ///< does not move with the follower
  LiveMotion live_;
};

}  // namespace sac
