#include "spherical_actuator_calibration/calibration/cycle_selection.hpp"

#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "spherical_actuator_calibration/base/error.hpp"
#include "support/error_message.hpp"
#include "support/scenarios.hpp"

namespace sac {
namespace {

std::string textOf(const std::vector<CycleRequest>& requests) {
  std::string text;
  for (const CycleRequest& request : requests) {
    text += (text.empty() ? "" : ",") + cycleText(request);
  }
  return text;
}

/// Torque samples with the given coils (from 1) at 2 A, alone.
std::vector<Sample> samplesWithCoils(const std::vector<std::size_t>& coils) {
  std::vector<Sample> samples;
  for (const std::size_t coil : coils) {
    Sample sample;
    sample.has_torque = true;
    sample.current = Eigen::VectorXd::Zero(24);
    sample.current[static_cast<Eigen::Index>(coil) - 1] = 2.0;
    samples.push_back(sample);
  }
  return samples;
}

Sample orientationSample() {
  Sample sample;
  sample.has_orientation = true;
  return sample;
}

/// At different poses.
std::vector<Sample> orientationSamples(int count) {
  std::vector<Sample> samples;
  for (int n = 0; n < count; ++n) {
    samples.push_back(orientationSample());
    samples.back().joint_position[n % 3] = 0.2 * (n + 1);
  }
  return samples;
}

std::vector<Sample> joined(std::vector<Sample> one, const std::vector<Sample>& other) {
  one.insert(one.end(), other.begin(), other.end());
  return one;
}

CalibrationModel paperModel() {
  return CalibrationModel(ParameterSpace(scenarios::paperNominal()));
}

std::vector<CycleRequest> nextOf(const std::vector<Sample>& samples) {
  const CalibrationModel model = paperModel();
  return nextCycles(model, SampleCounts(model, {}, samples));
}

TEST(CycleSelection, ReadsCyclesInTheOrderGiven) {
  const std::string text = "refine,joint,poles:7,coil:12,joint";
  EXPECT_EQ(textOf(parseCycles(text)), text);
}

TEST(CycleSelection, NamesTheWordThatIsUnknown) {
  for (const std::string word : {"joints",
                                 "poles",
                                 "coil",
                                 "poles:",
                                 "poles:0",
                                 "coil:-1",
                                 "coil:1x",
                                 "coil: 1",
                                 "joint:1",
                                 "coils:2",
                                 "Joint",
                                 ""}) {
    const std::string message =
        errorMessage<ConfigError>([&] { parseCycles("joint," + word + ",refine"); });
    EXPECT_EQ(message.find("The cycle \"" + word + "\" is unknown"), 0U) << message;
  }
  EXPECT_THROW(parseCycles(""), ConfigError);
  EXPECT_THROW(parseCycles("joint,"), ConfigError);
}

TEST(CycleSelection, CoilsAreAllOthersThatHaveSamples) {
  const std::vector<Sample> samples = samplesWithCoils({2, 3, 3, 5, 7});
  const auto expanded = [&](const std::string& text) {
    return textOf(expandCoils(parseCycles(text), paperModel(), samples, {}));
  };
  EXPECT_EQ(expanded("joint,poles:3,coils"), "joint,poles:3,coil:2,coil:5,coil:7");
  EXPECT_EQ(expanded("poles:3,coil:7,coils,refine"), "poles:3,coil:7,coil:2,coil:5,refine");
}

TEST(CycleSelection, PolesGoWithTheCoilThatHasMostSamples) {
  std::vector<Sample> samples = samplesWithCoils({2, 2, 3, 3, 3, 5});
  EXPECT_EQ(textOf(possibleCycles(paperModel(), samples, {})), "poles:3,coil:2,coil:5,refine");
  samples.push_back(orientationSample());
  EXPECT_EQ(textOf(possibleCycles(paperModel(), samples, {})),
            "joint,poles:3,coil:2,coil:5,refine");
}

TEST(CycleSelection, APlannedSessionGoesFromTheJointToTheRefinement) {
  const std::vector<Sample> samples =
      joined(samplesWithCoils({2, 2, 3, 3, 3}), orientationSamples(3));
  EXPECT_EQ(textOf(nextOf(samples)), "joint,refine");
}

TEST(CycleSelection, AFullTurnIsNoOtherPose) {
  std::vector<Sample> samples(8, orientationSample());
  for (std::size_t n = 0; n < samples.size(); ++n) {
    samples[n].joint_position = {0.3, -0.2, n % 2 == 0 ? 3.13 : -3.13};
  }
  // Of one pose no more than three count.
  EXPECT_EQ(SampleCounts(paperModel(), {}, samples).usefulOrientations(), 3U);
}

TEST(CycleSelection, PolesAndOtherCoilsFollowWhereOneCoilCanTellEveryPole) {
  std::vector<Sample> samples =
      joined(samplesWithCoils({1, 4, 4, 2, 2, 2, 2, 2, 2, 2, 2, 2}), orientationSamples(3));
  EXPECT_EQ(textOf(nextOf(samples)), "joint,poles:2,coil:1,coil:4,refine");
  samples.erase(samples.begin() + 3);
  EXPECT_EQ(textOf(nextOf(samples)), "joint,refine");
}

TEST(CycleSelection, TheJointNeedsThreeOrientationsAtDifferentPoses) {
  EXPECT_EQ(textOf(nextOf(orientationSamples(2))), "");
  EXPECT_EQ(textOf(nextOf(orientationSamples(3))), "joint");
  const std::vector<Sample> still(20, orientationSample());
  EXPECT_EQ(textOf(nextOf(still)), "");
}

TEST(CycleSelection, TheRefinementNeedsWhatAnotherCycleNeedsOrTorquesAtManyPoses) {
  std::vector<Sample> torques = samplesWithCoils({2});
  torques.front().has_orientation = true;
  EXPECT_EQ(textOf(nextOf(torques)), "");
  // Two coils at a time: no other cycle can take them.
  torques = samplesWithCoils({1, 2, 3, 4, 5, 6, 7, 8, 9});
  for (std::size_t n = 0; n < torques.size(); ++n) {
    torques[n].current[20] = 2.0;
    torques[n].joint_position[0] = 0.2 * static_cast<double>(n);
  }
  EXPECT_EQ(textOf(nextOf(torques)), "refine");
  torques[3].joint_position = torques[4].joint_position;
  EXPECT_EQ(textOf(nextOf(torques)), "");
}

TEST(CycleSelection, TorquesOfSeveralCoilsAtOnceServeTheRefinementOnly) {
  std::vector<Sample> torques = samplesWithCoils({1, 2, 3});
  for (Sample& sample : torques) {
    sample.current[20] = -2.0;
  }
  EXPECT_EQ(textOf(possibleCycles(paperModel(), torques, {})), "refine");
  EXPECT_EQ(textOf(nextOf(torques)), "");
  torques = joined(torques, orientationSamples(3));
  EXPECT_EQ(textOf(possibleCycles(paperModel(), torques, {})), "joint,refine");
  EXPECT_EQ(textOf(nextOf(torques)), "joint,refine");
}

TEST(CycleSelection, HeldOutAndMixedSamplesAskForNoCycle) {
  std::vector<Sample> samples = samplesWithCoils({2, 4, 6});
  samples[0].validation = true;
  samples[1].current[9] = 1.0;
  samples.push_back(orientationSample());
  samples.back().validation = true;
  EXPECT_EQ(textOf(possibleCycles(paperModel(), samples, {})), "poles:6,refine");
}

TEST(CycleSelection, WithoutTorqueModelOnlyTheJointIsPossible) {
  Actuator actuator = scenarios::paperNominal();
  actuator.torque_curve.reset();
  const CalibrationModel model{ParameterSpace(actuator)};
  std::vector<Sample> samples = samplesWithCoils({2});
  EXPECT_EQ(textOf(possibleCycles(model, samples, {})), "");
  samples.push_back(orientationSample());
  EXPECT_EQ(textOf(possibleCycles(model, samples, {})), "joint");
  EffectSelection effects;
  effects["tilt_cross_axis"] = true;
  const CalibrationModel with_effects{ParameterSpace(actuator, effects)};
  EXPECT_EQ(textOf(possibleCycles(with_effects, samples, {})), "joint,refine");
}

}  // namespace
}  // namespace sac
