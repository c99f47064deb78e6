#include "spherical_actuator_calibration/ros/conversion/msg_conversion.hpp"

#include <array>
#include <cmath>
#include <limits>
#include <optional>

#include <gtest/gtest.h>

#include "spherical_actuator_calibration/CapturePlanned.h"
#include "spherical_actuator_calibration/actuator/spherical_joint.hpp"
#include "spherical_actuator_calibration/actuator/torque_model.hpp"
#include "spherical_actuator_calibration/base/error.hpp"
#include "spherical_actuator_calibration/base/rotations.hpp"
#include "spherical_actuator_calibration/planning/planned_capture.hpp"
#include "spherical_actuator_calibration/ros/conversion/messages.hpp"
#include "support/error_message.hpp"
#include "support/scenarios.hpp"

namespace sac {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

Sample exampleSample() {
  Sample sample;
  sample.id = 7;
  sample.stamp = 1'700'000'000'123'456'789;
  sample.validation = true;
  sample.joint_position = {0.1, -0.2, 0.3};
  sample.joint_stddev = {1e-5, 2e-5, 3e-5};
  sample.has_orientation = true;
  sample.R_stator_rotor = rotationExp({0.4, -0.5, 2.6});
  sample.orientation_stddev = 4e-5;
  sample.has_torque = true;
  sample.torque = {0.5, -0.6, 0.7};
  sample.torque_stddev = 5e-5;
  sample.dwell = 1'500'000'000'000'000'001;
  sample.joint_shared_stddev = {0.5e-5, 1e-5, 2e-5};
  sample.torque_shared_stddev = 3e-5;
  sample.current = Eigen::Vector3d(1.5, 0.0, -2.0);
  sample.duration = 0.6;
  sample.measurements = 120;
  return sample;
}

sensor_msgs::JointState jointState(const std::vector<std::string>& names,
                                   const std::vector<double>& positions) {
  sensor_msgs::JointState message;
  message.header.stamp = ros::Time(12, 345);
  message.name = names;
  message.position = positions;
  return message;
}

TEST(MsgConversion, SamplesComeBackAsTheyWere) {
  const Sample sample = exampleSample();
  const Sample back = sampleFromRos(sampleToRos(sample));
  EXPECT_EQ(back.id, sample.id);
  EXPECT_EQ(back.stamp, sample.stamp);
  EXPECT_EQ(back.validation, sample.validation);
  EXPECT_EQ(back.joint_position, sample.joint_position);
  EXPECT_EQ(back.joint_stddev, sample.joint_stddev);
  EXPECT_EQ(back.has_orientation, sample.has_orientation);
  EXPECT_LT((back.R_stator_rotor - sample.R_stator_rotor).norm(), 1e-14);
  EXPECT_EQ(back.orientation_stddev, sample.orientation_stddev);
  EXPECT_EQ(back.has_torque, sample.has_torque);
  EXPECT_EQ(back.torque, sample.torque);
  EXPECT_EQ(back.torque_stddev, sample.torque_stddev);
  EXPECT_EQ(back.dwell, sample.dwell);
  EXPECT_EQ(back.joint_shared_stddev, sample.joint_shared_stddev);
  EXPECT_EQ(back.torque_shared_stddev, sample.torque_shared_stddev);
  EXPECT_EQ(back.current, sample.current);
  EXPECT_EQ(back.duration, sample.duration);
  EXPECT_EQ(back.measurements, sample.measurements);
}

TEST(MsgConversion, RefusesSamplesWhoseOrientationIsNoUnitQuaternion) {
  for (const double w : {0.0, 2.0, kNaN, std::numeric_limits<double>::infinity()}) {
    msg::CalibrationSample message = sampleToRos(exampleSample());
    message.orientation.w = w;
    EXPECT_EQ(errorMessage<DataError>([&] { sampleFromRos(message); }),
              "Sample 7: orientation is not a unit quaternion.");
  }
}

TEST(MsgConversion, NormalisesRoundedQuaternions) {
  msg::CalibrationSample message = sampleToRos(exampleSample());
  message.orientation.x *= 1.0 + 1e-6;
  EXPECT_NO_THROW(validate(sampleFromRos(message), 3));
}

TEST(MsgConversion, IgnoresTheOrientationOfSamplesThatHaveNone) {
  Sample sample = exampleSample();
  sample.has_orientation = false;
  msg::CalibrationSample message = sampleToRos(sample);
  message.orientation.w = kNaN;
  EXPECT_EQ(sampleFromRos(message).R_stator_rotor, Eigen::Matrix3d::Identity());
}

TEST(MsgConversion, QuaternionsKeepTheOrderOfTheirComponents) {
  geometry_msgs::QuaternionStamped message;
  message.header.stamp = ros::Time(3, 4);
  message.quaternion.x = 0.1;
  message.quaternion.y = 0.2;
  message.quaternion.z = 0.3;
  message.quaternion.w = 0.4;
  const OrientationMeasurement measurement = orientationFromRos(message);
  EXPECT_EQ(measurement.stamp, 3'000'000'004);
  EXPECT_EQ(measurement.q_stator_rotor.coeffs(), Eigen::Vector4d(0.1, 0.2, 0.3, 0.4));
  EXPECT_EQ(quaternionToRos(measurement.q_stator_rotor).w, 0.4);
  EXPECT_EQ(quaternionToRos(measurement.q_stator_rotor).y, 0.2);
}

TEST(MsgConversion, TorquesAndCurrentsKeepStampAndOrder) {
  geometry_msgs::Vector3Stamped torque;
  torque.header.stamp = ros::Time(5, 6);
  torque.vector = vectorToRos({1.0, 2.0, 3.0});
  EXPECT_EQ(torqueFromRos(torque).stamp, 5'000'000'006);
  EXPECT_EQ(torqueFromRos(torque).torque, Eigen::Vector3d(1.0, 2.0, 3.0));

  msg::CoilCurrents currents;
  currents.header.stamp = ros::Time(7, 8);
  currents.current = {0.1, 0.2};
  CurrentMeasurement measurement;
  currentFromRos(currents, measurement);
  EXPECT_EQ(measurement.stamp, 7'000'000'008);
  EXPECT_EQ(measurement.current, Eigen::Vector2d(0.1, 0.2));
}

TEST(JointStateReader, FindsJointsByNameWhateverTheirOrder) {
  JointStateReader reader({"a", "b", "c"});
  const auto first = reader.read(jointState({"c", "x", "a", "b"}, {3.0, 9.0, 1.0, 2.0}));
  ASSERT_TRUE(first);
  EXPECT_EQ(first->stamp, 12'000'000'345);
  EXPECT_EQ(first->position, Eigen::Vector3d(1.0, 2.0, 3.0));
  const auto second = reader.read(jointState({"a", "b", "c"}, {1.0, 2.0, 3.0}));
  ASSERT_TRUE(second);
  EXPECT_EQ(second->position, Eigen::Vector3d(1.0, 2.0, 3.0));
}

TEST(JointStateReader, ReadsNothingWhenAJointOrItsPositionIsMissing) {
  JointStateReader reader({"a", "b", "c"});
  EXPECT_FALSE(reader.read(jointState({"a", "b"}, {1.0, 2.0})));
  EXPECT_FALSE(reader.read(jointState({"a", "b", "c"}, {1.0, 2.0})));
  EXPECT_FALSE(reader.read(jointState({}, {})));
  EXPECT_TRUE(reader.read(jointState({"a", "b", "c"}, {1.0, 2.0, 3.0})));
}

TEST(MsgConversion, ParametersTellTheActuator) {
  Actuator actuator = scenarios::paperNominal();
  actuator.serial = "unit-042";
  actuator.joints[1].offset = 0.25;
  actuator.poles[1].gain = 1.5;
  const msg::ActuatorParameters message = parametersToRos(actuator);
  EXPECT_EQ(message.actuator, actuator.name);
  EXPECT_EQ(message.serial, "unit-042");
  EXPECT_TRUE(message.has_joints);
  EXPECT_EQ(vectorFromRos(message.joints[1].axis), actuator.joints[1].axis);
  EXPECT_EQ(message.joints[1].offset, 0.25);
  ASSERT_EQ(message.poles.size(), actuator.poles.size());
  EXPECT_EQ(message.poles[1].azimuth, actuator.poles[1].azimuth);
  EXPECT_EQ(message.poles[1].polarity, -1);
  EXPECT_EQ(message.poles[1].gain, 1.5);
  ASSERT_EQ(message.coils.size(), actuator.coils.size());
  EXPECT_EQ(message.coils[13].polar, actuator.coils[13].polar);
}

TEST(MsgConversion, ParametersTellHowWellEachIsIdentified) {
  ParameterStddevs stddevs;
  stddevs.joints[2] = {1e-4, 2e-4, std::nullopt};
  stddevs.poles.resize(8);
  stddevs.coils.resize(24);
  stddevs.poles[3] = {3e-4, 4e-4, 5e-4};
  stddevs.coils[9].azimuth = 6e-4;
  stddevs.unbalance = Eigen::Vector3d(1e-5, 2e-5, 3e-5);
  const msg::ActuatorParameters message = parametersToRos(scenarios::paperNominal(), stddevs);
  EXPECT_EQ(message.joints[2].offset_stddev, 1e-4);
  EXPECT_EQ(message.joints[2].axis_stddev[0], 2e-4);
  EXPECT_TRUE(std::isinf(message.joints[2].axis_stddev[1]));
  EXPECT_EQ(message.poles[3].polar_stddev, 3e-4);
  EXPECT_EQ(message.poles[3].azimuth_stddev, 4e-4);
  EXPECT_EQ(message.poles[3].gain_stddev, 5e-4);
  EXPECT_EQ(message.coils[9].azimuth_stddev, 6e-4);
  EXPECT_TRUE(std::isinf(message.coils[9].polar_stddev));
  EXPECT_EQ(vectorFromRos(message.unbalance_stddev), *stddevs.unbalance);
  EXPECT_TRUE(std::isinf(parametersToRos(scenarios::paperNominal()).unbalance_stddev.y));
}

TEST(MsgConversion, ParametersTellHowWellTheTorqueCurveIsKnown) {
  Actuator actuator = scenarios::paperNominal();
  EXPECT_TRUE(parametersToRos(actuator).torque_curve.stddevs.empty());
  // A table that was measured states it, until the curve is identified.
  actuator.torque_curve->table = {
      {0.0, 5.0, 20.0, 30.0}, {0.0, 0.2, 0.3, 0.0}, {1e-4, 2e-4, 2e-4, 1e-4}};
  EXPECT_EQ(parametersToRos(actuator).torque_curve.stddev_angles[1], 5.0);
  EXPECT_EQ(parametersToRos(actuator).torque_curve.stddevs[1], 2e-4);
  ParameterStddevs stddevs;
  stddevs.torque_curve = TorqueCurveStddev{{0.0, 10.0}, {0.0, 3e-5}};
  EXPECT_EQ(parametersToRos(actuator, stddevs).torque_curve.stddev_angles[1], 10.0);
  EXPECT_EQ(parametersToRos(actuator, stddevs).torque_curve.stddevs[1], 3e-5);
}

/// The paper's unit with everything that can be identified of one.
Actuator identifiedActuator() {
  Actuator actuator = scenarios::paperTruth();
  actuator.joints[0].correction = {{1e-3, -2e-3, 0.0}, {1e-3, 2e-3, -1e-3, 5e-4}};
  actuator.joints[2].correction.harmonics[1] = 3e-3;
  actuator.poles[1].gain = 1.05;
  actuator.unbalance << 1e-3, -2e-3, 3e-3;
  actuator.torque_curve->coefficients[1] *= 1.02;
  actuator.orientation_map = std::make_shared<OrientationMap>(scenarios::orientationMap());
  return actuator;
}

TEST(MsgConversion, ParametersTellAllThatIsIdentified) {
  const Actuator actuator = identifiedActuator();
  const auto back = actuatorFromRos(parametersToRos(actuator), scenarios::paperNominal());
  ASSERT_TRUE(back);
  EXPECT_EQ(back->unbalance, actuator.unbalance);
  const Eigen::Vector3d q(0.2, -0.1, 1.0);
  const Eigen::Matrix3d R = rotorOrientation(jointGeometry(actuator), q);
  EXPECT_LT((rotorOrientation(jointGeometry(*back), q) - R).norm(), 1e-14);
  EXPECT_EQ(back->orientation_map->description().tracker_noise,
            actuator.orientation_map->description().tracker_noise);
  EXPECT_GT((rotorOrientation(jointGeometry(scenarios::paperTruth()), q) - R).norm(), 1e-3);
  const auto torques = [&](const Actuator& from) {
    return torquePerAmpere(TorqueCurve(*from.torque_curve), torqueGeometry(from), R);
  };
  EXPECT_LT((torques(*back) - torques(actuator)).norm(), 1e-14);
}

TEST(MsgConversion, ParametersTellATableAsItIs) {
  Actuator actuator = scenarios::paperNominal();
  TorqueCurveDescription& curve = *actuator.torque_curve;
  curve.coefficients = {1e-3};
  curve.table.angles = {0.0, 5.0, 10.0, 20.0, 30.0};
  curve.table.torques = {0.0, 0.2, 0.28, 0.2, 0.0};
  const auto back = actuatorFromRos(parametersToRos(actuator), scenarios::paperNominal());
  ASSERT_TRUE(back);
  for (double psi = 0.0; psi < 0.6; psi += 0.01) {
    EXPECT_EQ(TorqueCurve(*back->torque_curve).value(psi), TorqueCurve(curve).value(psi));
  }
}

TEST(MsgConversion, ParametersThatAreNoneAreRefused) {
  const msg::ActuatorParameters sound = parametersToRos(identifiedActuator());
  ASSERT_TRUE(actuatorFromRos(sound, scenarios::paperNominal()));
  msg::ActuatorParameters message = sound;
  message.orientation_map.noise[1] = 0.0;
  EXPECT_FALSE(actuatorFromRos(message, scenarios::paperNominal()));
  message = sound;
  message.orientation_map.tracker_noise = -1e-4;
  EXPECT_FALSE(actuatorFromRos(message, scenarios::paperNominal()));
  message = sound;
  message.orientation_map.rotations.pop_back();
  EXPECT_FALSE(actuatorFromRos(message, scenarios::paperNominal()));
  message = sound;
  message.torque_curve.support[1] = 1.0;
  EXPECT_FALSE(actuatorFromRos(message, scenarios::paperNominal()));
  message = sound;
  message.actuator = "another";
  EXPECT_FALSE(actuatorFromRos(message, scenarios::paperNominal()));
  message = sound;
  message.poles[3].polarity = static_cast<std::int8_t>(-message.poles[3].polarity);
  EXPECT_FALSE(actuatorFromRos(message, scenarios::paperNominal()));
  message = sound;
  message.has_joints = 0;
  EXPECT_FALSE(actuatorFromRos(message, scenarios::paperNominal()));
  Actuator made = scenarios::paperNominal();
  made.serial = "unit-1";
  message = sound;
  message.serial = "unit-2";
  EXPECT_FALSE(actuatorFromRos(message, made));
  message.serial.clear();
  EXPECT_TRUE(actuatorFromRos(message, made)) << "who names none is taken";
}

TEST(MsgConversion, AnEntryOfACorrectionThatIsNotIdentifiedHasAnInfiniteStandardDeviation) {
  ParameterStddevs stddevs;
  stddevs.joints[0].linear = std::array<double, kJoints>{4.8e-5, 4.2e-4, 0.0};
  const msg::JointAxis joint = parametersToRos(scenarios::paperNominal(), stddevs).joints[0];
  EXPECT_EQ(joint.linear_stddev[1], 4.2e-4);
  EXPECT_TRUE(std::isinf(joint.linear_stddev[2]));
  EXPECT_TRUE(std::isinf(joint.harmonics_stddev[0]));
}

TEST(MsgConversion, NothingLooksIdentifiedThatIsNot) {
  const msg::ActuatorParameters message = parametersToRos(scenarios::paperNominal());
  for (const auto& joint : message.joints) {
    EXPECT_TRUE(std::isinf(joint.offset_stddev));
    EXPECT_TRUE(std::isinf(joint.axis_stddev[0]));
    EXPECT_TRUE(std::isinf(joint.axis_stddev[1]));
  }
  for (const auto& pole : message.poles) {
    EXPECT_TRUE(std::isinf(pole.polar_stddev));
    EXPECT_TRUE(std::isinf(pole.azimuth_stddev));
    EXPECT_TRUE(std::isinf(pole.gain_stddev));
  }
  for (const auto& coil : message.coils) {
    EXPECT_TRUE(std::isinf(coil.polar_stddev));
    EXPECT_TRUE(std::isinf(coil.azimuth_stddev));
    EXPECT_TRUE(std::isinf(coil.gain_stddev));
  }
}

TEST(MsgConversion, CoverageTellsWhetherItIsEnough) {
  const msg::Coverage few = coverageToRos({2, 3, false});
  EXPECT_EQ(few.samples, 2U);
  EXPECT_EQ(few.wanted, 3U);
  EXPECT_FALSE(few.seen_well);
  EXPECT_FALSE(few.identified);
  const msg::Coverage enough = coverageToRos({3, 3, false});
  EXPECT_TRUE(enough.seen_well);
  EXPECT_FALSE(enough.identified);
  const msg::Coverage identified = coverageToRos({2, 3, true});
  EXPECT_FALSE(identified.seen_well);
  EXPECT_TRUE(identified.identified);
}

TEST(MsgConversion, ReportsTellWhatIsNotObservable) {
  CycleReport report;
  report.cycle = Cycle::kPoles;
  report.coil = 2;
  report.success = true;
  report.message = "Done.";
  report.error_history = {2.0, 1.0};
  report.estimates = {{"pole_1/polar", 0.1, 0.2, 0.3, 1e-4, true, "rad"},
                      {"torque_bias/x", 0.1, 0.1, 0.1, 0.03, false, "N·m"}};
  report.residuals = {{9, Quantity::kTorque, 0.5, 6.0, true, "misfit"}};
  report.error_measure = ErrorMeasure::kTorque;
  const msg::CalibrationReport message = reportToRos(report, {Grade::kUsable, "Because."});
  EXPECT_EQ(message.grade, msg::CalibrationReport::USABLE);
  EXPECT_EQ(message.grade_reason, "Because.");
  EXPECT_EQ(message.error_unit, "N·m");
  EXPECT_EQ(message.cycle, msg::CalibrationReport::POLES);
  EXPECT_EQ(message.coil, 3U);
  EXPECT_TRUE(message.success);
  EXPECT_EQ(message.error_history, report.error_history);
  ASSERT_EQ(message.estimates.size(), 2U);
  EXPECT_EQ(message.estimates[0].value, 0.3);
  EXPECT_EQ(message.estimates[0].unit, "rad");
  EXPECT_EQ(message.estimates[1].unit, "N·m");
  EXPECT_EQ(message.estimates[0].stddev, 1e-4);
  EXPECT_TRUE(std::isinf(message.estimates[1].stddev));
  EXPECT_FALSE(message.estimates[1].observable);
  ASSERT_EQ(message.residuals.size(), 1U);
  EXPECT_EQ(message.residuals[0].id, 9U);
  EXPECT_EQ(message.residuals[0].unit, "N·m");
  EXPECT_TRUE(message.residuals[0].rejected);
  EXPECT_EQ(message.residuals[0].reason, "misfit");
}

TEST(MsgConversion, AValidationSucceedsOnlyWhereHeldOutSamplesAgree) {
  HeldOutValidation validation;
  validation.samples = 4;
  validation.residuals = {{1, Quantity::kOrientation, 0.5, 1.0, false, ""}};
  validation.probability = 0.5;
  const msg::CalibrationReport agrees = validationToRos(validation, {Grade::kGood, ""});
  EXPECT_TRUE(agrees.success);
  EXPECT_EQ(agrees.residuals.at(0).unit, "rad");
  validation.probability = 1e-6;
  EXPECT_FALSE(validationToRos(validation, {Grade::kContradicted, ""}).success);
  EXPECT_FALSE(validationToRos({}, {Grade::kNotValidated, ""}).success);
}

// The service has its own constants for the flaws that the core names.
TEST(MsgConversion, FlawsOfPlannedCapturesHaveTheNamesOfTheService) {
  using Response = msg::CapturePlannedResponse;
  EXPECT_EQ(flawName(CaptureFlaw::kOrientation), Response::ORIENTATION);
  EXPECT_EQ(flawName(CaptureFlaw::kCurrents), Response::CURRENTS);
  EXPECT_EQ(flawName(CaptureFlaw::kTorque), Response::TORQUE);
  EXPECT_EQ(flawName(CaptureFlaw::kPose), Response::POSE);
  EXPECT_EQ(flawName(CaptureFlaw::kRest), Response::REST);
}

}  // namespace
}  // namespace sac
