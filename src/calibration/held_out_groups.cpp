#include "held_out_groups.hpp"

#include <string>
#include <utility>

#include "spherical_actuator_calibration/base/cholesky.hpp"
#include "spherical_actuator_calibration/base/numbering.hpp"

namespace sac {
namespace {

std::string nameOf(const std::pair<std::size_t, bool>& key) {
  const auto& [number, is_newest] = key;
  return number == 0 ? kOrientations
                     : (is_newest ? "the newest of coil " : "coil ") + std::to_string(number);
}

/// By all that members have in common: the parameters, and the errors of a dwell.
HeldOutGroup judgeTogether(const std::vector<HeldOutMeasurement>& measurements,
                           const std::vector<std::size_t>& members,
                           const Eigen::MatrixXd& covariance) {
  const auto count = static_cast<Eigen::Index>(members.size());
  Eigen::MatrixXd S = Eigen::MatrixXd::Identity(3 * count, 3 * count);
  Eigen::VectorXd residual(3 * count);
  Eigen::MatrixXd common(3 * count, 3);
  for (Eigen::Index a = 0; a < count; ++a) {
    const HeldOutMeasurement& one = measurements[members[static_cast<std::size_t>(a)]];
    residual.segment<3>(3 * a) = one.misfit.residual;
    common.middleRows<3>(3 * a) = Eigen::Matrix3d(one.whitening);
    const Eigen::Matrix<double, Eigen::Dynamic, 3> spread = one.misfit.timesTransposed(covariance);
    for (Eigen::Index b = a; b < count; ++b) {
      const HeldOutMeasurement& other = measurements[members[static_cast<std::size_t>(b)]];
      S.block<3, 3>(3 * b, 3 * a) += other.misfit.times(spread);
      if (other.dwell == one.dwell) {
        S.block<3, 3>(3 * b, 3 * a) += other.loading * one.loading.transpose();
      }
    }
  }
  const Cholesky factor(S);
  HeldOutGroup group;
  group.observations = members.size();
  group.chi_square = residual.dot(factor.solve(residual));
  const Eigen::MatrixXd weighed = factor.solve(common);
  group.sensitivity = (common.transpose() * weighed).trace() / 3.0;
  return group;
}

}  // namespace

std::vector<HeldOutGroup> HeldOutGroups::judge(const std::vector<HeldOutMeasurement>& measurements,
                                               const OutlierChoice& outliers,
                                               const Eigen::MatrixXd& covariance) {
  std::map<Key, std::vector<std::size_t>> members;
  const auto add = [&members](const Key& key, std::size_t n) {
    std::vector<std::size_t>& own = members[key];
    if (own.size() < kJudgedOfAGroup) {
      own.push_back(n);
    }
  };
  for (std::size_t n = measurements.size(); n-- > 0;) {
    const HeldOutMeasurement& one = measurements[n];
    if (!one.counts || outliers.set_aside[n]) {
      continue;
    }
    if (one.quantity == Quantity::kOrientation) {
      add({0, false}, n);
    }
    for (const std::size_t coil : one.coils) {
      add({numberOf(coil), false}, n);
    }
  }
  for (const auto& [coil, newest] : outliers.changed_coils) {
    for (const std::size_t n : newest) {
      add({numberOf(coil), true}, n);
    }
  }
  std::vector<HeldOutGroup> groups;
  for (const auto& [key, own] : members) {
    Judged& judged = judged_[key];
    if (judged.members != own) {
      judged.members = own;
      judged.group = judgeTogether(measurements, own, covariance);
      judged.group.name = nameOf(key);
    }
    groups.push_back(judged.group);
  }
  return groups;
}

}  // namespace sac
