#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "spherical_actuator_calibration/base/error.hpp"
#include "spherical_actuator_calibration/calibration/calibration_session.hpp"
#include "spherical_actuator_calibration/calibration/cycle_selection.hpp"
#include "spherical_actuator_calibration/calibration/frame_registration.hpp"
#include "spherical_actuator_calibration/calibration/prediction.hpp"
#include "spherical_actuator_calibration/calibration/sample_counts.hpp"
#include "support/error_message.hpp"
#include "support/scenarios.hpp"

namespace sac {
namespace {

constexpr double kNone = 1e-12;

std::string cyclesOf(const CalibrationSession& session) {
  std::string text;
  for (const CycleRequest& request :
       possibleCycles(session.model(), session.samples(), session.config().estimation)) {
    text += (text.empty() || request.cycle != Cycle::kCoil ? cycleText(request) : "") + " ";
  }
  return text;
}

/// A unit of the reaction sphere and a session with it.
class LevitatedRotor : public ::testing::Test {
 protected:
  CalibrationSession session(double orientation, double torque) {
    return {{nominal_},
            scenarios::levitatedSession(truth_, 40, 9, orientation, torque, generator_),
            {}};
  }

  scenarios::Generator generator_{21};
  Actuator nominal_ = scenarios::reactionSphere();
  Actuator truth_ = scenarios::perturbed(nominal_, 0.0, 0.02, generator_);
};

TEST_F(LevitatedRotor, IsFoundExactlyWithoutNoise) {
  CalibrationSession session = this->session(0.0, 0.0);
  EXPECT_EQ(session.run({Cycle::kRefine}).message.substr(0, 25), "All parameters calibrated");
  const ParameterSpace& space = session.model().space();
  EXPECT_LT((session.state().belief.x - space.coordinatesOf(truth_)).cwiseAbs().maxCoeff(), 1e-9);
  EXPECT_TRUE(session.isComplete());
}

TEST_F(LevitatedRotor, NoiseOfTheTrackerIsWithinTheStatedUncertainty) {
  CalibrationSession session = this->session(1e-3, 3e-4);
  const CycleReport& report = session.run({Cycle::kRefine});
  ASSERT_TRUE(report.success) << report.message;
  EXPECT_NEAR(report.reduced_chi_square, 1.0, 0.2);
  // Of each torque three values, less 56 parameters; the orientations are no observations.
  EXPECT_EQ(report.degrees_of_freedom, 3 * 360 - 56);
  const ParameterBelief& belief = session.state().belief;
  const Eigen::VectorXd apart =
      (belief.x - session.model().space().coordinatesOf(truth_)).cwiseAbs();
  const Eigen::VectorXd stddevs = belief.covariance.diagonal().cwiseSqrt();
  EXPECT_LT((apart.array() / stddevs.array()).maxCoeff(), 4.0);
  EXPECT_NEAR(std::sqrt((apart.array() / stddevs.array()).square().mean()), 1.0, 0.3);
}

TEST_F(LevitatedRotor, SamplesOfAPoseShareTheErrorOfItsOrientation) {
  CalibrationSession shared = session(1e-3, 3e-4);
  CalibrationConfig config = shared.config();
  config.estimation.shared_errors = false;
  CalibrationSession independent({nominal_}, shared.samples(), config);
  shared.run({Cycle::kRefine});
  independent.run({Cycle::kRefine});
  EXPECT_LT(shared.state().belief.covariance.trace(),
            0.8 * independent.state().belief.covariance.trace());
}

TEST_F(LevitatedRotor, HasNoLevelOne) {
  CalibrationSession session = this->session(1e-4, 3e-4);
  EXPECT_EQ(cyclesOf(session).substr(0, 6), "poles:");
  const CycleReport& report = session.run({Cycle::kJoint});
  EXPECT_FALSE(report.success);
  EXPECT_EQ(report.message.substr(0, 31), "The description has no joints: ");
  EXPECT_EQ(session.run({Cycle::kMotion}).message.substr(0, 31), "The description has no joints: ");
  EXPECT_EQ(errorMessage<ConfigError>([&] { registerFrames({nominal_}, {}, {}); }).substr(0, 34),
            "joints: the description has none, ");
}

TEST_F(LevitatedRotor, NothingOfJointsIsReported) {
  CalibrationSession session = this->session(1e-4, 3e-4);
  session.run({Cycle::kRefine});
  for (const ParameterEstimate& estimate : session.parameters()) {
    EXPECT_EQ(estimate.name.find("joint"), std::string::npos) << estimate.name;
  }
  const CalibratedDescription description = session.description({"2024-05-31T12:00:00Z", {}, "0"});
  EXPECT_FALSE(description.calibration->orientation_uncertainty.has_value());
  EXPECT_GT(description.calibration->torque_uncertainty.value_or(0.0), kNone);
  const std::string text = renderDescription(description, "f.yaml");
  EXPECT_NE(text.find("joints: []"), std::string::npos);
  for (const char* word : {"joint_", "rotation_", "offset"}) {
    EXPECT_EQ(text.find(word), std::string::npos) << word;
  }
}

TEST_F(LevitatedRotor, AFewPosesOfSingleCoilsAreEnoughToRefine) {
  const auto next = [&](std::size_t poses, std::size_t coils_per_pose) {
    const CalibrationSession session(
        {nominal_},
        scenarios::levitatedSession(truth_, poses, coils_per_pose, 0.0, 0.0, generator_),
        {});
    return nextCycles(session.model(), SampleCounts(session.model(), {}, session.samples()));
  };
  EXPECT_TRUE(next(2, 6).empty());
  const std::vector<CycleRequest> cycles = next(3, 6);
  ASSERT_EQ(cycles.size(), 1U);
  EXPECT_EQ(cycles.front().cycle, Cycle::kRefine);
}

TEST_F(LevitatedRotor, ASampleWithoutOrientationIsRefused) {
  Sample sample = scenarios::levitatedSession(truth_, 1, 1, 0.0, 1e-3, generator_).front();
  sample.has_orientation = false;
  EXPECT_EQ(errorMessage<DataError>([&] { CalibrationSession({nominal_}, {sample}, {}); }),
            "Sample 1: it has no orientation, which alone tells where a rotor without joints is.");
}

TEST_F(LevitatedRotor, TorquesAreToldAtTheOrientationOfTheTracker) {
  const std::vector<Sample> samples =
      scenarios::levitatedSession(truth_, 3, 2, 0.0, 0.0, generator_);
  const Predictor predictor({truth_});
  for (const Sample& sample : samples) {
    const Sample tracked = trackedSample(sample, 0.0);
    const Predictor::Torque torque = predictor.torque(tracked.joint_position, sample.current);
    EXPECT_LT((torque.torque - sample.torque).norm(), 1e-14);
    EXPECT_LT((predictor.orientation(tracked.joint_position).R_stator_rotor - sample.R_stator_rotor)
                  .norm(),
              1e-14);
  }
}

/// Registrations turn all coils, or all poles, together: what is stated of them stays in those.
TEST_F(LevitatedRotor, StatedRegistrationsAreInTheUncertainty) {
  CalibrationSession exact = session(1e-4, 3e-4);
  CalibrationConfig config = exact.config();
  stateRegistration(config, {1e-3, 0.0, 0.0});
  CalibrationSession stated({nominal_}, exact.samples(), config);
  exact.run({Cycle::kRefine});
  ASSERT_TRUE(stated.run({Cycle::kRefine}).success) << stated.reports().back().message;
  const Eigen::Index coil = exact.model().space().coil(0);
  EXPECT_LT(std::sqrt(exact.state().belief.covariance(coil, coil)), 5e-4);
  EXPECT_NEAR(std::sqrt(stated.state().belief.covariance(coil, coil)), 1e-3, 2e-4);
}

}  // namespace
}  // namespace sac
