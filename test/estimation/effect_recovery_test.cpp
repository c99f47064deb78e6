#include <vector>

#include <gtest/gtest.h>

#include "estimation/effect_laboratory.hpp"
#include "spherical_actuator_calibration/calibration/calibration_session.hpp"
#include "support/calibration_trials.hpp"

namespace sac {
namespace {

/// Many sessions on different units in one kind of laboratory.
class EffectTrials {
 public:
  explicit EffectTrials(const EffectSelection& modelled) {
    config_.effects = modelled;
    // A map takes up an effect of the joints that is ignored, as far as it is smooth.
    config_.orientation_map = MapUse::kNever;
  }

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
      truth[space.effect() + e] = values[static_cast<std::size_t>(e)] / space.effects().scale(e);
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
  const bool are_refused = 2 * ignored.failures() > kIgnoredTrials;
  EXPECT_TRUE(are_refused ||
              (ignored.geometry().errorOverBound() > 1.4 && ignored.meanChiSquare() > 1.2))
      << ignored.geometry().errorOverBound() << " " << ignored.meanChiSquare();
}

TEST(LaboratoryEffects, TorqueBias) {
  expectModelledAtTheBound(
      only({"torque_bias"}),
      [](const Actuator& geometry, scenarios::Generator& generator, std::vector<double>& values) {
        Laboratory laboratory;
        laboratory.bias = {2.7e-3, 0.0, 0.0};
        values = {2.7e-3, 0.0, 0.0};
        return sessionIn(laboratory, geometry, generator);
      });
}

TEST(LaboratoryEffects, RotorUnbalance) {
  expectModelledAtTheBound(
      only({"rotor_unbalance"}),
      [](const Actuator& geometry, scenarios::Generator& generator, std::vector<double>& values) {
        Laboratory laboratory;
        laboratory.unbalance = {3.0e-3, -2.0e-3, 4.2e-3};
        values = {3.0e-3, -2.0e-3, 4.2e-3};
        return sessionIn(laboratory, geometry, generator);
      });
}

TEST(LaboratoryEffects, GainsOfPolesAndCoils) {
  expectModelledAtTheBound(
      only({"pole_gains", "coil_gains"}),
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
      only({"strength_scale"}),
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
  EffectSelection of_the_spin = only({"encoder_harmonics"});
  of_the_spin.setHarmonicJoints({2});
  expectModelledAtTheBound(
      of_the_spin,
      [](const Actuator& geometry, scenarios::Generator& generator, std::vector<double>& values) {
        Laboratory laboratory;
        laboratory.harmonics = {0.8e-3, -0.6e-3, 0.3e-3, 0.2e-3};
        values = {0.8e-3, -0.6e-3, 0.3e-3, 0.2e-3};
        return sessionIn(laboratory, geometry, generator);
      });
}

TEST(LaboratoryEffects, TiltScaleAndCrossAxis) {
  expectModelledAtTheBound(
      only({"tilt_cross_axis"}),
      [](const Actuator& geometry, scenarios::Generator& generator, std::vector<double>& values) {
        Laboratory laboratory;
        laboratory.tilt << 0.01, -0.006, 0.008, -0.01;
        values = {0.01, -0.006, 0.008, -0.01};
        return sessionIn(laboratory, geometry, generator);
      });
}

TEST(LaboratoryEffects, TorqueCurve) {
  expectModelledAtTheBound(
      only({"torque_curve"}),
      [](const Actuator& geometry, scenarios::Generator& generator, std::vector<double>& values) {
        const ParameterSpace space(geometry, only({"torque_curve"}));
        values = {0.01, -0.02, 0.015, 0.005, -0.005, 0.003, 0.002};
        Eigen::VectorXd x = Eigen::VectorXd::Zero(space.size());
        for (std::size_t n = 0; n < values.size(); ++n) {
          x[space.effect() + static_cast<Eigen::Index>(n)] = values[n];
        }
        Actuator made = geometry;
        made.torque_curve = space.actuatorAt(x).torque_curve;
        return sessionIn({}, made, generator);
      });
}

/// Torques are measured in the rotor's frame, so that they tell where the marker is.
TEST(LaboratoryEffects, MarkerRegistration) {
  expectModelledAtTheBound(
      only({"marker_registration"}),
      [](const Actuator& geometry, scenarios::Generator& generator, std::vector<double>& values) {
        Laboratory laboratory;
        laboratory.marker = {4e-3, -3e-3, 5e-3};
        values = {4e-3, -3e-3, 5e-3};
        return sessionIn(laboratory, geometry, generator);
      });
}

}  // namespace
}  // namespace sac
