#pragma once

/// Generated messages that share their name, in the same namespace, with a type of the core. The
/// names of messages are fixed by the recordings made with them, and those of the core are what its
/// users read; a source file that needs both gets the messages from here, as JointAxisMessage and
/// so on. Only the short names of the generated headers change; the types are the same everywhere.

#define JointAxis JointAxisMessage
#define PoleAxis PoleAxisMessage
#define CoilAxis CoilAxisMessage
#define ParameterEstimate ParameterEstimateMessage
#define SampleResidual SampleResidualMessage
#define PlannedPose PlannedPoseMessage

#include "spherical_actuator_calibration/ActuatorParameters.h"
#include "spherical_actuator_calibration/Calibrate.h"
#include "spherical_actuator_calibration/CalibrationReport.h"
#include "spherical_actuator_calibration/PlanPoses.h"

#undef JointAxis
#undef PoleAxis
#undef CoilAxis
#undef ParameterEstimate
#undef SampleResidual
#undef PlannedPose
