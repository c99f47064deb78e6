#include "told_coils.hpp"

#include <algorithm>

#include "linear_coils.hpp"

namespace sac {

void ToldCoils::add(const HeldOutMeasurement& torque, const ParameterSpace& space) {
  const std::vector<Eigen::Index>& columns = torque.misfit.columns;
  const auto information = [&](Eigen::Index coordinate) {
    const auto found = std::lower_bound(columns.begin(), columns.end(), coordinate);
    return found == columns.end() || *found != coordinate
               ? 0.0
               : torque.misfit.jacobian.col(found - columns.begin()).squaredNorm();
  };
  for (const std::size_t coil : torque.coils) {
    const Eigen::Index first = space.coil(coil);
    information_[coil] += std::max(information(first), information(first + 1));
  }
}

std::set<std::size_t> ToldCoils::coils() const {
  std::set<std::size_t> told;
  for (const auto& [coil, information] : information_) {
    if (kLinearRange * kLinearRange * information > 1.0) {
      told.insert(coil);
    }
  }
  return told;
}

}  // namespace sac
