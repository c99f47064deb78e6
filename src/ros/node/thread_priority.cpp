#include "spherical_actuator_calibration/ros/node/thread_priority.hpp"

#include <pthread.h>
#include <sched.h>

namespace sac {
namespace {

// Below what kernels with threads for their interrupts give to these, which is 50. Of equal ones
// each has its turn.
constexpr int kOfPrograms = 10;
constexpr int kOfLoops = 20;

/// Whether the system permits it.
bool setRealTime(int priority) {
  sched_param param = {};
  param.sched_priority = priority;
  return ::pthread_setschedparam(::pthread_self(), SCHED_RR, &param) == 0;
}

/// 0: an ordinary one.
int realTimePriority() {
  int policy = SCHED_OTHER;
  sched_param param = {};
  const bool is_known = ::pthread_getschedparam(::pthread_self(), &policy, &param) == 0;
  return is_known && (policy == SCHED_RR || policy == SCHED_FIFO) ? param.sched_priority : 0;
}

}  // namespace

void askForRealTime() {
  if (realTimePriority() == 0) {
    static_cast<void>(setRealTime(kOfPrograms));
  }
}

void goBeforeOtherThreads() {
  const int priority = realTimePriority();
  if (priority > 0 && priority < kOfLoops) {
    static_cast<void>(setRealTime(kOfLoops));
  }
}

std::string describeScheduling() {
  const int priority = realTimePriority();
  return priority > 0 ? "in real time, priority " + std::to_string(priority)
                      : "as other programs: it has no real-time priority";
}

}  // namespace sac
