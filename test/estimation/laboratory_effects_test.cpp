#include "spherical_actuator_calibration/estimation/laboratory_effects.hpp"

#include <optional>
#include <regex>
#include <set>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "estimation/effect_laboratory.hpp"
#include "spherical_actuator_calibration/base/error.hpp"
#include "spherical_actuator_calibration/base/input_file.hpp"
#include "spherical_actuator_calibration/base/pi.hpp"
#include "spherical_actuator_calibration/calibration/calibration_session.hpp"
#include "spherical_actuator_calibration/estimation/linearization.hpp"
#include "spherical_actuator_calibration/estimation/model_point.hpp"
#include "support/error_message.hpp"
#include "support/numeric_jacobian.hpp"
#include "support/source_dir.hpp"

namespace sac {
namespace {

TEST(LaboratoryEffects, JacobiansOfAllAgreeWithNumericOnes) {
  const EffectSelection all = only(effectNames());
  const CalibrationModel model{ParameterSpace(scenarios::paperNominal(), all)};
  scenarios::Generator generator(5);
  std::vector<Sample> samples =
      scenarios::paperSession(scenarios::paperTruth(), scenarios::Tracker::kEveryPose, generator);
  samples.push_back(scenarios::mixedTorqueSample(
      scenarios::paperTruth(), {0.1, 0.2, 0.3}, {1.0, -2.0}, generator));
  EstimationProblem problem;
  problem.model = &model;
  problem.samples = &samples;
  const Eigen::Index size = model.space().size();
  problem.prior = {Eigen::VectorXd::Zero(size), Eigen::MatrixXd::Zero(size, size)};
  for (const std::size_t n : {0U, 5U, 12U, 20U, 33U, 60U, 100U, 132U}) {
    if (samples[n].has_orientation) {
      problem.observations.push_back({n, Quantity::kOrientation});
    }
    if (samples[n].has_torque) {
      problem.observations.push_back({n, Quantity::kTorque});
    }
  }
  const EstimationOptions options;
  const ObservationEvaluator evaluator(problem, options);
  LinearizedObservation linear;
  for (std::size_t n = 0; n < problem.observations.size(); ++n) {
    Eigen::VectorXd x(size);
    for (double& value : x) {
      value = scenarios::uniformNoise(0.02, generator).x();
    }
    evaluator.linearize(n, evaluator.at(x), linear);
    EXPECT_LT((linear.residual - evaluator.residual(n, evaluator.at(x))).norm(), 1e-14);
    const Eigen::MatrixXd numeric = numericJacobian(
        [&](const Eigen::VectorXd& at) {
          return Eigen::VectorXd(evaluator.residual(n, evaluator.at(at)));
        },
        x);
    EXPECT_LT((linear.jacobian - numeric).cwiseAbs().maxCoeff(), 2e-7) << n;
    const std::set<Eigen::Index> columns(linear.columns.begin(), linear.columns.end());
    for (Eigen::Index p = 0; p < size; ++p) {
      EXPECT_TRUE(columns.count(p) > 0 || linear.jacobian.col(p).isZero(0.0)) << p;
    }
  }
}

/// A rotor without joints at coordinates with all effects that it can have.
class LevitatedEffects : public ::testing::Test {
 protected:
  static EffectSelection effects() {
    EffectSelection selection = only(effectNames());
    selection["tilt_cross_axis"] = false;
    selection["encoder_harmonics"] = false;
    return selection;
  }

  LevitatedEffects() {
    for (Sample& sample :
         scenarios::levitatedSession(scenarios::reactionSphere(), 6, 3, 1e-3, 1e-3, generator_)) {
      samples_.push_back(trackedSample(sample, 0.0));
    }
    samples_.back().current[0] += 1.5;
    for (double& value : x_) {
      value = scenarios::uniformNoise(0.02, generator_).x();
    }
  }

  /// Step of numeric derivatives: wide coils reach many poles, some where the curve changes its
  /// form.
  static constexpr double kShort = 1e-5;

