#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "spherical_actuator_calibration/actuator/calibration_record.hpp"
#include "spherical_actuator_calibration/actuator/orientation_map.hpp"
#include "spherical_actuator_calibration/calibration/map_use.hpp"
#include "spherical_actuator_calibration/estimation/calibration_model.hpp"
#include "spherical_actuator_calibration/estimation/calibration_state.hpp"
#include "spherical_actuator_calibration/estimation/estimation_problem.hpp"
#include "spherical_actuator_calibration/measurement/sample.hpp"

namespace sac {

/// A map, or why there is none.
struct OrientationMapChoice {
  std::shared_ptr<const OrientationMap> map;  ///< null: none
  std::optional<MapRecord> record;            ///< of the judgement by regions, where there was one
  std::string sentence;                       ///< for people
};

/// Splits poses (readings) into 2^depth regions of neighbours, by halves along the joint of the
/// widest spread relative to that of all. Returns the region of each pose.
std::vector<std::size_t> regionsOf(const std::vector<Eigen::Vector3d>& readings, int depth);

/// Fits a map to what axes and corrections leave of the orientations, and judges it by regions of
/// the joint space (doc/method.md, Residual map): for each, parameters and map are estimated from
/// the orientations of all others, and predict it. With kAuto a map is chosen that predicts better
/// beyond chance. Torques take no part.
OrientationMapChoice chooseOrientationMap(const CalibrationModel& model,
                                          const std::vector<Sample>& samples,
                                          const CalibrationState& start,
                                          const EstimationOptions& options,
                                          MapUse use);

}  // namespace sac
