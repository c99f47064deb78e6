#pragma once

#include <cstddef>
#include <string>

#include "spherical_actuator_calibration/estimation/calibration_model.hpp"

namespace sac {

/// Columns beside the coordinates of a problem that residuals may depend on. All columns together:
/// the P coordinates, then the effects that the problem does not model, each whole as if it were
/// alone, and the scales of the joints' readings.
class FurtherColumns {
 public:
  explicit FurtherColumns(const CalibrationModel& model);

  const ParameterSpace& space() const { return own_; }
  /// Of the effects that the problem does not model; its geometry is that of space().
  const CalibrationModel& model() const { return model_; }

  Eigen::Index effect(Eigen::Index coordinate) const { return own_.size() + coordinate; }
  Eigen::Index scale(std::size_t joint) const {
    return effect(model_.space().effects().size()) + static_cast<Eigen::Index>(joint);
  }
  Eigen::Index size() const { return scale(own_.joints()); }
  /// The first column of an effect, be it modelled or not, or −1 where there is none.
  Eigen::Index first(const std::string& effect) const;

 private:
  const ParameterSpace& own_;
  CalibrationModel model_;
};

}  // namespace sac
