// Each effect of a machine, alone and in pairs, in a session of orientations and torques: the saved
// description leaves the residuals that the refinement left, whoever applies it.
#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "calibration/reloaded_description.hpp"
#include "spherical_actuator_calibration/actuator/description_file.hpp"
#include "spherical_actuator_calibration/actuator/rotor_dynamics.hpp"
#include "spherical_actuator_calibration/actuator/spherical_joint.hpp"
#include "spherical_actuator_calibration/actuator/torque_model.hpp"
#include "spherical_actuator_calibration/base/pi.hpp"
#include "spherical_actuator_calibration/base/rotations.hpp"
#include "spherical_actuator_calibration/calibration/calibration_session.hpp"
#include "spherical_actuator_calibration/calibration/prediction.hpp"
#include "support/scenarios.hpp"

namespace sac {
namespace {

constexpr double kSame = 1e-9;  // [rad], [N·m]

/// An orientation map, or a torque law by points instead of the polynomial: no effects by name.
constexpr char kMap[] = "orientation_map";
constexpr char kTable[] = "table";

std::vector<std::string> machineEffects() {
  return {"tilt_cross_axis",
          "encoder_harmonics",
          "pole_gains",
          "coil_gains",
          "strength_scale",
          "torque_curve",
          "rotor_unbalance",
          kTable,
          kMap};
}

using Effects = std::vector<std::string>;

/// Many at once: those that all tell strength, and everything that a machine can have.
std::vector<Effects> manyTogether() {
  const std::vector<std::string> all = machineEffects();
  return {{"pole_gains", "coil_gains", "torque_curve"},
          {"pole_gains", "coil_gains", "torque_curve", kTable},
          {"pole_gains", "coil_gains", "strength_scale", "torque_curve"},
          {all.begin(), all.end()}};
}

std::vector<Effects> aloneAndInPairs() {
  std::vector<Effects> sets;
  const std::vector<std::string> all = machineEffects();
  for (std::size_t a = 0; a < all.size(); ++a) {
    sets.push_back({all[a]});
    for (std::size_t b = a + 1; b < all.size(); ++b) {
      sets.push_back({all[a], all[b]});
    }
  }
  return sets;
}

bool has(const Effects& effects, const std::string& effect) {
  return std::find(effects.begin(), effects.end(), effect) != effects.end();
}

/// Bends of 1.5 mrad, of the length of half a radian.
std::shared_ptr<const OrientationMap> bends() {
  OrientationMapDescription map;
  map.length = {0.5, 0.5, 0.5};
  map.amplitude = {1.5e-3, 1.5e-3, 1.5e-3};
  map.noise = {1e-4, 1e-4, 1e-4};
  scenarios::Generator generator(17);
  for (const Eigen::Vector3d& q : scenarios::randomPoses(40, 0.3, generator)) {
    map.readings.push_back(q);
    map.rotations.push_back(scenarios::uniformNoise(2.5e-3, generator));
  }
  return std::make_shared<const OrientationMap>(map);
}

/// The paper's unit with all of the effects, each of its usual size.
Actuator unitWith(const Effects& effects) {
  Actuator unit = scenarios::paperTruth();
  if (has(effects, "tilt_cross_axis")) {
    unit.joints[0].correction.linear = {2e-3, -3e-3, 0.0};
    unit.joints[1].correction.linear = {1e-3, 2e-3, 0.0};
  }
  if (has(effects, "encoder_harmonics")) {
    unit.joints[2].correction.harmonics = {2e-3, -1e-3, 5e-4, 3e-4};
  }
  if (has(effects, "pole_gains")) {
    unit.poles[2].gain = 1.02;
  }
  if (has(effects, "coil_gains")) {
    unit.coils[5].gain = 0.97;
  }
  if (has(effects, "strength_scale")) {
    for (CoilAxis& coil : unit.coils) {
      coil.gain *= 0.98;
    }
  }
  if (has(effects, "torque_curve")) {
    unit.torque_curve->coefficients[1] *= 1.01;
  }
  if (has(effects, "rotor_unbalance")) {
    unit.unbalance = {3e-3, -2e-3, 4e-3};
  }
  if (has(effects, kMap)) {
    unit.orientation_map = bends();
  }
  return unit;
}

Eigen::Vector3d torqueBy(const Actuator& unit, const Eigen::Matrix3d& R, const Sample& sample) {
  return rotorTorque(TorqueCurve(*unit.torque_curve), torqueGeometry(unit), R, sample.current) +
         unit.unbalance.cross(gravityDirection(R));
}

std::vector<Sample> sessionOf(const Actuator& unit) {
  scenarios::Generator generator(5);
  std::vector<Sample> samples =
      scenarios::paperSession(unit, scenarios::Tracker::kEveryPose, generator);
  for (Sample& sample : samples) {
    const Eigen::Matrix3d R = rotorOrientation(jointGeometry(unit), sample.joint_position);
    sample.R_stator_rotor = rotationExp(scenarios::uniformNoise(5e-4, generator)) * R;
    if (sample.has_torque) {
      sample.torque = torqueBy(unit, R, sample) + scenarios::uniformNoise(5e-4, generator);
    }
  }
  return samples;
}

/// The torque law of a description as 40 points.
TorqueCurveDescription tabulated(const TorqueCurveDescription& polynomial) {
  constexpr int kPoints = 40;
  const TorqueCurve curve(polynomial);
  TorqueCurveDescription table = polynomial;
  table.coefficients.clear();
  for (int n = 0; n < kPoints; ++n) {
    const double angle = table.support_end * n / (kPoints - 1);
    table.table.angles.push_back(angle);
    table.table.torques.push_back(curve.value(angle * kPi / 180.0));
  }
  return table;
}

CalibrationSession refined(const Effects& effects) {
  Actuator drawn = scenarios::paperNominal();
  CalibrationConfig config;
  for (const std::string& effect : effects) {
    if (effect == kTable) {
      drawn.torque_curve = tabulated(*drawn.torque_curve);
    } else if (effect != kMap) {
      config.effects[effect] = true;
    }
  }
  config.orientation_map = has(effects, kMap) ? MapUse::kAlways : MapUse::kNever;
  CalibrationSession session({drawn}, sessionOf(unitWith(effects)), config);
  session.run({Cycle::kJoint});
  session.run({Cycle::kPoles, 0});
  session.run({Cycle::kRefine});
  return session;
}

class SavedEffects : public testing::TestWithParam<Effects> {};

TEST_P(SavedEffects, LeaveTheResidualsOfTheRefinement) {
  const CalibrationSession session = refined(GetParam());
  const CycleReport& report = session.reports().back();
  ASSERT_TRUE(report.success) << report.message;
  for (const ParameterEstimate& estimate : report.estimates) {
    EXPECT_TRUE(estimate.observable) << estimate.name;
  }
  const CalibratedDescription saved = reloaded(session);
  const CalibrationSession again(saved, {}, session.config());
  const Eigen::MatrixXd& known = session.state().belief.covariance;
  ASSERT_EQ(again.state().belief.covariance.rows(), known.rows());
  EXPECT_LT((again.state().belief.covariance - known).norm(), 1e-7 * known.norm());
  EXPECT_EQ(saved.actuator.orientation_map != nullptr, has(GetParam(), kMap));
  const Predictor predictor(saved);
  const JointGeometry joints = jointGeometry(saved.actuator);
  for (const SampleResidual& residual : report.residuals) {
    const Sample& sample = session.samples()[residual.id - 1];
    const Eigen::Matrix3d R = rotorOrientation(joints, sample.joint_position);
    if (residual.quantity == Quantity::kOrientation) {
      EXPECT_NEAR(
          rotationLog(sample.R_stator_rotor * R.transpose()).norm(), residual.residual, kSame);
      const Eigen::Matrix3d told = predictor.orientation(sample.joint_position).R_stator_rotor;
      EXPECT_LT((told - R).norm(), kSame);
    } else {
      const Eigen::Vector3d torque = torqueBy(saved.actuator, R, sample);
      EXPECT_NEAR((sample.torque - torque).norm(), residual.residual, kSame);
      const Eigen::Vector3d told =
          predictor.loadedTorque(sample.joint_position, sample.current).torque;
      EXPECT_LT((told - torque).norm(), kSame);
    }
  }
}

// What is taken up again is in force as it was: parameters come with the map of their samples.
class SavedMap : public testing::TestWithParam<Effects> {};

TEST_P(SavedMap, IsInForceAgainWhereASessionIsTakenUp) {
  const CalibrationSession session = refined(GetParam());
  std::vector<Sample> samples = session.samples();
  samples.push_back(samples.front());
  samples.back().id = static_cast<std::uint32_t>(samples.size());
  samples.back().R_stator_rotor = rotationExp({2e-3, 0.0, 0.0}) * samples.back().R_stator_rotor;
  const CalibrationSession again(
      session.start(), samples, session.config(), session.state(), session.reports());
  for (const Sample& sample : session.samples()) {
    const Eigen::Matrix3d before =
        rotorOrientation(jointGeometry(session.actuator()), sample.joint_position);
    const Eigen::Matrix3d after =
        rotorOrientation(jointGeometry(again.actuator()), sample.joint_position);
    EXPECT_LT((after - before).norm(), kSame);
  }
}

std::string nameOf(const testing::TestParamInfo<Effects>& info) {
  std::string name;
  for (const std::string& effect : info.param) {
    name += (name.empty() ? "" : "_and_") + effect;
  }
  return name;
}

INSTANTIATE_TEST_SUITE_P(AloneAndInPairs,
                         SavedEffects,
                         testing::ValuesIn(aloneAndInPairs()),
                         nameOf);

INSTANTIATE_TEST_SUITE_P(ManyTogether, SavedEffects, testing::ValuesIn(manyTogether()), nameOf);

std::vector<Effects> withAMap() {
  std::vector<Effects> sets;
  for (const Effects& effects : aloneAndInPairs()) {
    if (has(effects, kMap)) {
      sets.push_back(effects);
    }
  }
  return sets;
}

INSTANTIATE_TEST_SUITE_P(AloneAndInPairs, SavedMap, testing::ValuesIn(withAMap()), nameOf);

}  // namespace
}  // namespace sac
