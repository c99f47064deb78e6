#pragma once

#include <cstddef>
#include <string>

#include "spherical_actuator_calibration/estimation/calibration_model.hpp"

namespace sac {

/// Columns beside the coordinates of a problem that residuals may depend on. All columns together:
/// the P coordinates, then the effects that the problem does not model, the scales of the joints'
/// readings, and the strength of the first coil by itself.
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
  /// Beside the common strength the first coil has no gain of its own: it is the strength that the
  /// other coils do not share. −1: there is none.
  Eigen::Index firstCoil() const { return has_first_coil_ ? scale(own_.joints()) : -1; }
  Eigen::Index size() const { return scale(own_.joints()) + (has_first_coil_ ? 1 : 0); }
  /// The first column of an effect, be it modelled or not, or −1 where there is none.
  Eigen::Index first(const std::string& effect) const;

 private:
  const ParameterSpace& own_;
  CalibrationModel model_;
  bool has_first_coil_;
};

}  // namespace sac
