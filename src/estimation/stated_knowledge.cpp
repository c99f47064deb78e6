#include "spherical_actuator_calibration/estimation/stated_knowledge.hpp"

#include <algorithm>
#include <cstddef>
#include <iterator>

#include "spherical_actuator_calibration/base/cholesky.hpp"

namespace sac {

double statedVariance(const ParameterSpace& space, Eigen::Index coordinate) {
  return coordinate < space.effect() ? 0.0
                                     : space.effects().statedVariance(coordinate - space.effect());
}

std::vector<Eigen::Index> statedOf(const ParameterSpace& space,
                                   const std::vector<Eigen::Index>& coordinates) {
  std::vector<Eigen::Index> result;
  std::copy_if(
      coordinates.begin(), coordinates.end(), std::back_inserter(result), [&](Eigen::Index p) {
        return statedVariance(space, p) > 0.0;
      });
  return result;
}

Eigen::MatrixXd statedCovariance(const ParameterSpace& space,
                                 const std::vector<Eigen::Index>& coordinates) {
  const Eigen::MatrixXd& stated = space.effects().statedCovariance();
  const auto size = static_cast<Eigen::Index>(coordinates.size());
  Eigen::MatrixXd covariance = Eigen::MatrixXd::Zero(size, size);
  for (Eigen::Index a = 0; a < size; ++a) {
    const Eigen::Index effect_a = coordinates[static_cast<std::size_t>(a)] - space.effect();
    for (Eigen::Index b = 0; effect_a >= 0 && b < size; ++b) {
      const Eigen::Index effect_b = coordinates[static_cast<std::size_t>(b)] - space.effect();
      covariance(a, b) = effect_b < 0 ? 0.0 : stated(effect_a, effect_b);
    }
  }
  return covariance;
}

Eigen::MatrixXd statedInformation(const ParameterSpace& space,
                                  const std::vector<Eigen::Index>& coordinates) {
  std::vector<Eigen::Index> stated;
  std::vector<Eigen::Index> places;
  for (std::size_t k = 0; k < coordinates.size(); ++k) {
    if (statedVariance(space, coordinates[k]) > 0.0) {
      stated.push_back(coordinates[k]);
      places.push_back(static_cast<Eigen::Index>(k));
    }
  }
  const auto size = static_cast<Eigen::Index>(coordinates.size());
  Eigen::MatrixXd information = Eigen::MatrixXd::Zero(size, size);
  if (!stated.empty()) {
    information(places, places) = Cholesky(statedCovariance(space, stated)).inverse();
  }
  return information;
}

}  // namespace sac