  scenarios::Generator generator_{12};
  CalibrationModel model_{ParameterSpace(scenarios::reactionSphere(), effects())};
  std::vector<Sample> samples_;
  Eigen::VectorXd x_ = Eigen::VectorXd(model_.space().size());
};

TEST_F(LevitatedEffects, JacobiansOfTorquesAgreeWithNumericOnes) {
  for (const Sample& sample : samples_) {
    const std::vector<Excitation> excitations = excitedCoils(sample, 0.05);
    ResidualJacobian jacobian;
    const Eigen::Vector3d residual = model_.torqueResidual(sample, excitations, x_, &jacobian);
    EXPECT_LT((residual - model_.torqueResidual(sample, excitations, x_)).norm(), 1e-14);
    const Eigen::MatrixXd numeric = numericJacobian(
        [&](const Eigen::VectorXd& at) {
          return Eigen::VectorXd(model_.torqueResidual(sample, excitations, at));
        },
        x_,
        kShort);
    EXPECT_LT((jacobian - numeric).cwiseAbs().maxCoeff(), 2e-7);
  }
}

TEST_F(LevitatedEffects, ErrorsOfTheReadingTurnTheMeasuredOrientation) {
  const ModelPoint point(model_, x_);
  for (const Sample& sample : samples_) {
    const std::vector<Excitation> excitations = excitedCoils(sample, 0.05);
    ResidualJacobian jacobian;
    PoseDerivatives d_pose;
    point.torqueResidual(sample, excitations, &jacobian, &d_pose);
    const Eigen::MatrixXd numeric = numericJacobian(
        [&](const Eigen::VectorXd& error) {
          Sample turned = sample;
          turned.R_stator_rotor = rotationExp(error) * sample.R_stator_rotor;
          return Eigen::VectorXd(point.torqueResidual(trackedSample(turned, 0.0), excitations));
        },
        Eigen::Vector3d::Zero(),
        kShort);
    EXPECT_LT((d_pose.reading - numeric).cwiseAbs().maxCoeff(), 2e-7);
  }
}

TEST_F(LevitatedEffects, TheRotorLiesBetweenTheRegistrations) {
  const ModelPoint point(model_, x_);
  const EffectLayout& layout = model_.space().effects();
  const auto rotation = [&](const char* effect) {
    return rotationExp(x_.segment<3>(model_.space().effect() + layout.first(effect)));
  };
  const Eigen::Matrix3d measured = rotation("tracker_registration") *
                                   point.orientation(samples_.front()) *
                                   rotation("marker_registration");
  EXPECT_LT((measured - samples_.front().R_stator_rotor).norm(), 1e-14);
}

TEST_F(LevitatedEffects, ThoseOfJointSensorsAreRefused) {
  for (const char* effect : {"tilt_cross_axis", "encoder_harmonics"}) {
    EXPECT_EQ(errorMessage<ConfigError>(
                  [&] { ParameterSpace(scenarios::reactionSphere(), only({effect})); }),
              std::string("effects.") + effect + ": the description has no joints.");
  }
}

/// Without poles and coils, where nothing lies between the coordinates of joints and effects.
TEST(LaboratoryEffects, OfTheSensorsOfAnActuatorWithoutTorqueModel) {
  scenarios::Generator generator(9);
  Laboratory laboratory;
  laboratory.tilt << 0.01, -0.006, 0.008, -0.01;
  Actuator nominal = scenarios::paperNominal();
  std::vector<Sample> samples = sessionIn(laboratory, madeUnit(generator), generator);
  for (Sample& sample : samples) {
    sample.has_torque = false;
    sample.current.resize(0);
  }
  nominal.poles.clear();
  nominal.coils.clear();
  nominal.torque_curve.reset();
  CalibrationConfig config;
  config.effects = only({"tilt_cross_axis"});
  CalibrationSession session({nominal}, samples, config);
  session.run({Cycle::kJoint});
  const CycleReport& report = session.run({Cycle::kRefine});
  ASSERT_TRUE(report.success) << report.message;
  EXPECT_LT(report.reduced_chi_square, 1.5);
  const ParameterSpace& space = session.model().space();
  const Eigen::VectorXd values = space.reportedValues(session.state().belief.x);
  EXPECT_NEAR(values[space.effect()], 0.01, 2e-3);
  EXPECT_NEAR(values[space.effect() + 3], -0.01, 2e-3);
}

TEST(LaboratoryEffects, ATrackerRegistrationThatNothingTellsIsRefusedByName) {
  scenarios::Generator generator(8);
  CalibrationConfig config;
  config.effects = only({"tracker_registration"});
  config.tolerance.effect = 1e-3;
  CalibrationSession session(
      {scenarios::paperNominal()}, sessionIn({}, madeUnit(generator), generator), config);
  session.run({Cycle::kJoint});
  session.run({Cycle::kPoles, 0});
  const CycleReport& report = session.run({Cycle::kRefine});
  ASSERT_TRUE(report.success) << report.message;
  EXPECT_NE(report.message.find("switch off effects.tracker_registration"), std::string::npos)
      << report.message;
  EXPECT_TRUE(report.open_directions.empty());
  for (const ParameterEstimate& estimate : report.estimates) {
    const bool refused = estimate.name.rfind("tracker_registration/", 0) == 0;
    EXPECT_EQ(estimate.observable, !refused) << estimate.name;
  }
}

TEST(LaboratoryEffects, ATrackerRegistrationThatIsStatedTooCoarselyIsToBeMeasuredBetter) {
  scenarios::Generator generator(8);
  CalibrationConfig config;
  stateRegistration(config, {0.06, 0.0, 0.0});
  CalibrationSession session(
      {scenarios::paperNominal()}, sessionIn({}, madeUnit(generator), generator), config);
  const CycleReport& report = session.run({Cycle::kJoint});
  EXPECT_NE(report.message.find("stated more coarsely than estimation.unobservable_stddev"),
            std::string::npos)
      << report.message;
  EXPECT_EQ(report.message.find("switch off"), std::string::npos) << report.message;
}

TEST(LaboratoryEffects, ATrackerRegistrationThatIsCoarseAboutOneAxisIsToBeMeasuredBetter) {
  scenarios::Generator generator(8);
  FrameCovariance stated = 1e-6 * FrameCovariance::Identity();
  stated(0, 0) = 0.06 * 0.06;
  CalibrationConfig config;
  stateRegistration(config, {std::nullopt, std::nullopt, 0.0, stated});
  CalibrationSession session(
      {scenarios::paperNominal()}, sessionIn({}, madeUnit(generator), generator), config);
  const CycleReport& report = session.run({Cycle::kJoint});
  EXPECT_EQ(report.open_directions.size(), 1U) << report.message;
  EXPECT_NE(report.message.find("stated more coarsely than estimation.unobservable_stddev"),
            std::string::npos)
      << report.message;
}

TEST(LaboratoryEffects, AreInTheCalibratedDescription) {
  scenarios::Generator generator(6);
  Actuator made = madeUnit(generator);
  for (PoleAxis& pole : made.poles) {
    pole.gain = 0.97;
  }
  Laboratory laboratory;
  laboratory.bias = {2e-3, -1e-3, 0.5e-3};
  CalibrationConfig config;
  config.effects = only({"torque_bias", "strength_scale"});
  CalibrationSession session(
      {scenarios::paperNominal()}, sessionIn(laboratory, made, generator), config);
  session.run({Cycle::kJoint});
  session.run({Cycle::kPoles, 0});
  ASSERT_TRUE(session.run({Cycle::kRefine}).success);
  const CalibratedDescription result = session.description({"2024-05-31T12:00:00Z", {}, "0.1.0"});
  EXPECT_NEAR(result.actuator.poles[4].gain, 0.97, 1e-3);
  ASSERT_EQ(result.calibration->effects.size(), 4U);
  EXPECT_EQ(result.calibration->effects[1].name, "torque_bias/y");
  EXPECT_NEAR(result.calibration->effects[1].value, -1e-3, 2e-4);
  EXPECT_GT(result.calibration->effects[1].stddev, 1e-6);
  const std::string text = renderDescription(result, "c.yaml");
  EXPECT_EQ(renderDescription(parseDescription(text, "c.yaml"), "c.yaml"), text);
}

std::vector<std::vector<std::string>> severalStrengths() {
  const std::vector<std::string> all = {
      "strength_scale", "torque_curve", "pole_gains", "coil_gains"};
  std::vector<std::vector<std::string>> sets;
  for (unsigned chosen = 0; chosen < (1U << all.size()); ++chosen) {
    std::vector<std::string> set;
    for (std::size_t n = 0; n < all.size(); ++n) {
      if (((chosen >> n) & 1U) != 0U) {
        set.push_back(all[n]);
      }
    }
    if (set.size() > 1) {
      sets.push_back(set);
    }
  }
  return sets;
}

// All of them tell how strong the machine is: that they could not be told apart was their own
// doing.
TEST(LaboratoryEffects, ThatTellStrengthAreIdentifiedTogether) {
  for (const std::vector<std::string>& effects : severalStrengths()) {
    scenarios::Generator generator(6);
    Actuator made = madeUnit(generator);
    CalibrationConfig config;
    for (const std::string& effect : effects) {
      config.effects[effect] = true;
      if (effect == "torque_curve") {
        made.torque_curve->coefficients[1] *= 1.01;
        made.torque_curve->coefficients[3] *= 1.01;
      }
      for (PoleAxis& pole : made.poles) {
        pole.gain *= effect == "pole_gains" ? 1.0 + scenarios::uniformNoise(0.02, generator).x()
                     : effect == "strength_scale" ? 0.97
                                                  : 1.0;
      }
      for (CoilAxis& coil : made.coils) {
        coil.gain *=
            effect == "coil_gains" ? 1.0 + scenarios::uniformNoise(0.02, generator).x() : 1.0;
      }
    }
    CalibrationSession session({scenarios::paperNominal()}, sessionIn({}, made, generator), config);
    session.run({Cycle::kJoint});
    session.run({Cycle::kPoles, 0});
    const CycleReport& report = session.run({Cycle::kRefine});
    ASSERT_TRUE(report.success) << describe(config.effects) << ": " << report.message;
    for (const ParameterEstimate& estimate : report.estimates) {
      EXPECT_TRUE(estimate.observable) << describe(config.effects) << ": " << estimate.name;
    }
    EXPECT_LT(report.reduced_chi_square, 1.3) << describe(config.effects);
    // The product of all is that of the machine.
    const Actuator found = session.actuator();
    const double angle = 10.0 * kOneDegree;
    const double strength =
        TorqueCurve(*found.torque_curve).value(angle) * found.poles[3].gain * found.coils[5].gain;
    const double truth =
        TorqueCurve(*made.torque_curve).value(angle) * made.poles[3].gain * made.coils[5].gain;
    EXPECT_NEAR(strength / truth, 1.0, 3e-3) << describe(config.effects);
  }
}

TEST(LaboratoryEffects, ShapesOfTheTorqueCurveAreAsHighAsItsPeak) {
  const Actuator nominal = scenarios::paperNominal();
  const ParameterSpace space(nominal, only({"torque_curve"}));
  const double end = TorqueCurve(*nominal.torque_curve).supportBegin();
  for (Eigen::Index n = 0; n < space.effects().size(); ++n) {
    const Eigen::VectorXd x = Eigen::VectorXd::Unit(space.size(), space.effect() + n);
    // The change alone: with what it is added to taken off.
    TorqueCurveDescription shape = *space.actuatorAt(x).torque_curve;
    for (std::size_t c = 0; c < shape.coefficients.size(); ++c) {
      shape.coefficients[c] -= nominal.torque_curve->coefficients[c];
    }
    EXPECT_NEAR(TorqueCurve(shape).value(end), 0.2846, 1e-3) << n;
  }
}

TEST(LaboratoryEffects, NeedATorqueModelWhereTheyActOnTorque) {
  Actuator joint_only = scenarios::paperNominal();
  joint_only.poles.clear();
  joint_only.coils.clear();
  joint_only.torque_curve.reset();
  const std::string message =
      errorMessage<ConfigError>([&] { EffectLayout(joint_only, only({"torque_bias"})); });
  EXPECT_NE(message.find("effects.torque_bias"), std::string::npos) << message;
  EXPECT_EQ(EffectLayout(joint_only, only({"encoder_harmonics"})).size(), 12);
  EffectSelection chosen = only({"encoder_harmonics"});
  chosen.setHarmonicJoints({0, 2});
  const EffectLayout layout(joint_only, chosen);
  EXPECT_EQ(layout.size(), 8);
  EXPECT_EQ(layout.name(4), "joint_3/cos_1");
}

TEST(LaboratoryEffects, OneThatIsUnknownIsRefusedByName) {
  const std::string message =
      errorMessage<ConfigError>([] { EffectLayout(scenarios::paperNominal(), only({"moon"})); });
  EXPECT_NE(message.find("effects.moon"), std::string::npos) << message;
}

TEST(LaboratoryEffects, AreNamedAndMeasuredInTheirUnits) {
  const EffectLayout layout(scenarios::paperNominal(),
                            only({"pole_gains", "coil_gains", "torque_bias"}));
  ASSERT_EQ(layout.size(), 3 + 8 + 23);
  EXPECT_EQ(layout.name(0), "torque_bias/x");
  EXPECT_EQ(layout.name(3), "pole_1/gain");
  EXPECT_EQ(layout.name(11), "coil_2/gain");
  EXPECT_EQ(layout.at(11).name, "coil_gains");
  EXPECT_EQ(layout.at(11).unit, "1");
  EXPECT_EQ(layout.at(0).unit, "N·m");
  EXPECT_EQ(layout.scale(3), 1.0);
}

// What was saved is calibrated again, month after month.
TEST(LaboratoryEffects, AreToldOfInThePages) {
  // Each in the tables of its equation and of what a diagnosis tries, and off in the configuration.
  for (const char* page : {"doc/method.md", "doc/diagnosis.md"}) {
    const std::string text = readInputFile(std::string(SOURCE_DIR "/") + page);
    for (const std::string& name : effectNames()) {
      EXPECT_TRUE(std::regex_search(text, std::regex("\n\\| [^|]*`" + name + "`"))) << page << name;
    }
  }
  const std::string config = readInputFile(SOURCE_DIR "/config/calibration.yaml");
  for (const std::string& name : effectNames()) {
    EXPECT_NE(config.find("\n  " + name + ": false "), std::string::npos) << name;
  }
}

TEST(LaboratoryEffects, AnUnbalanceThatTheDescriptionHasIsReplacedNotAddedTo) {
  Actuator saved = scenarios::paperNominal();
  const ParameterSpace unknown(saved, only({"rotor_unbalance"}));
  saved.unbalance << 3.0e-3, -2.0e-3, 4.2e-3;
  const ParameterSpace known(saved, only({"rotor_unbalance"}));
  Eigen::VectorXd x = Eigen::VectorXd::Zero(known.size());
  EXPECT_EQ(known.actuatorAt(x).unbalance, saved.unbalance);
  x.tail<3>() << 3.1e-3, -2.1e-3, 4.0e-3;
  EXPECT_EQ(known.actuatorAt(x).unbalance, unknown.actuatorAt(x).unbalance);
}

}  // namespace
}  // namespace sac
