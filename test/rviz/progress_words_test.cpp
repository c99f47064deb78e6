#include "progress_words.hpp"

#include <utility>
#include <vector>

#include <gtest/gtest.h>

namespace sac {
namespace {

msg::MeasurementProgress capturing(std::uint32_t captures, std::uint32_t told) {
  msg::MeasurementProgress progress;
  progress.stage = msg::MeasurementProgress::CAPTURING;
  progress.captures = captures;
  progress.told = told;
  if (told > 0) {
    progress.sentences = {"Older.", "The rotor moves."};
  }
  return progress;
}

TEST(ProgressWords, TellWhatIsUnderWay) {
  ProgressWords words;
  msg::MeasurementProgress progress;
  progress.stage = msg::MeasurementProgress::TURNING;
  words.receive(progress);
  EXPECT_EQ(words.text(), "Waiting until the rotor rests there …");
  progress = capturing(0, 0);
  words.receive(progress);
  EXPECT_EQ(words.text(), "Measuring without current …");
  progress.coils = {3, -7};
  words.receive(progress);
  EXPECT_EQ(words.text(), "Measuring with coil 3 -7 …");
}

TEST(ProgressWords, TellWhatDisturbsUntilTheNextCapture) {
  ProgressWords words;
  words.receive(capturing(0, 2));
  EXPECT_EQ(words.text(), "Measuring without current …\nThe rotor moves.");
  words.receive(capturing(1, 2));
  EXPECT_EQ(words.text(), "Measuring without current …");
  words.receive(capturing(1, 3));
  EXPECT_EQ(words.text(), "Measuring without current …\nThe rotor moves.");
}

TEST(SessionWords, TellPoseStageAndTheWayOfAHand) {
  msg::MeasurementProgress progress;
  progress.stage = msg::MeasurementProgress::PLANNING;
  EXPECT_EQ(sessionInWords(progress), "A guided session leads. Planning …");
  progress.stage = msg::MeasurementProgress::TURNING;
  progress.pose = 3;
  progress.poses = 8;
  progress.joint_names = {"roll", "pitch", "yaw"};
  progress.way = {0.2, 0.01, -0.1};
  progress.tolerance = 0.05;
  EXPECT_EQ(sessionInWords(progress),
            "A guided session leads, pose 3 of 8. Turn roll by +11.5°, yaw by −5.7°.");
  progress.way = {0.02, 0.01, -0.01};
  progress.held_out = 1;
  progress.stage = msg::MeasurementProgress::CAPTURING;
  progress.coils = {5};
  EXPECT_EQ(sessionInWords(progress),
            "A guided session leads, pose 3 of 8, held out. Measuring with coil 5 …");
}

msg::ExciteFeedback excited(std::int32_t coil, bool carries, std::vector<double> measured) {
  msg::ExciteFeedback feedback;
  feedback.progress.stage = msg::MeasurementProgress::EXCITING;
  feedback.progress.coils = {coil};
  feedback.progress.carries = static_cast<std::uint8_t>(carries);
  feedback.measured = std::move(measured);
  return feedback;
}

TEST(ExcitationWords, TellWhatTheAmplifierMeasures) {
  ExcitationWords words;
  words.receive(msg::ExciteFeedback());
  EXPECT_EQ(words.text(), "Waiting for the laboratory …");
  words.receive(excited(-2, false, {0.01, -0.2, -0.03}));
  EXPECT_EQ(words.text(),
            "Coil -2: measured -0.200 A, the others at most 0.030 A. It does not carry its current "
            "yet.");
  EXPECT_EQ(words.carried(), "");
  words.receive(excited(-2, true, {0.01, -1.998, -0.03}));
  EXPECT_EQ(words.text(), "Coil -2 carries -1.998 A, the others at most 0.030 A.");
  words.receive(excited(-2, false, {0.0, 0.0, 0.0}));
  EXPECT_EQ(words.carried(), "Coil -2 carried -1.998 A, the others at most 0.030 A.");
}

TEST(ExcitationWords, TellWhereNothingIsMeasured) {
  ExcitationWords words;
  msg::ExciteFeedback feedback = excited(3, false, {});
  feedback.progress.sentences = {"The coil driver has tripped."};
  words.receive(feedback);
  EXPECT_EQ(words.text(),
            "Coil 3 is excited, but no measured currents arrive.\nThe coil driver has tripped.");
}

}  // namespace
}  // namespace sac
