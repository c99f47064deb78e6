#pragma once

#include <cstddef>
#include <map>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include "held_out_measurement.hpp"
#include "held_out_outliers.hpp"
#include "spherical_actuator_calibration/calibration/held_out_validation.hpp"

namespace sac {

/// Groups of held-out measurements as more of them come: what has not changed is not judged again.
class HeldOutGroups {
 public:
  /// Those that count and are not set aside, the newest kJudgedOfAGroup of each group:
  /// orientations, torques with each coil on, and the newest of a coil that has changed.
  /// @param covariance of the parameters, P×P
  std::vector<HeldOutGroup> judge(const std::vector<HeldOutMeasurement>& measurements,
                                  const OutlierChoice& outliers,
                                  const Eigen::MatrixXd& covariance);

 private:
  /// 0: orientations, else the number of a coil, counted from 1; and whether its newest ones alone.
  using Key = std::pair<std::size_t, bool>;
  struct Judged {
    std::vector<std::size_t> members;
    HeldOutGroup group;
  };
  std::map<Key, Judged> judged_;
};

}  // namespace sac
