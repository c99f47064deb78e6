// What was identified is applied: a description that was saved predicts as the refinement did.
#include <cmath>

#include <gtest/gtest.h>

#include "calibration/reloaded_description.hpp"
#include "spherical_actuator_calibration/actuator/description_file.hpp"
#include "spherical_actuator_calibration/actuator/spherical_joint.hpp"
#include "spherical_actuator_calibration/actuator/torque_model.hpp"
#include "spherical_actuator_calibration/base/rotations.hpp"
#include "spherical_actuator_calibration/calibration/calibration_session.hpp"
#include "spherical_actuator_calibration/calibration/prediction.hpp"
#include "spherical_actuator_calibration/estimation/sample_prediction.hpp"
#include "spherical_actuator_calibration/measurement/sample_file.hpp"
#include "support/scenarios.hpp"
#include "support/source_dir.hpp"

namespace sac {
namespace {

constexpr char kActuator[] = SOURCE_DIR "/config/examples/two_axis_positioner/actuator.yaml";
constexpr char kSamples[] = SOURCE_DIR "/config/examples/two_axis_positioner/samples.yaml";

CalibrationConfig modelling(const std::vector<std::string>& effects, MapUse map) {
  CalibrationConfig config;
  for (const std::string& effect : effects) {
    config.effects[effect] = true;
  }
  config.orientation_map = map;
  return config;
}

/// What the session's model says of a sample.
Sample predicted(const CalibrationSession& session, Sample sample) {
  predictMeasurements({session.model(), session.state().belief.x}, sample);
  return sample;
}

double rmsError(const JointGeometry& joints, const std::vector<Sample>& samples) {
  double sum = 0.0;
  for (const Sample& sample : samples) {
    sum += rotationLog(sample.R_stator_rotor *
                       rotorOrientation(joints, sample.joint_position).transpose())
               .squaredNorm();
  }
  return std::sqrt(sum / static_cast<double>(samples.size()));
}

class SavedPositioner : public testing::TestWithParam<MapUse> {};

TEST_P(SavedPositioner, PredictsAsItsRefinementDid) {
  CalibrationConfig config = modelling({"tilt_cross_axis", "encoder_harmonics"}, GetParam());
  config.effects.setHarmonicJoints({0, 1});
  const std::vector<Sample> samples = loadSamples(kSamples, 0);
  CalibrationSession session({loadActuator(kActuator)}, samples, config);
  session.run({Cycle::kJoint});
  ASSERT_TRUE(session.run({Cycle::kRefine}).success);
  const CalibratedDescription saved = reloaded(session);
  EXPECT_EQ(saved.actuator.orientation_map != nullptr, GetParam() == MapUse::kAlways);
  const Predictor predictor(saved);
  for (const Sample& sample : samples) {
    const Eigen::Matrix3d refined = predicted(session, sample).R_stator_rotor;
    const Eigen::Vector3d& q = sample.joint_position;
    EXPECT_LT((rotorOrientation(jointGeometry(saved.actuator), q) - refined).norm(), 1e-9);
    EXPECT_LT((predictor.orientation(q).R_stator_rotor - refined).norm(), 1e-9);
  }
}

INSTANTIATE_TEST_SUITE_P(WithAndWithoutMap,
                         SavedPositioner,
                         testing::Values(MapUse::kAlways, MapUse::kNever));

TEST(AppliedEffects, AFurtherCalibrationStartsWhereTheLastOneEnded) {
  const CalibrationConfig config = modelling({"tilt_cross_axis"}, MapUse::kNever);
  CalibrationSession first({loadActuator(kActuator)}, loadSamples(kSamples, 0), config);
  first.run({Cycle::kJoint});
  const double ended = first.run({Cycle::kRefine}).error_history.back();
  CalibrationSession second(reloaded(first), loadSamples(kSamples, 0), config);
  const CycleReport& again = second.run({Cycle::kRefine});
  EXPECT_NEAR(again.error_history.front(), ended, 1e-9);
  EXPECT_NEAR(again.error_history.back(), ended, 1e-7);
}

/// The paper's session where the readings of joints are wrong by their correction.
std::vector<Sample> misreadSession(const Actuator& truth, std::uint64_t seed) {
  scenarios::Generator generator(seed);
  std::vector<Sample> samples =
      scenarios::paperSession(truth, scenarios::Tracker::kEveryPose, generator);
  const JointGeometry joints = jointGeometry(truth);
  const TorqueCurve curve(*truth.torque_curve);
  for (Sample& sample : samples) {
    const Eigen::Matrix3d R = rotorOrientation(joints, sample.joint_position);
    sample.R_stator_rotor = rotationExp(scenarios::uniformNoise(1e-3, generator)) * R;
    if (sample.has_torque) {
      sample.torque = rotorTorque(curve, torqueGeometry(truth), R, sample.current) +
                      scenarios::uniformNoise(5e-4, generator);
    }
  }
  return samples;
}

TEST(AppliedEffects, OfTorquesAsWell) {
  Actuator truth = scenarios::paperTruth();
  truth.joints[2].correction.harmonics = {1e-3, -5e-4, 3e-4, 2e-4};
  truth.poles[2].gain = 1.02;
  truth.torque_curve->coefficients[1] *= 1.01;
  const std::vector<Sample> samples = misreadSession(truth, 5);
  CalibrationConfig config =
      modelling({"encoder_harmonics", "pole_gains", "torque_curve"}, MapUse::kNever);
  config.effects.setHarmonicJoints({2});
  config.estimation.max_deviation = 10.0;
  CalibrationSession session({scenarios::paperNominal()}, samples, config);
  session.run({Cycle::kJoint});
  session.run({Cycle::kPoles, 0});
  const CycleReport report = session.run({Cycle::kRefine});
  ASSERT_TRUE(report.success) << report.message;
  const Predictor predictor(reloaded(session));
  for (const Sample& sample : samples) {
    if (sample.has_torque) {
      const Eigen::Vector3d refined = predicted(session, sample).torque;
      const Predictor::Torque found = predictor.torque(sample.joint_position, sample.current);
      EXPECT_LT((found.torque - refined).norm(), 1e-9);
      EXPECT_GT(found.stddev, 0.0);
    }
  }
}

TEST(AppliedEffects, OfTheWeightThatATorqueSensorFeels) {
  const Actuator truth = scenarios::paperTruth();
  const Eigen::Vector3d unbalance(3e-3, -2e-3, 4e-3);
  std::vector<Sample> samples = misreadSession(truth, 6);
  for (Sample& sample : samples) {
    const Eigen::Matrix3d R = rotorOrientation(jointGeometry(truth), sample.joint_position);
    sample.torque += unbalance.cross(Eigen::Vector3d(-R.row(2).transpose()));
  }
  CalibrationSession session(
      {scenarios::paperNominal()}, samples, modelling({"rotor_unbalance"}, MapUse::kNever));
  session.run({Cycle::kJoint});
  session.run({Cycle::kPoles, 0});
  const CycleReport report = session.run({Cycle::kRefine});
  ASSERT_TRUE(report.success) << report.message;
  const Predictor predictor(reloaded(session));
  double inside = 0.0;
  double count = 0.0;
  for (const Sample& sample : samples) {
    if (!sample.has_torque) {
      continue;
    }
    const Eigen::Vector3d refined = predicted(session, sample).torque;
    const Predictor::Torque loaded = predictor.loadedTorque(sample.joint_position, sample.current);
    EXPECT_LT((loaded.torque - refined).norm(), 1e-9);
    const Predictor::Torque none =
        predictor.loadedTorque(sample.joint_position, Eigen::VectorXd::Zero(24));
    const Eigen::Matrix3d R = rotorOrientation(jointGeometry(truth), sample.joint_position);
    const Eigen::Vector3d error =
        none.torque - unbalance.cross(Eigen::Vector3d(-R.row(2).transpose()));
    EXPECT_GT(none.stddev, 1e-6);
    EXPECT_LT(error.norm(), 5.0 * none.stddev);
    inside += static_cast<double>((error.array().abs() < 1.96 * none.stddev).count());
    count += 3.0;
    EXPECT_EQ(predictor.torque(sample.joint_position, Eigen::VectorXd::Zero(24)).stddev, 0.0);
  }
  EXPECT_GT(inside, 0.8 * count);
}

// Joints 1 and 2 move by ±0.6 rad only.
TEST(EncoderHarmonics, OfEveryJointAreFoundAsFarAsItsTravelTells) {
  Actuator truth = scenarios::paperTruth();
  truth.joints[0].correction.harmonics = {0.0, 0.0, 0.0, 2e-3};
  truth.joints[1].correction.harmonics = {0.0, 0.0, 3e-3, 0.0};
  truth.joints[2].correction.harmonics = {1e-3, -5e-4, 3e-4, 2e-4};
  scenarios::Generator generator(3);
  const std::vector<Eigen::Vector3d> poses = scenarios::randomPoses(120, 0.6, generator);
  std::vector<Sample> samples;
  for (const Eigen::Vector3d& q : poses) {
    Sample sample;
    sample.joint_position = q;
    sample.has_orientation = true;
    sample.R_stator_rotor = rotationExp(scenarios::uniformNoise(1e-4, generator)) *
                            rotorOrientation(jointGeometry(truth), q);
    sample.orientation_stddev = scenarios::uniformStddev(1e-4);
    samples.push_back(sample);
  }
  Actuator nominal = scenarios::paperNominal();
  nominal.poles.clear();
  nominal.coils.clear();
  nominal.torque_curve.reset();
  CalibrationSession session({nominal}, samples, modelling({"encoder_harmonics"}, MapUse::kNever));
  const CycleReport report = session.run({Cycle::kRefine});
  ASSERT_TRUE(report.success) << report.message;
  const Predictor predictor(reloaded(session));
  int inside = 0;
  constexpr int kPoses = 200;
  for (int n = 0; n < kPoses; ++n) {
    const Eigen::Vector3d q = scenarios::randomPose(0.6, generator);
    const Predictor::Orientation pose = predictor.orientation(q);
    const Eigen::Vector3d error =
        rotationLog(pose.R_stator_rotor * rotorOrientation(jointGeometry(truth), q).transpose());
    EXPECT_LT(error.norm(), 1.5e-4);
    inside += static_cast<int>((error.array().abs() < 1.96 * pose.stddev).count());
  }
  EXPECT_GT(inside, 0.85 * 3 * kPoses);
  const CalibratedDescription result = session.description(savedOrigin());
  EXPECT_NEAR(result.actuator.joints[2].correction.harmonics[0], 1e-3, 1e-4);
  // Over ±0.6 rad they look like each other: their own values stay uncertain, and say so.
  EXPECT_GT((*result.stddevs.joints[1].harmonics)[2], 3e-4);
  EXPECT_LT((*result.stddevs.joints[2].harmonics)[2], 1e-4);
}

TEST(OrientationMapChoice, TakesAMapThatPredictsWhatItHasNotSeen) {
  const std::vector<Sample> samples = loadSamples(kSamples, 0);
  CalibrationSession session({loadActuator(kActuator)}, samples, {});
  session.run({Cycle::kJoint});
  const OrientationMapChoice& choice = session.orientationMap();
  ASSERT_TRUE(choice.map) << choice.sentence;
  EXPECT_EQ(choice.record->regions, 8U);
  EXPECT_GT(choice.record->axes_rms, 0.9e-3);
  EXPECT_LT(choice.record->map_rms, 0.7e-3);
  EXPECT_GT(choice.record->inside, 0.88);
  EXPECT_LT(rmsError(jointGeometry(session.actuator()), samples), 0.45e-3);
}

TEST(OrientationMapChoice, HeldOutSamplesJudgeTheMapAsWell) {
  double rms[2] = {};
  for (const MapUse use : {MapUse::kNever, MapUse::kAuto}) {
    CalibrationConfig config = modelling({}, use);
    config.hold_out_every = 5;
    CalibrationSession session({loadActuator(kActuator)}, loadSamples(kSamples, 0), config);
    session.run({Cycle::kJoint});
    rms[use == MapUse::kAuto ? 1 : 0] = session.validation()->orientation_rms;
  }
  EXPECT_GT(rms[0], 0.65e-3);
  EXPECT_LT(rms[1], 0.55e-3);
}

TEST(OrientationMapChoice, TakesNoneWhereOnlyNoiseIsLeft) {
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    scenarios::Generator generator(seed);
    const Actuator truth = scenarios::paperTruth();
    const std::vector<Sample> samples = scenarios::orientationSamples(
        truth, scenarios::randomPoses(80, 0.4, generator), 1e-3, 5.8e-4, generator);
    CalibrationSession session({scenarios::paperNominal()}, samples, {});
    ASSERT_TRUE(session.run({Cycle::kJoint}).success);
    EXPECT_FALSE(session.orientationMap().map) << seed << session.orientationMap().sentence;
    EXPECT_FALSE(session.description(savedOrigin()).actuator.orientation_map);
  }
}

// Groups of poses that share an error: likely a map, but of no use where no group is.
TEST(OrientationMapChoice, TakesNoneThatTellsNeighboursOnly) {
  scenarios::Generator generator(4);
  const Actuator truth = scenarios::paperTruth();
  std::vector<Sample> samples;
  for (const Eigen::Vector3d& centre : scenarios::randomPoses(40, 0.4, generator)) {
    const Eigen::Vector3d shared = scenarios::uniformNoise(1e-3, generator);
    std::vector<Eigen::Vector3d> poses;
    for (int n = 0; n < 3; ++n) {
      poses.emplace_back(centre + scenarios::uniformNoise(5e-3, generator));
    }
    for (Sample& sample : scenarios::orientationSamples(truth, poses, 1e-4, 5e-4, generator)) {
      sample.R_stator_rotor = rotationExp(shared) * sample.R_stator_rotor;
      samples.push_back(sample);
    }
  }
  CalibrationSession session({scenarios::paperNominal()}, samples, {});
  ASSERT_TRUE(session.run({Cycle::kJoint}).success);
  const OrientationMapChoice& choice = session.orientationMap();
  EXPECT_FALSE(choice.map) << choice.sentence;
  ASSERT_TRUE(choice.record) << "it was to be judged by regions: " << choice.sentence;
  EXPECT_NE(choice.sentence.find("not taken"), std::string::npos) << choice.sentence;
}

TEST(OrientationMapChoice, FollowsTheConfiguration) {
  const std::vector<Sample> samples = loadSamples(kSamples, 0);
  CalibrationSession never({loadActuator(kActuator)}, samples, modelling({}, MapUse::kNever));
  never.run({Cycle::kJoint});
  EXPECT_FALSE(never.orientationMap().map);
  CalibrationSession before({loadActuator(kActuator)}, samples, {});
  EXPECT_FALSE(before.orientationMap().map) << "no cycle has run";
  const std::vector<Sample> few(samples.begin(), samples.begin() + 20);
  CalibrationSession always({loadActuator(kActuator)}, few, modelling({}, MapUse::kAlways));
  always.run({Cycle::kJoint});
  EXPECT_FALSE(always.orientationMap().map);
  EXPECT_NE(always.orientationMap().sentence.find("too few"), std::string::npos);
}

TEST(OrientationMapChoice, HalvesTheWorkspaceIntoRegionsOfNeighbours) {
  std::vector<Eigen::Vector3d> readings;
  for (int n = 0; n < 16; ++n) {
    const int row = n / 4;
    readings.emplace_back(0.01 * (n % 4), 1.0 * row, 0.0);
  }
  const std::vector<std::size_t> regions = regionsOf(readings, 2);
  for (std::size_t n = 0; n < readings.size(); ++n) {
    for (std::size_t m = 0; m < readings.size(); ++m) {
      const bool are_neighbours = (n % 4) / 2 == (m % 4) / 2 && n / 8 == m / 8;
      EXPECT_EQ(regions[n] == regions[m], are_neighbours) << n << " " << m;
    }
  }
}

/// So many points of the curve of an actuator, up to the end of its support.
TorqueCurveDescription tableOf(const Actuator& actuator, int points) {
  const TorqueCurve curve(*actuator.torque_curve);
  TorqueCurveDescription table = *actuator.torque_curve;
  table.coefficients.clear();
  for (int n = 0; n < points; ++n) {
    const double angle = table.support_end * n / (points - 1);
    table.table.angles.push_back(angle);
    table.table.torques.push_back(curve.value(angle * std::acos(-1.0) / 180.0));
  }
  return table;
}

TEST(TorqueTable, OfFortyPointsCalibratesAsItsPolynomialDoes) {
  scenarios::Generator generator(9);
  const std::vector<Sample> samples = scenarios::paperSession(
      scenarios::paperTruth(), scenarios::Tracker::kFirstTenPoses, generator);
  Actuator tabulated = scenarios::paperNominal();
  tabulated.torque_curve = tableOf(tabulated, 40);
  std::vector<std::vector<ParameterEstimate>> results;
  for (const Actuator& actuator : {scenarios::paperNominal(), tabulated}) {
    CalibrationSession session({actuator}, samples, {});
    session.run({Cycle::kJoint});
    session.run({Cycle::kPoles, 0});
    ASSERT_TRUE(session.run({Cycle::kRefine}).success);
    results.push_back(session.parameters());
  }
  for (std::size_t p = 0; p < results[0].size(); ++p) {
    EXPECT_NEAR(results[0][p].value, results[1][p].value, 0.1 * results[0][p].stddev)
        << results[0][p].name;
  }
}

// Where a table ends before the torque does, and samples go beyond, the curve is a guess.
TEST(TorqueTable, ThatEndsBeforeTheTorqueIsTold) {
  scenarios::Generator generator(9);
  const std::vector<Sample> samples = scenarios::paperSession(
      scenarios::paperTruth(), scenarios::Tracker::kFirstTenPoses, generator);
  const Actuator whole = scenarios::paperNominal();
  for (const double end : {29.0, whole.torque_curve->support_end}) {
    Actuator tabulated = whole;
    TorqueCurveDescription table = tableOf(whole, 40);
    while (table.table.angles.back() > end) {
      table.table.angles.pop_back();
      table.table.torques.pop_back();
    }
    table.blend_start = 0.0;
    table.support_begin = 0.0;
    completeFromTable(table);
    tabulated.torque_curve = table;
    CalibrationSession session({tabulated}, samples, {});
    session.run({Cycle::kJoint});
    session.run({Cycle::kPoles, 0});
    const CycleReport& report = session.run({Cycle::kRefine});
    ASSERT_TRUE(report.success) << report.message;
    std::string told;
    for (const std::string& doubt : report.doubts) {
      told += doubt;
    }
    const bool is_told =
        told.find("beyond the last point of torque_curve.table") != std::string::npos;
    EXPECT_EQ(is_told, end == 29.0) << end << ": " << told;
  }
}

TEST(TorqueTable, ItsStatedUncertaintyIsInThatOfTheParameters) {
  scenarios::Generator generator(9);
  const std::vector<Sample> samples = scenarios::paperSession(
      scenarios::paperTruth(), scenarios::Tracker::kFirstTenPoses, generator);
  Actuator stated = scenarios::paperNominal();
  stated.torque_curve = tableOf(stated, 40);
  const Actuator exact = stated;
  stated.torque_curve->table.stddevs.assign(40, 3e-3);
  std::vector<double> stddevs;
  for (const Actuator& actuator : {exact, stated}) {
    CalibrationSession session({actuator}, samples, {});
    session.run({Cycle::kJoint});
    session.run({Cycle::kPoles, 0});
    ASSERT_TRUE(session.run({Cycle::kRefine}).success);
    stddevs.push_back(
        session.parameters()[static_cast<std::size_t>(session.model().space().pole(3))].stddev);
  }
  EXPECT_GT(stddevs[1], 1.02 * stddevs[0]);
}

}  // namespace
}  // namespace sac
