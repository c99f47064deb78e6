/// What goes wrong again and again gets no current any more, until zero is commanded.

#include <cstdint>
#include <optional>
#include <string>

#include <gtest/gtest.h>

#include "drivers/coil_driver_case.hpp"

namespace sac {
namespace {

TEST_F(CoilDriverTest, AnAmplifierThatIsLateWithCurrentGetsNoneAfterTheSecondTime) {
  for (int loss = 0; loss < 2; ++loss, now_ += 0.5) {
    follow(pattern(3, 1.5));
    bus_.failNext(std::nullopt, 3);
    bus_.failNext(TransportFailure::kTimeout);
    EXPECT_NE(beat().zero_reason, "");
  }
  for (const double current : {1.5, 1.5, 0.0}) {
    EXPECT_NE(beat().zero_reason.find("did not answer in time"), std::string::npos);
    ASSERT_EQ(offer(pattern(3, current)), "");
    EXPECT_TRUE(allZero());
  }
  for (int n = 0; n < 45; ++n) {
    beat();
  }
  follow(pattern(3, 1.5));
}

// Well without current, tripped as soon as there is some.
TEST_F(CoilDriverTest, AnAmplifierThatTripsAgainAndAgainGetsNoMoreCurrent) {
  int switched_on = 0;
  std::string reason;
  for (int n = 0; n < 200; ++n) {
    ASSERT_EQ(offer(pattern(3, 1.5)), "");
    reason = beat().zero_reason;
    switched_on += enabled() ? 1 : 0;
    bus_.set(kUnit, RegisterTable::kInput, 100, {static_cast<std::uint16_t>(enabled() ? 1 : 0)});
    now_ += 0.001;
  }
  EXPECT_LE(switched_on, 3);
  EXPECT_NE(reason.find("tripped 3 times"), std::string::npos) << reason;
  ASSERT_EQ(offer(pattern(3, 0.0)), "");
  for (int n = 0; n < 45; ++n) {
    beat();
  }
  follow(pattern(3, 1.5));
}

TEST_F(CoilDriverTest, ALinkThatIsLostAgainWhileCurrentFlowsIsAnError) {
  follow(pattern(3, 1.5));
  measures(3, 1.5);
  now_ += 0.005;
  ASSERT_EQ(offer(pattern(3, 0.0)), "");
  for (int loss = 0; loss < 2; ++loss) {
    beat();
    now_ += 0.3;
    bus_.failNext(std::nullopt);
    bus_.failNext(TransportFailure::kTimeout);
    beat();
    now_ += 0.3;
  }
  EXPECT_NE(beat().zero_reason.find("twice within"), std::string::npos);
}

}  // namespace
}  // namespace sac
