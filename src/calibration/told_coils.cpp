#include "told_coils.hpp"

#include <algorithm>
#include <iterator>

#include "linear_coils.hpp"

namespace sac {

std::vector<std::size_t> toldCoils(const HeldOutMeasurement& torque, const ParameterSpace& space) {
  const std::vector<Eigen::Index>& columns = torque.misfit.columns;
  const auto shows = [&](Eigen::Index coordinate) {
    const auto found = std::lower_bound(columns.begin(), columns.end(), coordinate);
    return found != columns.end() && *found == coordinate &&
           kLinearRange * torque.misfit.jacobian.col(found - columns.begin()).norm() > 1.0;
  };
  std::vector<std::size_t> told;
  std::copy_if(
      torque.coils.begin(), torque.coils.end(), std::back_inserter(told), [&](std::size_t coil) {
        return shows(space.coil(coil)) || shows(space.coil(coil) + 1);
      });
  return told;
}

}  // namespace sac
