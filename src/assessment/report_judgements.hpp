#pragma once

#include <vector>

#include "spherical_actuator_calibration/assessment/model_choice.hpp"
#include "spherical_actuator_calibration/assessment/sample_influence.hpp"
#include "spherical_actuator_calibration/base/yaml_writer.hpp"
#include "spherical_actuator_calibration/calibration/calibration_session.hpp"

namespace sac {

// Parts of renderReport() that judge measurements and model, each under its key.

void writeInfluences(YamlWriter& writer, const std::vector<SampleInfluence>& influences);
/// Nothing where no effect is modelled.
void writeModelChoice(YamlWriter& writer, const std::vector<ModelFit>& fits);
/// Nothing where none was judged.
void writeOrientationMap(YamlWriter& writer, const OrientationMapChoice& choice);
/// Nothing without a torque model.
void writeTorqueLinearity(YamlWriter& writer, const CalibrationSession& session);

}  // namespace sac
