#include "spherical_actuator_calibration/estimation/laboratory_effects.hpp"

#include <cmath>
#include <set>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "spherical_actuator_calibration/actuator/spherical_joint.hpp"
#include "spherical_actuator_calibration/actuator/torque_model.hpp"
#include "spherical_actuator_calibration/base/error.hpp"
#include "spherical_actuator_calibration/base/rotations.hpp"
#include "spherical_actuator_calibration/calibration/calibration_session.hpp"
#include "spherical_actuator_calibration/estimation/linearization.hpp"
#include "support/calibration_trials.hpp"
#include "support/error_message.hpp"
#include "support/numeric_jacobian.hpp"
#include "support/scenarios.hpp"

namespace sac {
namespace {

using Effect = LaboratoryEffect;

constexpr double kOrientationNoise = 1e-3;
constexpr double kTorqueNoise = 5e-4;

EffectSelection only(const std::vector<Effect>& effects) {
  EffectSelection selection;
  for (const Effect effect : effects) {
    selection[effect] = true;
  }
  return selection;
}

/// A laboratory by its physics, independent of the model that is tested.
struct Laboratory {
  Eigen::Vector3d bias = Eigen::Vector3d::Zero();
  Eigen::Vector3d unbalance = Eigen::Vector3d::Zero();
  Eigen::Vector4d harmonics = Eigen::Vector4d::Zero();
  Eigen::Matrix2d tilt = Eigen::Matrix2d::Zero();
  Eigen::Vector3d marker = Eigen::Vector3d::Zero();  ///< rotation of the marker on the rotor

  /// Joint angles when the sensors read q.
  Eigen::Vector3d angles(const Eigen::Vector3d& q) const {
    Eigen::Vector3d result = q;
    result.head<2>() += tilt * q.head<2>();
    result[2] += harmonics[0] * std::cos(q[2]) + harmonics[1] * std::sin(q[2]) +
                 harmonics[2] * std::cos(2.0 * q[2]) + harmonics[3] * std::sin(2.0 * q[2]);
    return result;
  }
};

/// Measures the samples of the paper's session again, in a laboratory with effects, with the
/// tracker on everywhere.
std::vector<Sample> sessionIn(const Laboratory& laboratory,
                              const Actuator& truth,
                              scenarios::Generator& generator) {
  std::vector<Sample> samples =
      scenarios::paperSession(truth, scenarios::Tracker::kEveryPose, generator);
  const JointGeometry joints = jointGeometry(truth.joints);
  const TorqueGeometry geometry = torqueGeometry(truth);
  const TorqueCurve curve(*truth.torque_curve);
  for (Sample& sample : samples) {
    const Eigen::Matrix3d R = rotorOrientation(joints, laboratory.angles(sample.joint_position));
    sample.R_stator_rotor = rotationExp(scenarios::uniformNoise(kOrientationNoise, generator)) * R *
                            rotationExp(laboratory.marker);
    if (sample.has_torque) {
      const Eigen::Vector3d gravity = R.transpose() * Eigen::Vector3d(0.0, 0.0, -1.0);
      sample.torque = rotorTorque(curve, geometry, R, sample.current) + laboratory.bias +
                      laboratory.unbalance.cross(gravity) +
                      scenarios::uniformNoise(kTorqueNoise, generator);
    }
  }
  return samples;
}

/// Many sessions on different units in one kind of laboratory.
class EffectTrials {
 public:
  explicit EffectTrials(const EffectSelection& modelled) { config_.effects = modelled; }

