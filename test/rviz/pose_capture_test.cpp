#include "pose_capture.hpp"

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

}  // namespace
}  // namespace sac
