#include "wider_space.hpp"

namespace sac {

std::vector<Eigen::Index> placesIn(const ParameterSpace& wide, const ParameterSpace& narrow) {
  std::vector<Eigen::Index> places;
  for (Eigen::Index p = 0, place = 0; p < narrow.size(); ++p, ++place) {
    while (wide.name(place) != narrow.name(p)) {
      ++place;
    }
    places.push_back(place);
  }
  return places;
}

ParameterBelief widened(const ParameterBelief& belief,
                        const std::vector<Eigen::Index>& places,
                        ParameterBelief others) {
  others.x(places) = belief.x;
  others.covariance(places, places) = belief.covariance;
  return others;
}

}  // namespace sac
