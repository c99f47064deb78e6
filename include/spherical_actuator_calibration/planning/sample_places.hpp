#pragma once

#include <cstddef>
#include <vector>

#include "spherical_actuator_calibration/measurement/sample.hpp"

namespace sac {

/// Tells samples apart that were measured at different places: samples within kPoseTolerance of the
/// first one of a place, and held out as it is, are of that place.
class SamplePlaces {
 public:
  /// Number of the sample's place, counted from 0 in the order of their first samples.
  std::size_t placeOf(const Sample& sample);

 private:
  struct Place {
    Eigen::Vector3d joint_position;  ///< raw sensor angles [rad]
    bool validation;
  };

  std::vector<Place> places_;
};

}  // namespace sac
