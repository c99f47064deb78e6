#include "held_out_groups.hpp"

#include <utility>

#include <Eigen/Cholesky>

#include "spherical_actuator_calibration/base/numbering.hpp"

namespace sac {
namespace {

std::string nameOf(std::size_t coil) {
  return "coil " + std::to_string(numberOf(coil));
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
  const Eigen::LLT<Eigen::MatrixXd> factor(S);
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
  std::map<std::string, std::vector<std::size_t>> members;
  const auto add = [&members](const std::string& name, std::size_t n) {
    std::vector<std::size_t>& own = members[name];
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
      add(kOrientations, n);
    }
    for (const std::size_t coil : one.coils) {
      add(nameOf(coil), n);
    }
  }
  for (const auto& [coil, newest] : outliers.changed_coils) {
    for (const std::size_t n : newest) {
      add("the newest of " + nameOf(coil), n);
    }
  }
  std::vector<HeldOutGroup> groups;
  for (const auto& [name, own] : members) {
    Judged& judged = judged_[name];
    if (judged.members != own) {
      judged.members = own;
      judged.group = judgeTogether(measurements, own, covariance);
      judged.group.name = name;
    }
    groups.push_back(judged.group);
  }
  return groups;
}

}  // namespace sac
