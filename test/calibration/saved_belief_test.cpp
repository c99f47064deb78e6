// What a saved description knows together, it knows together when it is read again.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "calibration/reloaded_description.hpp"
#include "covariance_record.hpp"
#include "spherical_actuator_calibration/actuator/description_file.hpp"
#include "spherical_actuator_calibration/actuator/rotor_dynamics.hpp"
#include "spherical_actuator_calibration/actuator/spherical_joint.hpp"
#include "spherical_actuator_calibration/actuator/torque_model.hpp"
#include "spherical_actuator_calibration/base/error.hpp"
#include "spherical_actuator_calibration/base/rotations.hpp"
#include "spherical_actuator_calibration/calibration/calibration_session.hpp"
#include "spherical_actuator_calibration/calibration/held_out_judge.hpp"
#include "support/scenarios.hpp"

namespace sac {
namespace {

CalibrationConfig modelling(const std::string& effect) {
  CalibrationConfig config;
  config.effects[effect] = true;
  config.orientation_map = MapUse::kNever;
  return config;
}

Actuator unitWith(const std::string& effect) {
  Actuator unit = scenarios::paperTruth();
  if (effect == "encoder_harmonics") {
    unit.joints[0].correction.harmonics = {0.0, 0.0, 1e-3, 2e-3};
    unit.joints[2].correction.harmonics = {2e-3, -1e-3, 5e-4, 3e-4};
  }
  if (effect == "rotor_unbalance") {
    unit.unbalance = {3e-3, -2e-3, 4e-3};
  }
  return unit;
}

/// Of the unit, its weight in the torques.
std::vector<Sample> sessionOf(const Actuator& unit, std::uint64_t seed) {
  scenarios::Generator generator(seed);
  std::vector<Sample> samples =
      scenarios::paperSession(unit, scenarios::Tracker::kEveryPose, generator);
  const JointGeometry joints = jointGeometry(unit);
  for (Sample& sample : samples) {
    const Eigen::Matrix3d R = rotorOrientation(joints, sample.joint_position);
    sample.R_stator_rotor = rotationExp(scenarios::uniformNoise(5e-4, generator)) * R;
    if (sample.has_torque) {
      sample.torque =
          rotorTorque(TorqueCurve(*unit.torque_curve), torqueGeometry(unit), R, sample.current) +
          unit.unbalance.cross(gravityDirection(R)) + scenarios::uniformNoise(5e-4, generator);
    }
  }
  return samples;
}

CalibrationSession refined(const std::string& effect) {
  CalibrationSession session(
      {scenarios::paperNominal()}, sessionOf(unitWith(effect), 5), modelling(effect));
  session.run({Cycle::kJoint});
  session.run({Cycle::kPoles, 0});
  session.run({Cycle::kRefine});
  return session;
}

std::vector<Sample> heldOut(const Actuator& unit) {
  std::vector<Sample> samples = sessionOf(unit, 6);
  for (Sample& sample : samples) {
    sample.validation = true;
  }
  return samples;
}

HeldOutValidation validated(const CalibrationSession& session, const std::vector<Sample>& samples) {
  return validateHeldOut(session.model(), samples, session.state(), session.config().estimation);
}

/// Mean standard deviation of orientations that are measured next [rad].
double expectedStddev(const CalibrationSession& session, const Actuator& unit) {
  double sum = 0.0;
  int count = 0;
  for (const SampleResidual& residual : validated(session, heldOut(unit)).residuals) {
    if (residual.quantity == Quantity::kOrientation) {
      sum += residual.residual / residual.standardized / std::sqrt(3.0);
      ++count;
    }
  }
  return sum / count;
}

constexpr char kHarmonics[] = "encoder_harmonics";

// Over ±0.3 rad harmonics and an offset look alike: each is known to some mrad, both together to
// some hundredths.
TEST(SavedBelief, IsAsCertainOfOrientationsAsItsRefinementWas) {
  const CalibrationSession session = refined(kHarmonics);
  ASSERT_TRUE(session.reports().back().success) << session.reports().back().message;
  const CalibrationSession again(reloaded(session), {}, modelling(kHarmonics));
  const Actuator unit = unitWith(kHarmonics);
  EXPECT_NEAR(expectedStddev(again, unit) / expectedStddev(session, unit), 1.0, 1e-3);
}

TEST(SavedBelief, TakesEffectsThatAreNotModelledAnyMoreForExact) {
  const CalibrationSession session = refined(kHarmonics);
  const CalibrationSession again(reloaded(session), {}, modelling("strength_scale"));
  const Actuator unit = unitWith(kHarmonics);
  const double share = expectedStddev(again, unit) / expectedStddev(session, unit);
  EXPECT_GT(share, 0.9);
  EXPECT_LT(share, 1.0);
}

TEST(SavedBelief, IsLessCertainWhereMoreIsModelled) {
  const CalibrationSession session = refined("strength_scale");
  const CalibrationSession again(reloaded(session), {}, modelling(kHarmonics));
  const Actuator unit = unitWith("strength_scale");
  EXPECT_GT(expectedStddev(again, unit), 3.0 * expectedStddev(session, unit));
}

TEST(SavedBelief, HeldOutSamplesTellAJointThatSlipped) {
  const CalibratedDescription saved = reloaded(refined(kHarmonics));
  Actuator slipped = unitWith(kHarmonics);
  slipped.joints[2].offset += 1e-3;
  const CalibrationSession again(saved, {}, modelling(kHarmonics));
  EXPECT_GT(validated(again, heldOut(unitWith(kHarmonics))).probability, kLeastProbability);
  EXPECT_LT(validated(again, heldOut(slipped)).probability, kLeastProbability);
}

// Before one pole was the reference of strength beside the curve, it had a gain that nobody told.
TEST(SavedBelief, OfAnEarlierReleaseIsReadWithoutWhatIsAReferenceNow) {
  CalibrationConfig config = modelling("pole_gains");
  config.effects["torque_curve"] = true;
  const CalibrationSession session({scenarios::paperNominal()}, {}, config);
  CalibratedDescription saved = session.description({"2024-05-31T12:00:00Z", {}, "0.1.0"});
  CovarianceRecord& record = saved.calibration->covariance.emplace(
      covarianceRecord(session.model().space(), session.state().belief));
  const auto next = std::find(record.names.begin(), record.names.end(), "pole_2/gain");
  ASSERT_NE(next, record.names.end());
  const auto place = static_cast<std::size_t>(next - record.names.begin());
  const CovarianceRecord whole = record;
  record.names.insert(next, "pole_1/gain");
  record.lower.clear();
  for (std::size_t a = 0, row = 0; a < record.names.size(); ++a) {
    std::size_t column = 0;
    for (std::size_t b = 0; b <= a; ++b) {
      const bool is_new = a == place || b == place;
      record.lower.push_back(is_new ? 7.0 : whole.lower[row * (row + 1) / 2 + column]);
      column += b == place ? 0 : 1;
    }
    row += a == place ? 0 : 1;
  }
  const CalibrationSession again(saved, {}, config);
  const Eigen::MatrixXd& known = session.state().belief.covariance;
  ASSERT_EQ(again.state().belief.covariance.rows(), known.rows());
  EXPECT_LT((again.state().belief.covariance - known).norm(), 1e-7 * known.norm());
  record.names[place] = "pole_9/gain";
  EXPECT_THROW(CalibrationSession(saved, {}, config), ConfigError);
}

TEST(SavedBelief, StartsWithTheWeightThatATorqueSensorFeels) {
  const CalibrationSession session = refined("rotor_unbalance");
  const CycleReport& ended = session.reports().back();
  ASSERT_TRUE(ended.success) << ended.message;
  CalibrationSession again(reloaded(session), session.samples(), modelling("rotor_unbalance"));
  EXPECT_LT((again.actuator().unbalance - session.actuator().unbalance).norm(), 1e-15);
  const CycleReport& report = again.run({Cycle::kRefine});
  EXPECT_NEAR(report.error_history.front(), ended.error_history.back(), 1e-6);
  EXPECT_NEAR(report.error_history.back(), ended.error_history.back(), 1e-6);
}

}  // namespace
}  // namespace sac
