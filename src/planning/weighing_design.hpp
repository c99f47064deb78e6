#pragma once

#include <functional>
#include <vector>

#include <Eigen/Core>

#include "design_task.hpp"

namespace sac {

/// Poses with patterns of several coils, exchanged for a small largest standard deviation.
///
/// A norm of the variances stands for the largest, of an exponent that grows. For each exponent,
/// patterns are exchanged one by one at the poses as they are; then each pose, with all of its
/// patterns, for the few candidates that promise most to first order. It ends where no exchange
/// gains anything, a plan from which no single exchange leads on, though others may be better. At
/// last coils of too few poses are excited at further ones.
class WeighingDesign {
 public:
  /// Keeps references to task and candidates. `poses`: candidates to begin with.
  WeighingDesign(const DesignTask& task,
                 const std::vector<PoseCandidate>& candidates,
                 const std::vector<std::size_t>& poses,
                 std::function<bool()> is_time_up);

  /// Chooses patterns at the poses as they are.
  void choosePatterns();

  /// Exchanges patterns and poses.
  void exchange();

  const std::vector<DesignedPose>& poses() const { return poses_; }

  /// Largest standard deviation of the values for people [rad].
  double worstStddev() const;

 private:
  bool exchangePatterns();
  bool exchangePoses();
  /// Excites coils at as many poses as they are to be (CoilVisits), as far as that can be.
  void spreadCoils();
  /// Exchanges a term that can be spared for the coil, at a pose that does not excite it yet, at
  /// the least cost of merit; false where there is none.
  bool exciteElsewhere(std::size_t coil);
  /// The best patterns at a candidate, one after the other, for a covariance, which they shrink.
  DesignedPose designedAt(std::size_t candidate, Eigen::MatrixXd& covariance) const;
  /// Candidates that may join the poses and promise most to first order.
  std::vector<std::size_t> promising(const Eigen::MatrixXd& covariance);
  bool keepsDistance(std::size_t candidate) const;
  Eigen::MatrixXd covariance() const;
  Eigen::VectorXd weightsAt(const Eigen::MatrixXd& covariance) const;
  /// Logarithm of the norm of standard deviations; less is better.
  double meritOf(const Eigen::MatrixXd& covariance) const;
  bool isTimeUp() const { return is_time_up_ && is_time_up_(); }

  const DesignTask& task_;
  const std::vector<PoseCandidate>& candidates_;
  std::function<bool()> is_time_up_;
  double exponent_;
  std::vector<DesignedPose> poses_;
  std::vector<Eigen::MatrixXd> eliminations_;  ///< per candidate, of the errors of its readings
};

}  // namespace sac
