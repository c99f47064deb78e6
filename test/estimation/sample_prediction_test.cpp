#include "spherical_actuator_calibration/estimation/sample_prediction.hpp"

#include <gtest/gtest.h>

#include "spherical_actuator_calibration/actuator/spherical_joint.hpp"
#include "spherical_actuator_calibration/actuator/torque_model.hpp"
#include "spherical_actuator_calibration/base/rotations.hpp"
#include "support/scenarios.hpp"

namespace sac {
namespace {

TEST(SamplePrediction, IsWhatTheForwardModelsSay) {
  scenarios::Generator generator(1);
  const Actuator truth = scenarios::perturbed(scenarios::paperNominal(), 0.02, 0.02, generator);
  const CalibrationModel model{ParameterSpace(scenarios::paperNominal())};
  const Eigen::VectorXd x = model.space().coordinatesOf(truth);
  for (int n = 0; n < 20; ++n) {
    Sample sample = scenarios::mixedTorqueSample(
        truth, scenarios::randomPose(0.3, generator), {2.0, -1.0, 0.5}, generator);
    sample.has_orientation = true;
    predictMeasurements({model, x}, sample);
    const Eigen::Matrix3d R = rotorOrientation(jointGeometry(truth.joints), sample.joint_position);
    EXPECT_LT((sample.R_stator_rotor - R).norm(), 1e-12);
    const Eigen::Vector3d torque =
        rotorTorque(TorqueCurve(*truth.torque_curve), torqueGeometry(truth), R, sample.current);
    EXPECT_LT((sample.torque - torque).norm(), 1e-12);
  }
}

TEST(SamplePrediction, KnowsLaboratoryEffects) {
  EffectSelection effects;
  effects["torque_bias"] = true;
  effects["marker_registration"] = true;
  const CalibrationModel model{ParameterSpace(scenarios::paperNominal(), effects)};
  const EffectLayout& layout = model.space().effects();
  Eigen::VectorXd x = Eigen::VectorXd::Zero(model.space().size());
  const Eigen::Index bias = layout.first("torque_bias");
  x[model.space().effect() + bias] = 0.003 / layout.scale(bias);
  x[model.space().effect() + layout.first("marker_registration") + 1] = 0.02;

  Sample sample;
  sample.has_orientation = true;
  sample.has_torque = true;
  sample.joint_position = {0.1, -0.2, 3.0};
  sample.current = Eigen::VectorXd::Zero(24);
  predictMeasurements({model, x}, sample);
  EXPECT_TRUE(sample.torque.isApprox(Eigen::Vector3d(0.003, 0.0, 0.0)));
  const Eigen::Matrix3d R = rotorOrientation(JointGeometry{}, sample.joint_position) *
                            rotationExp(Eigen::Vector3d(0.0, 0.02, 0.0));
  EXPECT_LT((sample.R_stator_rotor - R).norm(), 1e-12);
}

TEST(SamplePrediction, ChangesNothingElse) {
  const CalibrationModel model{ParameterSpace(scenarios::paperNominal())};
  Sample sample;
  sample.torque = {1.0, 2.0, 3.0};
  predictMeasurements({model, Eigen::VectorXd::Zero(model.space().size())}, sample);
  EXPECT_EQ(sample.torque, Eigen::Vector3d(1.0, 2.0, 3.0));
  EXPECT_EQ(sample.R_stator_rotor, Eigen::Matrix3d::Identity());
}

}  // namespace
}  // namespace sac
