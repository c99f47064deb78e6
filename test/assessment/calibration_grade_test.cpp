#include "spherical_actuator_calibration/assessment/calibration_grade.hpp"

#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "spherical_actuator_calibration/actuator/description_file.hpp"
#include "spherical_actuator_calibration/actuator/spherical_joint.hpp"
#include "spherical_actuator_calibration/actuator/torque_model.hpp"
#include "spherical_actuator_calibration/base/rotations.hpp"
#include "support/scenarios.hpp"

namespace sac {
namespace {

std::vector<CycleRequest> wholeCalibration() {
  return {{Cycle::kJoint}, {Cycle::kRefine}};
}

CalibrationConfig registered() {
  CalibrationConfig config;
  stateRegistration(config, {0.0, 0.0, 0.0});
  return config;
}

GradedCalibration gradeOf(const std::vector<Sample>& samples,
                          const std::vector<CycleRequest>& requests,
                          const CalibrationConfig& config = registered()) {
  CalibrationSession session({scenarios::paperNominal()}, samples, config);
  for (const CycleRequest& request : requests) {
    session.run(request);
  }
  return gradeCalibration(session);
}

bool tells(const GradedCalibration& graded, const std::string& words) {
  return graded.reason.find(words) != std::string::npos;
}

TEST(CalibrationGrade, HasOneNamePerGrade) {
  EXPECT_EQ(gradeName(Grade::kGood), "good");
  EXPECT_EQ(gradeName(Grade::kUsable), "usable");
  EXPECT_EQ(gradeName(Grade::kNotValidated), "not_validated");
  EXPECT_EQ(gradeName(Grade::kContradicted), "contradicted");
  EXPECT_EQ(gradeName(Grade::kFailed), "failed");
}

TEST(CalibrationGrade, OnlyWhatNothingContradictsIsSound) {
  EXPECT_TRUE(isSound(Grade::kGood));
  EXPECT_TRUE(isSound(Grade::kUsable));
  EXPECT_TRUE(isSound(Grade::kNotValidated));
  EXPECT_FALSE(isSound(Grade::kContradicted));
  EXPECT_FALSE(isSound(Grade::kFailed));
}

TEST(CalibrationGrade, GoodNeedsEveryParameterAndHeldOutSamplesThatAgree) {
  const GradedCalibration graded = gradeOf(scenarios::heldOutSession(), wholeCalibration());
  EXPECT_EQ(graded.grade, Grade::kGood) << graded.reason;
  EXPECT_TRUE(tells(graded, "all 73 parameters are identified")) << graded.reason;
}

TEST(CalibrationGrade, NothingIsGoodThatWasNotJudged) {
  std::vector<Sample> samples = scenarios::heldOutSession();
  for (Sample& sample : samples) {
    sample.validation = false;
  }
  const GradedCalibration graded = gradeOf(samples, wholeCalibration());
  EXPECT_EQ(graded.grade, Grade::kNotValidated);
  EXPECT_TRUE(tells(graded, "no held-out sample judges them")) << graded.reason;
}

TEST(CalibrationGrade, OrientationsAloneDoNotJudgePolesAndCoils) {
  std::vector<Sample> samples = scenarios::heldOutSession();
  for (Sample& sample : samples) {
    sample.has_torque = sample.has_torque && !sample.validation;
  }
  const GradedCalibration graded = gradeOf(samples, wholeCalibration());
  EXPECT_EQ(graded.grade, Grade::kNotValidated);
  EXPECT_TRUE(tells(graded, "no held-out torque judges poles and coils")) << graded.reason;
}

/// The held-out torques are of coils that no pole is near, with such a torque each.
std::vector<Sample> withBlindTorques(std::vector<Sample> samples, const Eigen::Vector3d& torque) {
  const Actuator truth = scenarios::paperTruth();
  const TorqueCurve curve(*truth.torque_curve);
  scenarios::Generator generator(3);
  for (Sample& sample : samples) {
    if (!sample.validation || !sample.has_torque) {
      continue;
    }
    Eigen::Index coil = 0;
    double least = 1.0;
    while (least > 0.0) {
      sample.joint_position = scenarios::randomPoses(1, 0.3, generator).front();
      least = torquePerAmpere(curve,
                              torqueGeometry(truth),
                              rotorOrientation(jointGeometry(truth), sample.joint_position))
                  .colwise()
                  .norm()
                  .minCoeff(&coil);
    }
    sample.has_orientation = false;
    sample.current = 2.0 * Eigen::VectorXd::Unit(sample.current.size(), coil);
    sample.torque = torque;
  }
  return samples;
}

// They are the same wherever axes are.
TEST(CalibrationGrade, TorquesWhereNoPoleIsNearDoNotJudgePolesAndCoils) {
  const std::vector<Sample> blind =
      withBlindTorques(scenarios::heldOutSession(), {1e-4, -2e-4, 1e-4});
  const GradedCalibration graded = gradeOf(blind, wholeCalibration());
  EXPECT_EQ(graded.grade, Grade::kNotValidated) << graded.reason;
  EXPECT_TRUE(tells(graded, "no held-out torque judges poles and coils")) << graded.reason;
  // Two coils whose wires are exchanged show there, too.
  const std::vector<Sample> exchanged =
      withBlindTorques(scenarios::heldOutSession(), {0.1, 0.0, 0.0});
  EXPECT_EQ(gradeOf(exchanged, wholeCalibration()).grade, Grade::kContradicted);
}

TEST(CalibrationGrade, IsLostWhereTheNewestHeldOutSamplesContradict) {
  constexpr double kNoise = 1e-3;  // [rad]
  scenarios::Generator generator(5);
  std::vector<Sample> samples =
      scenarios::orientationSamples(scenarios::paperTruth(),
                                    scenarios::randomPoses(190, 0.3, generator),
                                    kNoise,
                                    scenarios::uniformStddev(kNoise),
                                    generator);
  for (std::size_t n = 40; n < samples.size(); ++n) {
    samples[n].validation = true;
  }
  EXPECT_NE(gradeOf(samples, {{Cycle::kJoint}}).grade, Grade::kContradicted);
  // The tracker was touched lately: too little to show among all 150.
  for (std::size_t n = samples.size() - 24; n < samples.size(); ++n) {
    samples[n].R_stator_rotor = rotationExp({1e-3, 0.0, 0.0}) * samples[n].R_stator_rotor;
  }
  CalibrationSession session({scenarios::paperNominal()}, samples, registered());
  ASSERT_TRUE(session.run({Cycle::kJoint}).success);
  const GradedCalibration graded = gradeCalibration(session);
  EXPECT_EQ(graded.grade, Grade::kContradicted) << graded.reason;
  EXPECT_TRUE(tells(graded, "newest held-out samples contradict")) << graded.reason;
  // The file that is kept says it, too.
  const CalibrationOrigin origin = {"2026-11-28T12:00:00Z", {}, "test"};
  EXPECT_TRUE(isContradicted(gradedDescription(session, origin, graded)));
  EXPECT_FALSE(isContradicted(session.description(origin)));
}

TEST(CalibrationGrade, UsableWherePartsAreMissing) {
  const GradedCalibration graded = gradeOf(scenarios::heldOutSession(), {{Cycle::kJoint}});
  EXPECT_EQ(graded.grade, Grade::kUsable);
  EXPECT_TRUE(tells(graded, "9 of 73 parameters are identified")) << graded.reason;
}

TEST(CalibrationGrade, TellsADoubtBesideWhatIsOpen) {
  std::vector<Sample> samples = scenarios::heldOutSession();
  std::size_t n = 0;
  for (Sample& sample : samples) {
    if (sample.has_orientation && !sample.validation && ++n % 3 == 0) {
      sample.R_stator_rotor = rotationExp({0.0, 0.2, 0.0}) * sample.R_stator_rotor;
    }
  }
  CalibrationConfig config = registered();
  config.estimation.max_rejected_fraction = 0.45;
  const GradedCalibration graded = gradeOf(samples, {{Cycle::kJoint}}, config);
  EXPECT_EQ(graded.grade, Grade::kUsable);
  EXPECT_TRUE(tells(graded, "9 of 73 parameters are identified, the others are not, but "))
      << graded.reason;
  EXPECT_TRUE(tells(graded, "were left out as outliers")) << graded.reason;
}

TEST(CalibrationGrade, UsableWhereTheWantedAccuracyIsMissed) {
  CalibrationConfig config = registered();
  config.wanted.orientation = 1e-7;
  const GradedCalibration one = gradeOf(scenarios::heldOutSession(), wholeCalibration(), config);
  EXPECT_EQ(one.grade, Grade::kUsable);
  EXPECT_TRUE(tells(one, "above the wanted 0.0001 mrad")) << one.reason;
  config.wanted = {1.0, 1e-9};
  EXPECT_EQ(gradeOf(scenarios::heldOutSession(), wholeCalibration(), config).grade, Grade::kUsable);
  config.wanted = {1.0, 1.0};
  EXPECT_EQ(gradeOf(scenarios::heldOutSession(), wholeCalibration(), config).grade, Grade::kGood);
}

TEST(CalibrationGrade, ContradictedWhereHeldOutSamplesDisagree) {
  std::vector<Sample> samples = scenarios::heldOutSession();
  for (Sample& sample : samples) {
    if (sample.validation) {
      sample.R_stator_rotor = rotationExp({0.01, 0.0, 0.0}) * sample.R_stator_rotor;
    }
  }
  EXPECT_EQ(gradeOf(samples, wholeCalibration()).grade, Grade::kContradicted);
}

// A file that was written all the same tells it to who begins with it.
TEST(CalibrationGrade, ContradictedWhereTheDescriptionWasWhenItWasMade) {
  std::vector<Sample> samples = scenarios::heldOutSession();
  for (Sample& sample : samples) {
    sample.torque *= sample.validation ? 1.1 : 1.0;
  }
  CalibrationSession made({scenarios::paperNominal()}, samples, registered());
  ASSERT_TRUE(made.run({Cycle::kRefine}).success);
  const CalibratedDescription written = parseDescription(
      renderDescription(made.description({"2026-11-28T12:00:00Z", {}, "test"}), "f.yaml"),
      "f.yaml");
  EXPECT_TRUE(isContradicted(written));
  CalibrationSession begun(written, {}, registered());
  EXPECT_EQ(gradeCalibration(begun).grade, Grade::kContradicted);
  EXPECT_TRUE(tells(gradeCalibration(begun), "when its description was made"))
      << gradeCalibration(begun).reason;
  EXPECT_TRUE(isContradicted(begun.description({"2026-11-28T12:00:00Z", {}, "test"})));
  // Who judges it anew, or calibrates anew, decides.
  for (const Sample& sample : scenarios::heldOutSession()) {
    begun.add(sample);
  }
  EXPECT_EQ(gradeCalibration(begun).grade, Grade::kGood) << gradeCalibration(begun).reason;
}

// Of a turned marker, too, so that joints and poles would be wrong by as much.
TEST(CalibrationGrade, UsableWhereARegistrationIsFoundElsewhereThatAnotherWouldExplain) {
  std::vector<Sample> samples = scenarios::heldOutSession();
  for (Sample& sample : samples) {
    sample.R_stator_rotor = sample.R_stator_rotor * rotationExp({0.02, -0.02, 0.02});
  }
  CalibrationConfig config = registered();
  for (const char* effect : {"torque_registration", "marker_registration"}) {
    config.effects = {};
    config.effects[effect] = true;
    const GradedCalibration graded = gradeOf(samples, wholeCalibration(), config);
    EXPECT_EQ(graded.grade, Grade::kUsable) << graded.reason;
    EXPECT_TRUE(tells(graded, "which of both registrations")) << graded.reason;
    EXPECT_EQ(gradeOf(scenarios::heldOutSession(), wholeCalibration(), config).grade, Grade::kGood);
  }
}

TEST(CalibrationGrade, ACycleThatFailedSpoilsNothing) {
  std::vector<CycleRequest> requests = wholeCalibration();
  requests.push_back({Cycle::kCoil, 24});
  EXPECT_EQ(gradeOf(scenarios::heldOutSession(), requests).grade, Grade::kGood);
}

TEST(CalibrationGrade, UsableWhereNoRefinementAskedAllSamples) {
  std::vector<CycleRequest> requests{{Cycle::kJoint}, {Cycle::kPoles, 0}};
  for (std::size_t coil = 1; coil < scenarios::paperNominal().coils.size(); ++coil) {
    requests.push_back({Cycle::kCoil, coil});
  }
  const GradedCalibration graded = gradeOf(scenarios::heldOutSession(), requests);
  EXPECT_EQ(graded.grade, Grade::kUsable) << graded.reason;
  EXPECT_TRUE(tells(graded, "run refine")) << graded.reason;
  requests.push_back({Cycle::kRefine});
  EXPECT_EQ(gradeOf(scenarios::heldOutSession(), requests).grade, Grade::kGood);
}

TEST(CalibrationGrade, FailedWhereNothingIsIdentified) {
  EXPECT_EQ(gradeOf({}, {}).grade, Grade::kFailed);
  EXPECT_EQ(gradeOf({}, {{Cycle::kJoint}}).grade, Grade::kFailed);
}

}  // namespace
}  // namespace sac
