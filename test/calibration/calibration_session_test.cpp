#include "spherical_actuator_calibration/calibration/calibration_session.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "calibration/sensor_noise.hpp"
#include "spherical_actuator_calibration/assessment/model_choice.hpp"
#include "spherical_actuator_calibration/base/error.hpp"
#include "spherical_actuator_calibration/calibration/cycle_selection.hpp"
#include "spherical_actuator_calibration/measurement/sample_file.hpp"
#include "support/scenarios.hpp"
#include "support/source_dir.hpp"

namespace sac {
namespace {

CalibrationOrigin exampleOrigin() {
  return {"2024-05-31T12:00:00Z", {{"session.bag", "sha256:00ff"}}, "0.1.0"};
}

/// Ten orientations, thirty torques of coil 1, four of coil 2; three more of each kind held out.
std::vector<Sample> sessionSamples(const Actuator& truth, scenarios::Generator& generator) {
  std::vector<Sample> samples =
      scenarios::orientationSamples(truth,
                                    scenarios::randomPoses(13, 0.6, generator),
                                    kOrientationNoise,
                                    scenarios::uniformStddev(kOrientationNoise),
                                    generator);
  const auto append = [&](std::size_t coil, std::size_t count) {
    const auto poses = scenarios::posesThatSeeEveryPole(truth, coil, count, 0.3, generator);
    for (const Sample& sample : scenarios::torqueSamples(truth,
                                                         poses,
                                                         coil,
                                                         2.0,
                                                         kTorqueNoise,
                                                         scenarios::uniformStddev(kTorqueNoise),
                                                         generator)) {
      samples.push_back(sample);
    }
  };
  append(0, 33);
  append(1, 12);
  std::uint32_t id = 0;
  for (Sample& sample : samples) {
    sample.id = ++id;
  }
  for (const std::size_t n : {10U, 11U, 12U, 43U, 44U, 45U}) {
    samples[n].validation = true;
  }
  return samples;
}

CalibrationSession paperSession(unsigned seed) {
  scenarios::Generator generator(seed);
  return {{scenarios::paperNominal()}, sessionSamples(scenarios::paperTruth(), generator), {}};
}

void runAll(CalibrationSession& session) {
  for (const CycleRequest& request :
       possibleCycles(session.model(), session.samples(), session.config().estimation)) {
    session.run(request);
  }
}

const ParameterEstimate& parameter(const std::vector<ParameterEstimate>& all,
                                   const std::string& name) {
  return *std::find_if(all.begin(), all.end(), [&](const ParameterEstimate& estimate) {
    return estimate.name == name;
  });
}

TEST(CalibrationSession, EachCycleStartsFromTheResultOfThoseBefore) {
  CalibrationSession session = paperSession(1);
  runAll(session);
  ASSERT_EQ(session.reports().size(), 4U);  // and the refinement
  EXPECT_TRUE(session.isComplete());
  const CycleReport& coil = session.reports()[2];
  EXPECT_EQ(coil.cycle, Cycle::kCoil);
  EXPECT_LT(coil.error_history.back(), 3e-3);

  const Actuator truth = scenarios::paperTruth();
  const Actuator result = session.description(exampleOrigin()).actuator;
  for (std::size_t k = 0; k < kJoints; ++k) {
    EXPECT_NEAR(result.joints[k].offset, truth.joints[k].offset, 2e-3);
    EXPECT_LT((result.joints[k].axis - truth.joints[k].axis).norm(), 5e-3);
  }
  for (std::size_t i = 0; i < truth.poles.size(); ++i) {
    EXPECT_NEAR(result.poles[i].polar, truth.poles[i].polar, 5e-3);
    EXPECT_NEAR(result.poles[i].azimuth, truth.poles[i].azimuth, 5e-3);
  }
}

TEST(CalibrationSession, DescriptionStatesTheUncertaintyOfWhatWasIdentifiedOnly) {
  CalibrationSession session = paperSession(2);
  runAll(session);
  const CalibratedDescription result = session.description(exampleOrigin());
  const std::vector<ParameterEstimate> parameters = session.parameters();
  EXPECT_EQ(result.stddevs.joints[1].axis_u, parameter(parameters, "joint_2/axis_u").stddev);
  EXPECT_EQ(result.stddevs.poles[4].azimuth, parameter(parameters, "pole_5/azimuth").stddev);
  EXPECT_EQ(result.stddevs.coils[1].polar, parameter(parameters, "coil_2/polar").stddev);
  EXPECT_FALSE(result.stddevs.coils[2].polar);
  const Actuator nominal = scenarios::paperNominal();
  EXPECT_EQ(result.actuator.coils[2].polar, nominal.coils[2].polar);
  EXPECT_EQ(result.actuator.coils[2].azimuth, nominal.coils[2].azimuth);
  EXPECT_NE(result.actuator.coils[1].azimuth, nominal.coils[1].azimuth);
}

TEST(CalibrationSession, RecordTellsCyclesOriginAndWhatIsOpen) {
  CalibrationSession session = paperSession(3);
  runAll(session);
  session.run({Cycle::kCoil, 16});  // without samples: fails
  const CalibrationRecord record = *session.description(exampleOrigin()).calibration;
  EXPECT_EQ(record.date, "2024-05-31T12:00:00Z");
  EXPECT_EQ(record.revision, 1U);
  EXPECT_EQ(record.software, "0.1.0");
  ASSERT_EQ(record.source.size(), 1U);
  EXPECT_EQ(record.source[0].checksum, "sha256:00ff");
  ASSERT_EQ(record.cycles.size(), 4U);
  EXPECT_EQ(record.cycles[0].cycle, "joint");
  EXPECT_EQ(record.cycles[0].unit, "rad");
  EXPECT_EQ(record.cycles[0].samples_used, 10U);
  EXPECT_GT(record.cycles[0].error_before, 10.0 * record.cycles[0].error_after);
  EXPECT_EQ(record.cycles[1].cycle, "poles");
  EXPECT_EQ(record.cycles[1].coil, 0U);
  EXPECT_EQ(record.cycles[1].unit, "N·m");
  EXPECT_EQ(record.cycles[3].cycle, "refine");
  EXPECT_EQ(record.cycles[3].unit, "1");
  EXPECT_EQ(record.unidentified.size(), 2U * 22U);
  EXPECT_EQ(record.unidentified.front(), "coil_3/polar");
  EXPECT_GT(record.orientation_uncertainty.value(), 0.0);
  EXPECT_GT(record.torque_uncertainty.value(), 0.0);
}

TEST(CalibrationSession, ExpectsTheSameErrorsWhereReportsLeaveThemOut) {
  CalibrationSession telling = paperSession(3);
  CalibrationSession silent = paperSession(3);
  for (const CycleRequest& request :
       {CycleRequest{Cycle::kJoint}, CycleRequest{Cycle::kPoles, 0}}) {
    const CycleReport told = telling.run(request);
    const CycleReport left_out = silent.run(withoutExpectedErrors(request));
    EXPECT_GT(told.orientation_uncertainty, 0.0);
    EXPECT_EQ(silent.expectedErrors().orientation, told.orientation_uncertainty);
    EXPECT_EQ(silent.expectedErrors().torque, told.torque_uncertainty);
    EXPECT_EQ(left_out.orientation_uncertainty, 0.0);
    EXPECT_EQ(left_out.torque_uncertainty, 0.0);
  }
  EXPECT_EQ(renderDescription(silent.description(exampleOrigin()), "c.yaml"),
            renderDescription(telling.description(exampleOrigin()), "c.yaml"));
  const double after = silent.expectedErrors().torque;
  silent.resume(silent.startState(), {});
  EXPECT_GT(silent.expectedErrors().torque, 2.0 * after);
}

TEST(CalibrationSession, CalibratedDescriptionsCanBeSavedAndLoaded) {
  CalibrationSession session = paperSession(4);
  runAll(session);
  const CalibratedDescription result = session.description(exampleOrigin());
  const std::string text = renderDescription(result, "c.yaml");
  EXPECT_EQ(renderDescription(parseDescription(text, "c.yaml"), "c.yaml"), text);
}

TEST(CalibrationSession, FailedCyclesChangeNothing) {
  CalibrationSession session = paperSession(5);
  const Eigen::VectorXd before = session.state().belief.x;
  EXPECT_FALSE(session.run({Cycle::kCoil, 1}).success);
  EXPECT_EQ(session.state().belief.x, before);
  EXPECT_FALSE(session.isComplete());
  EXPECT_TRUE(session.openParameters().empty());
}

TEST(CalibrationSession, HeldOutSamplesFitWithinTheirUncertainty) {
  double sum = 0.0;
  int agreeing = 0;
  constexpr int kSessions = 20;
  for (unsigned seed = 10; seed < 10 + kSessions; ++seed) {
    CalibrationSession session = paperSession(seed);
    runAll(session);
    const HeldOutValidation validation = session.validation().value();
    EXPECT_EQ(validation.samples, 6U);
    EXPECT_EQ(validation.orientations, 3U);
    EXPECT_EQ(validation.torques, 3U);
    EXPECT_EQ(validation.unjudged_torques, 0U);
    EXPECT_LT(validation.orientation_rms, 5e-3);
    EXPECT_LT(validation.torque_rms, 1e-2);
    sum += validation.reduced_chi_square;
    agreeing += validation.probability > 0.05 ? 1 : 0;
    ASSERT_EQ(validation.residuals.size(), 6U);
    EXPECT_EQ(validation.residuals[0].id, 11U);
    EXPECT_NE(verdict(validation).find("agree"), std::string::npos) << verdict(validation);
  }
  EXPECT_NEAR(sum / kSessions, 1.0, 0.25);
  EXPECT_GE(agreeing, kSessions - 4);
}

TEST(CalibrationSession, HeldOutSamplesShowWrongParameters) {
  const CalibrationSession session = paperSession(6);
  const HeldOutValidation nominal = session.validation().value();
  EXPECT_GT(nominal.orientation_rms, 20e-3);
  EXPECT_GT(nominal.torque_rms, 20e-3);
}

TEST(CalibrationSession, TorquesOfCoilsThatAreNotCalibratedAreNotJudged) {
  CalibrationSession session = paperSession(6);
  ASSERT_TRUE(session.run({Cycle::kJoint}).success);
  const HeldOutValidation validation = session.validation().value();
  EXPECT_EQ(validation.torques, 3U);
  EXPECT_EQ(validation.unjudged_torques, 3U);
  EXPECT_GT(validation.torque_rms, 5e-3);
  EXPECT_NE(verdict(validation).find("3 torques of coils that are not calibrated"),
            std::string::npos);
  EXPECT_NE(verdict(validation).find("they agree"), std::string::npos) << verdict(validation);
}

TEST(CalibrationSession, HeldOutSamplesThatLieContradictTheParameters) {
  scenarios::Generator generator(9);
  std::vector<Sample> samples = sessionSamples(scenarios::paperTruth(), generator);
  samples[43].torque.x() += 20.0 * kTorqueNoise;
  CalibrationSession session({scenarios::paperNominal()}, samples, {});
  runAll(session);
  const HeldOutValidation validation = session.validation().value();
  EXPECT_LT(validation.probability, kLeastProbability);
  EXPECT_NE(verdict(validation).find("contradict"), std::string::npos);
  const auto worst = std::max_element(
      validation.residuals.begin(), validation.residuals.end(), [](const auto& a, const auto& b) {
        return a.standardized < b.standardized;
      });
  EXPECT_EQ(worst->id, 44U);
}

TEST(CalibrationSession, WithoutHeldOutSamplesThereIsNoValidation) {
  scenarios::Generator generator(7);
  std::vector<Sample> samples = sessionSamples(scenarios::paperTruth(), generator);
  for (Sample& sample : samples) {
    sample.validation = false;
  }
  CalibrationConfig config;
  EXPECT_FALSE(
      CalibrationSession({scenarios::paperNominal()}, samples, config).validation().has_value());
  config.hold_out_every = 5;
  const CalibrationSession session({scenarios::paperNominal()}, samples, config);
  EXPECT_EQ(session.validation()->samples, samples.size() / 5);
  EXPECT_FALSE(session.samples()[0].validation);
  EXPECT_TRUE(session.samples()[4].validation);
}

TEST(CalibrationSession, GrowsSampleBySampleToTheSameResult) {
  scenarios::Generator generator(11);
  const std::vector<Sample> samples = sessionSamples(scenarios::paperTruth(), generator);
  CalibrationConfig config;
  config.hold_out_every = 7;
  CalibrationSession whole({scenarios::paperNominal()}, samples, config);
  CalibrationSession growing({scenarios::paperNominal()}, {}, config);
  for (const Sample& sample : samples) {
    growing.add(growing.prepared(sample));
  }
  runAll(whole);
  runAll(growing);
  EXPECT_EQ(growing.state().belief.x, whole.state().belief.x);
  EXPECT_EQ(growing.validation()->samples, whole.validation()->samples);
}

TEST(CalibrationSession, TakesSamplesAway) {
  CalibrationSession session = paperSession(12);
  const std::size_t count = session.samples().size();
  EXPECT_TRUE(session.remove(5));
  EXPECT_FALSE(session.remove(5));
  EXPECT_EQ(session.samples().size(), count - 1);
  session.clearSamples();
  EXPECT_FALSE(session.run({Cycle::kJoint}).success);
}

TEST(CalibrationSession, RefusesASampleThatCannotBeUsed) {
  const CalibrationSession session = paperSession(13);
  Sample sample = session.samples()[20];
  sample.current.resize(3);
  EXPECT_THROW(session.prepared(sample), DataError);
}

TEST(CalibrationSession, TakenUpAgainItGoesOnAsBefore) {
  CalibrationSession session = paperSession(14);
  session.run({Cycle::kJoint});
  CalibrationSession resumed({scenarios::paperNominal()},
                             session.samples(),
                             session.config(),
                             session.state(),
                             session.reports());
  session.run({Cycle::kPoles, 0});
  resumed.run({Cycle::kPoles, 0});
  EXPECT_EQ(resumed.state().belief.x, session.state().belief.x);
  EXPECT_EQ(renderDescription(resumed.description(exampleOrigin()), "c.yaml"),
            renderDescription(session.description(exampleOrigin()), "c.yaml"));

  resumed.resume(resumed.startState(), {});
  EXPECT_TRUE(resumed.state().belief.x.isZero(0.0));
  EXPECT_TRUE(resumed.reports().empty());

  CalibrationState other = session.state();
  other.identified.pop_back();
  EXPECT_THROW(resumed.resume(other, {}), DataError);
}

TEST(CalibrationSession, ContinuesACalibratedDescription) {
  CalibrationSession first = paperSession(8);
  runAll(first);
  const CalibratedDescription calibrated = first.description(exampleOrigin());

  scenarios::Generator generator(80);
  CalibrationSession second(
      calibrated, sessionSamples(scenarios::paperTruth(), generator), CalibrationConfig{});
  const auto before = second.parameters();
  EXPECT_TRUE(parameter(before, "pole_3/azimuth").observable);
  // Of the record, in coordinates around the drawing.
  EXPECT_NEAR(
      parameter(before, "pole_3/azimuth").stddev / calibrated.stddevs.poles[2].azimuth.value(),
      1.0,
      1e-3);
  EXPECT_FALSE(parameter(before, "coil_3/polar").observable);
  EXPECT_TRUE(second.run({Cycle::kCoil, 1}).success);
  const CalibratedDescription result = second.description(exampleOrigin());
  EXPECT_EQ(result.calibration->revision, 2U);
  EXPECT_EQ(result.actuator.poles[2].azimuth, calibrated.actuator.poles[2].azimuth);
}

TEST(CalibrationSession, KeepsEveryBitOfWhatWasNotIdentified) {
  Actuator odd = scenarios::paperNominal();
  odd.joints[0].axis = Eigen::Vector3d(0.9, 0.31, -0.2).normalized() * (1.0 + 1e-13);
  odd.poles[2].polar = 0.1234567;
  odd.coils[5].azimuth = -9.87654321;
  const Actuator result = CalibrationSession({odd}, {}, {}).description(exampleOrigin()).actuator;
  EXPECT_EQ(result.joints[0].axis, odd.joints[0].axis);
  EXPECT_EQ(result.poles[2].polar, odd.poles[2].polar);
  EXPECT_EQ(result.coils[5].azimuth, odd.coils[5].azimuth);
}

TEST(CalibrationSession, RefusesInvalidSamplesAndConfigurations) {
  Sample sample;
  sample.has_orientation = true;
  sample.joint_position.x() = std::nan("");
  EXPECT_THROW(CalibrationSession({scenarios::paperNominal()}, {sample}, {}), DataError);
  CalibrationConfig config;
  config.tolerance.pole = -1.0;
  EXPECT_THROW(CalibrationSession({scenarios::paperNominal()}, {}, config), ConfigError);
}

TEST(CalibrationSession, RealPositionerHasNoThirdJointAndFitsTheRest) {
  const std::string folder = SOURCE_DIR "/config/examples/two_axis_positioner/";
  const CalibratedDescription nominal = loadDescription(folder + "actuator.yaml");
  CalibrationSession session(nominal, loadSamples(folder + "samples.yaml", 0), CalibrationConfig{});
  ASSERT_EQ(session.samples().size(), 105U);
  const CycleReport& report = session.run({Cycle::kJoint});
  ASSERT_TRUE(report.success) << report.message;
  EXPECT_EQ(report.samples_used, 105U);
  EXPECT_EQ(report.samples_rejected, 0U);
  EXPECT_NE(report.message.find("joint_3"), std::string::npos) << report.message;
  EXPECT_LE(residualRms(report, Quantity::kOrientation).value(), 0.90e-3);
  EXPECT_FALSE(residualRms(report, Quantity::kTorque).has_value());

  EXPECT_FALSE(session.isComplete());
  EXPECT_EQ(session.openParameters(),
            (std::vector<std::string>{"joint_3/axis_u", "joint_3/axis_v"}));
  const CalibratedDescription result = session.description(exampleOrigin());
  EXPECT_EQ(result.actuator.joints[2].axis, nominal.actuator.joints[2].axis);
  EXPECT_FALSE(result.stddevs.joints[2].axis_u || result.stddevs.joints[2].axis_v);
  EXPECT_TRUE(result.stddevs.joints[1].axis_u && result.stddevs.joints[1].axis_v);
}

TEST(CalibrationSession, RealPositionerSupportsTheScaleOfItsTiltingJoint) {
  const std::string folder = SOURCE_DIR "/config/examples/two_axis_positioner/";
  const CalibratedDescription nominal = loadDescription(folder + "actuator.yaml");
  const CalibrationConfig config = loadCalibrationConfig(folder + "calibration.yaml");
  const std::vector<Sample> samples = loadSamples(folder + "samples.yaml", 0);
  CalibrationSession session(nominal, samples, config);
  session.run({Cycle::kJoint});
  ASSERT_TRUE(session.run({Cycle::kRefine}).success);
  const Eigen::Index scale = session.model().space().effect();
  const ParameterEstimate estimate = session.parameters()[static_cast<std::size_t>(scale)];
  EXPECT_EQ(estimate.name, "tilt_matrix/11");
  EXPECT_TRUE(estimate.observable);
  EXPECT_NEAR(estimate.value, 1.04e-3, 0.02e-3);
  EXPECT_LT(estimate.stddev, 0.2e-3);
  const std::vector<ModelFit> fits = compareEffects(nominal, samples, config);
  ASSERT_EQ(fits.size(), 2U);
  EXPECT_LT(fits[1].bic, fits[0].bic - 50.0);
  EXPECT_LT(fits[1].reduced_chi_square, 0.8);
}

}  // namespace
}  // namespace sac