  /// `truth` as made; `values` of the modelled effects, in the order of their layout.
  void add(const Actuator& geometry,
           const std::vector<Sample>& samples,
           const std::vector<double>& values) {
    CalibrationSession session({scenarios::paperNominal()}, samples, config_);
    session.run({Cycle::kJoint});
    session.run({Cycle::kPoles, 0});
    const CycleReport refined = session.run({Cycle::kRefine});
    chi_square_ += refined.reduced_chi_square;
    ++trials_;
    if (!refined.success) {
      ++failures_;
      return;
    }
    const ParameterSpace& space = session.model().space();
    Eigen::VectorXd truth = space.coordinatesOf(geometry);
    ASSERT_EQ(static_cast<Eigen::Index>(values.size()), space.effects().size());
    for (Eigen::Index e = 0; e < space.effects().size(); ++e) {
      truth[space.effect() + e] = values[static_cast<std::size_t>(e)] / space.effects().unit(e);
    }
    const CycleRequest refine{Cycle::kRefine};
    const std::vector<Eigen::Index> free =
        selectCoordinates(space, samples, refine, config_.estimation);
    const Eigen::MatrixXd bound = cramerRaoBound(session.model(), samples, refine, free, truth);
    const Eigen::Index effects = space.effects().size();
    const Eigen::Index geometry_count = bound.rows() - effects;
    const auto split = free.end() - effects;
    geometry_.add(session.state().belief,
                  truth,
                  {free.begin(), split},
                  bound.topLeftCorner(geometry_count, geometry_count));
    effects_.add(session.state().belief,
                 truth,
                 {split, free.end()},
                 bound.bottomRightCorner(effects, effects));
  }

  int failures() const { return failures_; }
  double meanChiSquare() const { return chi_square_ / trials_; }
  /// Of the 73 geometric parameters, and of the effects.
  const TrialStatistics& geometry() const { return geometry_; }
  const TrialStatistics& effects() const { return effects_; }

