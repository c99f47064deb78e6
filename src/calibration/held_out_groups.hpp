#pragma once

#include <cstddef>
#include <map>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "held_out_measurement.hpp"
#include "spherical_actuator_calibration/calibration/held_out_validation.hpp"

namespace sac {

/// Groups of held-out measurements as more of them come: what has not changed is not judged again.
class HeldOutGroups {
 public:
  /// Those that count and are not set aside, the newest kJudgedOfAGroup of each group.
  /// @param covariance of the parameters, P×P
  std::vector<HeldOutGroup> judge(const std::vector<HeldOutMeasurement>& measurements,
                                  const std::vector<bool>& set_aside,
                                  const Eigen::MatrixXd& covariance);

 private:
  struct Judged {
    std::vector<std::size_t> members;
    HeldOutGroup group;
  };
  std::map<std::string, Judged> judged_;
};

}  // namespace sac
