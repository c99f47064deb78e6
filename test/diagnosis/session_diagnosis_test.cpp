#include "spherical_actuator_calibration/diagnosis/session_diagnosis.hpp"

#include <cmath>
#include <random>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "spherical_actuator_calibration/base/rotations.hpp"
#include "spherical_actuator_calibration/diagnosis/diagnosis.hpp"
#include "spherical_actuator_calibration/diagnosis/validity_check.hpp"
#include "support/scenarios.hpp"

namespace sac {
namespace {

class SessionDiagnosis : public ::testing::Test {
 protected:
  CalibrationSession session(const Actuator& truth, unsigned seed) {
    scenarios::Generator generator(seed);
    return {{scenarios::paperNominal()},
            scenarios::paperSession(truth, scenarios::Tracker::kEveryPose, generator),
            {}};
  }
};

TEST_F(SessionDiagnosis, NamesNothingWhereAllIsWell) {
  EXPECT_TRUE(diagnose(session(scenarios::paperTruth(), 1)).empty());
}

// Six torques of one coil; the amplifier measures a milliampere in the others, as it does.
TEST_F(SessionDiagnosis, SaysNothingOfCoilsThatAreOff) {
  constexpr std::size_t kCoil = 2;
  for (unsigned seed = 0; seed < 20; ++seed) {
    scenarios::Generator generator(seed);
    const Actuator truth = scenarios::perturbed(scenarios::paperNominal(), 0.03, 0.02, generator);
    const std::vector<Eigen::Vector3d> poses = scenarios::randomPoses(6, 0.3, generator);
    std::vector<Sample> samples =
        scenarios::torqueSamples(truth, poses, kCoil, 1.5, 1e-4, 1e-4, generator);
    std::normal_distribution<double> ampere(0.0, 1e-3);
    for (Sample& sample : samples) {
      for (Eigen::Index coil = 0; coil < sample.current.size(); ++coil) {
        sample.current[coil] += ampere(generator);
      }
    }
    const std::vector<Diagnosis> mistakes =
        diagnoseMistakes({{scenarios::paperNominal()}, samples, {}});
    EXPECT_TRUE(mistakes.empty()) << seed << ": " << mistakes.front().message;
  }
}

// Level 1, with a force/torque sensor that is not tared.
TEST_F(SessionDiagnosis, TakesNoBiasWithoutCurrentForTheEndOfARange) {
  scenarios::Generator generator(2);
  std::normal_distribution<double> newton_metre(0.0, 1e-4);
  std::vector<Sample> samples =
      scenarios::orientationSamples(scenarios::paperTruth(),
                                    scenarios::randomPoses(12, 0.3, generator),
                                    1e-3,
                                    scenarios::uniformStddev(1e-3),
                                    generator);
  for (Sample& sample : samples) {
    sample.has_torque = true;
    sample.torque_stddev = 1e-4;
    sample.current = Eigen::VectorXd::Zero(24);
    sample.torque = Eigen::Vector3d(4e-3, -2e-3, 3e-3) +
                    Eigen::Vector3d::NullaryExpr([&] { return newton_metre(generator); });
  }
  CalibrationSession session({scenarios::paperNominal()}, samples, {});
  const std::vector<Diagnosis> mistakes = diagnoseMistakes(session);
  EXPECT_TRUE(mistakes.empty()) << mistakes.front().message;
  EXPECT_TRUE(session.run({Cycle::kJoint}).success);
}

// Twelve coils in turn at each of few poses: most torques of a coil that no pole reaches are
// nothing, and one more is, that the drawing puts at the end of the reach.
TEST_F(SessionDiagnosis, SaysNothingOfCoilsThatNoPoleReaches) {
  constexpr std::size_t kCoils = 12;
  Actuator nominal = scenarios::paperNominal();
  nominal.poles.resize(3);
  for (unsigned seed = 0; seed < 30; ++seed) {
    scenarios::Generator generator(seed);
    const Actuator truth = scenarios::perturbed(nominal, 0.03, 0.03, generator);
    const std::vector<Eigen::Vector3d> poses = scenarios::randomPoses(5, 0.5, generator);
    std::vector<Sample> samples = scenarios::orientationSamples(
        truth, poses, 1e-4, scenarios::uniformStddev(1e-5), generator);
    for (std::size_t coil = 0; coil < kCoils; ++coil) {
      const std::vector<Sample> torques =
          scenarios::torqueSamples(truth, poses, coil, 2.0, 1e-5, 1e-5, generator);
      samples.insert(samples.end(), torques.begin(), torques.end());
    }
    const std::vector<Diagnosis> mistakes = diagnoseMistakes({{nominal}, samples, {}});
    EXPECT_TRUE(mistakes.empty()) << seed << ": " << mistakes.front().message;
  }
}

TEST_F(SessionDiagnosis, NamesTheStrengthThatTheMagnetsLost) {
  Actuator truth = scenarios::paperTruth();
  for (PoleAxis& pole : truth.poles) {
    pole.gain = 0.96;
  }
  const std::vector<Diagnosis> diagnoses = diagnose(session(truth, 2));
  ASSERT_FALSE(diagnoses.empty());
  EXPECT_EQ(diagnoses.front().cause, "strength_scale") << diagnoses.front().message;
  EXPECT_NE(diagnoses.front().message.find("-4.0"), std::string::npos) << diagnoses.front().message;
}

class SingleExplanation : public SessionDiagnosis {
 protected:
  /// As named, the message of the first, and whether its value has an uncertainty.
  static void expectFirst(const CalibrationSession& session,
                          const std::string& cause,
                          const std::string& value) {
    const std::vector<Diagnosis> diagnoses = diagnose(session);
    ASSERT_FALSE(diagnoses.empty()) << cause;
    EXPECT_EQ(diagnoses.front().cause, cause) << diagnoses.front().message;
    EXPECT_EQ(diagnoses.size(), 1U) << cause << " beside " << diagnoses.back().message;
    EXPECT_NE(diagnoses.front().message.find(value), std::string::npos)
        << diagnoses.front().message;
    EXPECT_NE(diagnoses.front().message.find(" ± "), std::string::npos)
        << diagnoses.front().message;
  }
};

// A twentieth of a magnet misfits by fifty standard deviations: an outlier, if it were let be one.
TEST_F(SingleExplanation, IsAWeakPole) {
  Actuator truth = scenarios::paperTruth();
  truth.poles[2].gain = 0.95;
  expectFirst(session(truth, 11), "pole_gain:3", "pole_3/gain = -5.0");
}

TEST_F(SingleExplanation, IsACoilThatIsSlightlyTooStrong) {
  Actuator truth = scenarios::paperTruth();
  truth.coils[0].gain = 1.07;
  expectFirst(session(truth, 12), "coil_gain:1", "coil_1/gain = 7.0");
}

TEST_F(SingleExplanation, CorrectsTheGainThatTheDescriptionHas) {
  Actuator truth = scenarios::paperTruth();
  truth.coils[0].gain = 0.9 * 1.07;
  Actuator described = scenarios::paperNominal();
  described.coils[0].gain = 0.9;
  expectFirst({{described}, session(truth, 12).samples(), {}},
              "coil_gain:1",
              "multiply its `gain` in the description by 1.07");
}

TEST_F(SingleExplanation, IsTheScaleOfAJoint) {
  CalibrationSession given = session(scenarios::paperTruth(), 13);
  std::vector<Sample> samples = given.samples();
  for (Sample& sample : samples) {
    sample.joint_position[2] /= 1.005;
  }
  expectFirst({given.start(), samples, {}}, "joint_scale:3", "joint_3/scale = 0.5");
}

// No sample tells a marker that is turned from a force/torque sensor that is turned the other way;
// a turned tracker explains neither.
TEST_F(SingleExplanation, IsNamedWithAllThatExplainAsWell) {
  const Eigen::Vector3d turn = Eigen::Vector3d(0.02, -0.025, 0.01);
  const CalibrationSession given = session(scenarios::paperTruth(), 14);
  std::vector<Sample> of_marker = given.samples();
  std::vector<Sample> of_sensor = given.samples();
  for (std::size_t n = 0; n < of_marker.size(); ++n) {
    of_marker[n].R_stator_rotor = of_marker[n].R_stator_rotor * rotationExp(turn);
    of_sensor[n].torque = rotationExp(turn) * of_sensor[n].torque;
  }
  for (const std::vector<Sample>& samples : {of_marker, of_sensor}) {
    std::set<std::string> causes;
    for (const Diagnosis& diagnosis : diagnose({given.start(), samples, {}})) {
      causes.insert(diagnosis.cause);
      EXPECT_NE(diagnosis.message.find("explained as well by"), std::string::npos)
          << diagnosis.message;
    }
    EXPECT_EQ(causes, (std::set<std::string>{"marker_registration", "torque_frame"}));
  }
}

TEST_F(SingleExplanation, IsNoneOfASingleWildSample) {
  const CalibrationSession given = session(scenarios::paperTruth(), 15);
  std::vector<Sample> samples = given.samples();
  for (std::size_t n = 20; n < samples.size(); n += 40) {
    samples[n].torque += Eigen::Vector3d(0.1, -0.2, 0.15);
  }
  const std::vector<Diagnosis> diagnoses = diagnose({given.start(), samples, {}});
  EXPECT_TRUE(diagnoses.empty()) << diagnoses.front().message;
}

// By hundreds of standard deviations: nothing of it would be left without the outliers.
TEST_F(SingleExplanation, IsAMagnetThatLostAFifth) {
  Actuator truth = scenarios::paperTruth();
  truth.poles[4].gain = 0.8;
  const std::vector<Diagnosis> diagnoses = diagnose(session(truth, 16));
  ASSERT_EQ(diagnoses.size(), 1U);
  EXPECT_EQ(diagnoses.front().cause, "pole_gain:5") << diagnoses.front().message;
  EXPECT_NE(diagnoses.front().message.find(" ± "), std::string::npos) << diagnoses.front().message;
}

TEST_F(SessionDiagnosis, TellsByHowManyRowsTorquesAreLate) {
  constexpr std::size_t kRows = 4;
  const CalibrationSession given = session(scenarios::paperTruth(), 17);
  std::vector<Sample> samples = given.samples();
  std::vector<std::size_t> with_torque;
  for (std::size_t n = 0; n < samples.size(); ++n) {
    if (samples[n].has_torque) {
      with_torque.push_back(n);
    }
  }
  for (std::size_t n = 0; n < with_torque.size(); ++n) {
    samples[with_torque[(n + kRows) % with_torque.size()]].torque =
        given.samples()[with_torque[n]].torque;
  }
  const std::vector<Diagnosis> mistakes = diagnoseMistakes({given.start(), samples, {}});
  ASSERT_FALSE(mistakes.empty());
  EXPECT_EQ(mistakes.front().cause, "rows_shifted") << mistakes.front().message;
  EXPECT_NE(mistakes.front().message.find("4 rows later"), std::string::npos)
      << mistakes.front().message;
}

class TwoMistakesAtAJoint : public SessionDiagnosis {
 protected:
  /// Causes named where the readings are `changed`.
  template <typename Change>
  std::vector<std::string> named(const Change& changed) {
    const CalibrationSession given = session(scenarios::paperTruth(), 21);
    std::vector<Sample> samples = given.samples();
    for (std::size_t n = 0; n < samples.size(); ++n) {
      changed(samples[n].joint_position, n < samples.size() / 2);
    }
    std::vector<std::string> causes;
    for (const Diagnosis& one : diagnoseMistakes({given.start(), samples, {}})) {
      causes.push_back(one.cause);
    }
    return causes;
  }
};

TEST_F(TwoMistakesAtAJoint, AreNamedTogether) {
  const auto turned = [](Eigen::Vector3d& q, bool) { q[2] = 1.2 - q[2]; };
  EXPECT_EQ(named(turned), (std::vector<std::string>{"joint_sign:3", "joint_index:3"}));
}

// A single one explains a part, with a unit that is bent beyond its tolerances.
TEST_F(TwoMistakesAtAJoint, OfTwoJointsAreNotOneAndABentUnit) {
  const auto turned = [](Eigen::Vector3d& q, bool) { q += Eigen::Vector3d(0.5, -0.4, 0.0); };
  EXPECT_EQ(named(turned), (std::vector<std::string>{"joint_index:1", "joint_index:2"}));
}

TEST_F(TwoMistakesAtAJoint, AreNotAReadingThatJumps) {
  const auto jumps = [](Eigen::Vector3d& q, bool early) { q[0] += early ? 0.6 : 0.0; };
  EXPECT_EQ(named(jumps), std::vector<std::string>{"joint_slipped:1"});
}

TEST_F(TwoMistakesAtAJoint, NobodyKnowsOfAReadingThatIsBentAndBlamesNoCoil) {
  const auto bent = [](Eigen::Vector3d& q, bool) { q[0] += 0.6 * std::sin(9.0 * q[2]); };
  EXPECT_EQ(named(bent), std::vector<std::string>{});
}

class Redescription : public SessionDiagnosis {
 protected:
  /// Mistakes that samples `changed` make beside the corrected description.
  template <typename Change>
  std::vector<Diagnosis> left(const Change& changed) {
    const CalibrationSession given = session(scenarios::paperTruth(), 23);
    std::vector<Sample> samples = given.samples();
    for (Sample& sample : samples) {
      changed(sample);
    }
    const WiringDiagnosis wiring = diagnoseWiring(given.start().actuator, samples, {});
    EXPECT_GE(wiring.mistakes.size(), 2U);
    EXPECT_TRUE(wiring.beyond_description.empty());
    return diagnoseWiring(wiring.redescribed, samples, {}).mistakes;
  }
};

TEST_F(Redescription, OfAJointThatCountsBackwardsFromAnotherIndex) {
  const std::vector<Diagnosis> mistakes =
      left([](Sample& sample) { sample.joint_position[2] = 1.2 - sample.joint_position[2]; });
  EXPECT_TRUE(mistakes.empty()) << mistakes.front().message;
}

TEST_F(Redescription, OfThreeCoilsInACircle) {
  const std::vector<Diagnosis> mistakes = left([](Sample& sample) {
    if (sample.current.size() > 0) {
      std::swap(sample.current[0], sample.current[1]);
      std::swap(sample.current[1], sample.current[2]);
    }
  });
  EXPECT_TRUE(mistakes.empty()) << mistakes.front().message;
}

class Validity : public SessionDiagnosis {
 protected:
  /// A calibrated session, with further poses of another truth held out.
  ValidityCheck checked(const Actuator& now) {
    CalibrationSession calibrated = session(scenarios::paperTruth(), 3);
    calibrated.run({Cycle::kJoint});
    calibrated.run({Cycle::kRefine});
    scenarios::Generator generator(4);
    const std::vector<Eigen::Vector3d> poses = scenarios::randomPoses(6, 0.3, generator);
    for (Sample& sample : scenarios::orientationSamples(
             now, poses, 1e-3, scenarios::uniformStddev(1e-3), generator)) {
      sample.id += 1000;
      sample.validation = true;
      calibrated.add(sample);
    }
    return checkValidity(calibrated);
  }
};

TEST_F(Validity, IsToldWithWhatItWouldHaveNoticed) {
  const ValidityCheck check = checked(scenarios::paperTruth());
  EXPECT_TRUE(check.is_valid) << check.message;
  EXPECT_NE(check.message.find("mrad (99 %)"), std::string::npos) << check.message;
}

TEST_F(Validity, EndsWhenAJointWasMoved) {
  Actuator now = scenarios::paperTruth();
  now.joints[1].offset += 3e-3;
  const ValidityCheck check = checked(now);
  EXPECT_FALSE(check.is_valid);
  EXPECT_NE(check.message.find("the orientation"), std::string::npos) << check.message;
}

/// A calibrated session whose coil 1 was turned since; `others` torques of coil 2 are newer than
/// the four that show it.
ValidityCheck checkedWithATurnedCoil(CalibrationSession calibrated, std::size_t others) {
  calibrated.run({Cycle::kJoint});
  calibrated.run({Cycle::kRefine});
  Actuator now = scenarios::paperTruth();
  now.coils[0].polar += 0.02;
  scenarios::Generator generator(6);
  std::uint32_t id = 2000;
  for (const auto& [coil, count] : {std::pair<std::size_t, std::size_t>{0, 4}, {1, others}}) {
    const std::vector<Eigen::Vector3d> poses = scenarios::randomPoses(count, 0.3, generator);
    for (Sample& sample : scenarios::torqueSamples(now, poses, coil, 2.0, 1e-3, 1e-3, generator)) {
      sample.id = id++;
      sample.validation = true;
      calibrated.add(sample);
    }
  }
  return checkValidity(calibrated);
}

TEST_F(Validity, EndsWhenACoilWasTurnedThatFewSamplesShow) {
  const ValidityCheck check = checkedWithATurnedCoil(session(scenarios::paperTruth(), 3), 30);
  EXPECT_FALSE(check.is_valid) << check.message;
  EXPECT_NE(check.message.find("coil 1 ("), std::string::npos) << check.message;
}

TEST_F(Validity, NamesTheCoilsOfWhichItSaysNothing) {
  CalibrationSession calibrated = session(scenarios::paperTruth(), 3);
  calibrated.run({Cycle::kJoint});
  calibrated.run({Cycle::kRefine});
  scenarios::Generator generator(6);
  std::uint32_t id = 2000;
  for (Sample& sample : scenarios::torqueSamples(scenarios::paperTruth(),
                                                 scenarios::randomPoses(6, 0.3, generator),
                                                 1,
                                                 2.0,
                                                 1e-3,
                                                 1e-3,
                                                 generator)) {
    sample.id = id++;
    sample.validation = true;
    calibrated.add(sample);
  }
  const ValidityCheck check = checkValidity(calibrated);
  EXPECT_TRUE(check.is_valid) << check.message;
  EXPECT_NE(check.message.find("No sample judges coils 1, 3, 4"), std::string::npos)
      << check.message;
}

TEST_F(Validity, CannotBeToldWithoutHeldOutSamples) {
  const ValidityCheck check = checkValidity(session(scenarios::paperTruth(), 5));
  EXPECT_FALSE(check.is_valid);
  EXPECT_NE(check.message.find("validation"), std::string::npos) << check.message;
}

}  // namespace
}  // namespace sac