 private:
  CalibrationConfig config_;
  TrialStatistics geometry_;
  TrialStatistics effects_;
  double chi_square_ = 0.0;
  int trials_ = 0;
  int failures_ = 0;
};

Actuator madeUnit(scenarios::Generator& generator) {
  return scenarios::perturbed(scenarios::paperNominal(), 0.03, 0.02, generator);
}

/// One hundred sessions with the effect modelled reach the bound of that model with intervals that
/// hold; with the effect ignored the result is visibly wrong.
template <typename MakeCase>
void expectModelledAtTheBound(const EffectSelection& effects, MakeCase make_case) {
  constexpr int kTrials = 100;
  constexpr int kIgnoredTrials = 10;
  EffectTrials modelled(effects);
  EffectTrials ignored({});
  for (int seed = 1; seed <= kTrials; ++seed) {
    scenarios::Generator generator(static_cast<std::uint64_t>(seed));
    const Actuator geometry = madeUnit(generator);
    std::vector<double> values;
    const std::vector<Sample> samples = make_case(geometry, generator, values);
    modelled.add(geometry, samples, values);
    if (seed <= kIgnoredTrials) {
      ignored.add(geometry, samples, {});
    }
  }
  EXPECT_EQ(modelled.failures(), 0);
  EXPECT_LE(modelled.geometry().errorOverBound(), 1.05);
  EXPECT_NEAR(modelled.geometry().coverage(), 0.95, 0.02);
  EXPECT_GE(modelled.effects().coverage(), 0.9);
  EXPECT_LT(modelled.meanChiSquare(), 1.1);
  const bool all_refused = ignored.failures() == kIgnoredTrials;
  EXPECT_TRUE(all_refused ||
              (ignored.geometry().errorOverBound() > 1.4 && ignored.meanChiSquare() > 1.2))
      << ignored.geometry().errorOverBound() << " " << ignored.meanChiSquare();
}

TEST(LaboratoryEffects, JacobiansOfAllAgreeWithNumericOnes) {
  EffectSelection all;
  all.modelled.fill(true);
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
    evaluator.linearize(n, x, linear);
    EXPECT_LT((linear.residual - evaluator.residual(n, x)).norm(), 1e-14);
    const Eigen::MatrixXd numeric = numericJacobian(
        [&](const Eigen::VectorXd& at) { return Eigen::VectorXd(evaluator.residual(n, at)); }, x);
    EXPECT_LT((linear.jacobian - numeric).cwiseAbs().maxCoeff(), 1e-7) << n;
    const std::set<Eigen::Index> columns(linear.columns.begin(), linear.columns.end());
    for (Eigen::Index p = 0; p < size; ++p) {
      EXPECT_TRUE(columns.count(p) > 0 || linear.jacobian.col(p).isZero(0.0)) << p;
    }
  }
}

TEST(LaboratoryEffects, TorqueBias) {
  expectModelledAtTheBound(
      only({Effect::kTorqueBias}),
      [](const Actuator& geometry, scenarios::Generator& generator, std::vector<double>& values) {
        Laboratory laboratory;
        laboratory.bias = {2.7e-3, 0.0, 0.0};
        values = {2.7e-3, 0.0, 0.0};
        return sessionIn(laboratory, geometry, generator);
      });
}

TEST(LaboratoryEffects, RotorUnbalance) {
  expectModelledAtTheBound(
      only({Effect::kRotorUnbalance}),
      [](const Actuator& geometry, scenarios::Generator& generator, std::vector<double>& values) {
        Laboratory laboratory;
        laboratory.unbalance = {3.0e-3, -2.0e-3, 4.2e-3};
        values = {3.0e-3, -2.0e-3, 4.2e-3};
        return sessionIn(laboratory, geometry, generator);
      });
}

TEST(LaboratoryEffects, GainsOfPolesAndCoils) {
  expectModelledAtTheBound(
      only({Effect::kPoleGains, Effect::kCoilGains}),
      [](const Actuator& geometry, scenarios::Generator& generator, std::vector<double>& values) {
        Actuator made = geometry;
        const auto spread = [&] { return 1.0 + scenarios::uniformNoise(0.02, generator).x(); };
        for (PoleAxis& pole : made.poles) {
          pole.gain = spread();
        }
        for (CoilAxis& coil : made.coils) {
          coil.gain = spread();
        }
        // Coil 1 is the reference of strength.
        for (const PoleAxis& pole : made.poles) {
          values.push_back(pole.gain * made.coils[0].gain - 1.0);
        }
        for (std::size_t j = 1; j < made.coils.size(); ++j) {
          values.push_back(made.coils[j].gain / made.coils[0].gain - 1.0);
        }
        return sessionIn({}, made, generator);
      });
}

TEST(LaboratoryEffects, StrengthScaleOfWarmMagnets) {
  expectModelledAtTheBound(
      only({Effect::kStrengthScale}),
      [](const Actuator& geometry, scenarios::Generator& generator, std::vector<double>& values) {
        constexpr double kWarm = -0.0012 * 30.0;
        Actuator made = geometry;
        for (PoleAxis& pole : made.poles) {
          pole.gain = 1.0 + kWarm;
        }
        values = {kWarm};
        return sessionIn({}, made, generator);
      });
}

TEST(LaboratoryEffects, EncoderHarmonics) {
  expectModelledAtTheBound(
      only({Effect::kEncoderHarmonics}),
      [](const Actuator& geometry, scenarios::Generator& generator, std::vector<double>& values) {
        Laboratory laboratory;
        laboratory.harmonics = {0.8e-3, -0.6e-3, 0.3e-3, 0.2e-3};
        values = {0.8e-3, -0.6e-3, 0.3e-3, 0.2e-3};
        return sessionIn(laboratory, geometry, generator);
      });
}

TEST(LaboratoryEffects, TiltScaleAndCrossAxis) {
  expectModelledAtTheBound(
      only({Effect::kTiltCrossAxis}),
      [](const Actuator& geometry, scenarios::Generator& generator, std::vector<double>& values) {
        Laboratory laboratory;
        laboratory.tilt << 0.01, -0.006, 0.008, -0.01;
        values = {0.01, -0.006, 0.008, -0.01};
        return sessionIn(laboratory, geometry, generator);
      });
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
  config.effects = only({Effect::kTiltCrossAxis});
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

TEST(LaboratoryEffects, TorqueCurve) {
  expectModelledAtTheBound(
      only({Effect::kTorqueCurve}),
      [](const Actuator& geometry, scenarios::Generator& generator, std::vector<double>& values) {
        TorqueCurveDescription curve = geometry.torque_curve.value();
        const EffectLayout layout(geometry, only({Effect::kTorqueCurve}));
        values = {0.01, -0.02, 0.015, 0.005, -0.005, 0.003, 0.002};
        for (std::size_t c = 0; c < curve.coefficients.size(); ++c) {
          for (std::size_t n = 0; n < values.size(); ++n) {
            curve.coefficients[c] +=
                layout.curveShapes()(static_cast<Eigen::Index>(c), static_cast<Eigen::Index>(n)) *
                values[n];
          }
        }
        Actuator made = geometry;
        made.torque_curve = curve;
        return sessionIn({}, made, generator);
      });
}

/// Torques are measured in the rotor's frame, so that they tell where the marker is.
TEST(LaboratoryEffects, MarkerRegistration) {
  expectModelledAtTheBound(
      only({Effect::kMarkerRegistration}),
      [](const Actuator& geometry, scenarios::Generator& generator, std::vector<double>& values) {
        Laboratory laboratory;
        laboratory.marker = {4e-3, -3e-3, 5e-3};
        values = {4e-3, -3e-3, 5e-3};
        return sessionIn(laboratory, geometry, generator);
      });
}

TEST(LaboratoryEffects, ATrackerRegistrationThatNothingTellsIsRefusedByName) {
  scenarios::Generator generator(8);
  CalibrationConfig config;
  config.effects = only({Effect::kTrackerRegistration});
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

TEST(LaboratoryEffects, AreInTheCalibratedDescription) {
  scenarios::Generator generator(6);
  Actuator made = madeUnit(generator);
  for (PoleAxis& pole : made.poles) {
    pole.gain = 0.97;
  }
  Laboratory laboratory;
  laboratory.bias = {2e-3, -1e-3, 0.5e-3};
  CalibrationConfig config;
  config.effects = only({Effect::kTorqueBias, Effect::kStrengthScale});
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

TEST(LaboratoryEffects, ShapesOfTheTorqueCurveAreAsHighAsItsPeak) {
  const Actuator nominal = scenarios::paperNominal();
  const EffectLayout layout(nominal, only({Effect::kTorqueCurve}));
  TorqueCurveDescription shape = *nominal.torque_curve;
  const double peak = layout.curveShapes()(0, 0);
  EXPECT_NEAR(peak, 0.2846, 1e-3);
  for (Eigen::Index n = 0; n < layout.curveShapes().cols(); ++n) {
    shape.coefficients.assign(layout.curveShapes().col(n).begin(),
                              layout.curveShapes().col(n).end());
    const TorqueCurve curve(shape);
    EXPECT_NEAR(curve.value(curve.supportBegin()), peak, 1e-9) << n;
  }
}

TEST(LaboratoryEffects, NeedATorqueModelWhereTheyActOnTorque) {
  Actuator joint_only = scenarios::paperNominal();
  joint_only.poles.clear();
  joint_only.coils.clear();
  joint_only.torque_curve.reset();
  const std::string message =
      errorMessage<ConfigError>([&] { EffectLayout(joint_only, only({Effect::kTorqueBias})); });
  EXPECT_NE(message.find("effects.torque_bias"), std::string::npos) << message;
  EXPECT_EQ(EffectLayout(joint_only, only({Effect::kEncoderHarmonics})).size(), 4);
}

TEST(LaboratoryEffects, AreNamedAndMeasuredInTheirUnits) {
  const EffectLayout layout(scenarios::paperNominal(),
                            only({Effect::kPoleGains, Effect::kCoilGains, Effect::kTorqueBias}));
  ASSERT_EQ(layout.size(), 3 + 8 + 23);
  EXPECT_EQ(layout.name(0), "torque_bias/x");
  EXPECT_EQ(layout.name(3), "pole_1/gain");
  EXPECT_EQ(layout.name(11), "coil_2/gain");
  EXPECT_EQ(layout.effect(11), Effect::kCoilGains);
  EXPECT_EQ(layout.unit(3), 1.0);
}

}  // namespace
}  // namespace sac
