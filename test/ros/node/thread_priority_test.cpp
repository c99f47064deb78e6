#include "spherical_actuator_calibration/ros/node/thread_priority.hpp"

#include <string>
#include <thread>

#include <gtest/gtest.h>

#include <pthread.h>
#include <sched.h>

namespace sac {
namespace {

/// Real-time priority of the calling thread, 0 of an ordinary one.
int ownPriority() {
  int policy = 0;
  sched_param param = {};
  EXPECT_EQ(::pthread_getschedparam(::pthread_self(), &policy, &param), 0);
  return policy == SCHED_OTHER ? 0 : param.sched_priority;
}

/// Whether the system permits it to this program.
bool isPermitted() {
  bool is_permitted = false;
  std::thread([&] {
    sched_param param = {};
    param.sched_priority = 1;
    is_permitted = ::pthread_setschedparam(::pthread_self(), SCHED_RR, &param) == 0;
  }).join();
  return is_permitted;
}

TEST(ThreadPriority, IsThatOfAllThreadsStartedFromThenOn) {
  int own = 0;
  int started = 0;
  std::thread([&] {
    askForRealTime();
    own = ownPriority();
    std::thread([&] { started = ownPriority(); }).join();
  }).join();
  EXPECT_EQ(own > 0, isPermitted());
  EXPECT_EQ(started, own);
}

TEST(ThreadPriority, PutsALoopBeforeTheOtherThreads) {
  int others = 0;
  int loop = 0;
  std::thread([&] {
    askForRealTime();
    others = ownPriority();
    goBeforeOtherThreads();
    loop = ownPriority();
  }).join();
  EXPECT_EQ(loop > others, isPermitted());
}

TEST(ThreadPriority, OfProgramsThatDoNotAskIsTheUsualOne) {
  int loop = 0;
  std::string words;
  std::thread([&] {
    goBeforeOtherThreads();
    loop = ownPriority();
    words = describeScheduling();
  }).join();
  EXPECT_EQ(loop, 0);
  EXPECT_EQ(words.rfind("as other programs", 0), 0U) << words;
}

TEST(ThreadPriority, IsTold) {
  std::string words;
  std::thread([&] {
    askForRealTime();
    words = describeScheduling();
  }).join();
  EXPECT_EQ(words.rfind("in real time, priority", 0) == 0, isPermitted()) << words;
}

}  // namespace
}  // namespace sac
