#include "spherical_actuator_calibration/ros/node/termination.hpp"

#include <chrono>
#include <csignal>
#include <cstdlib>
#include <exception>
#include <thread>

#include <ros/callback_queue.h>
#include <ros/init.h>

#include <unistd.h>

namespace sac {
namespace {

volatile std::sig_atomic_t g_termination_requested = 0;
volatile std::sig_atomic_t g_failed_fatally = 0;
volatile std::sig_atomic_t g_late_status = 1;
/// Nobody looks for signals yet, and what starts may wait for a master that never answers.
volatile std::sig_atomic_t g_is_starting = 0;

/// What still starts so long after a signal is ended [s].
constexpr unsigned kStartPatience = 2;

void requestTermination(int /*signal*/) {
  if (g_is_starting != 0 && g_termination_requested == 0) {
    ::alarm(kStartPatience);
  }
  g_termination_requested = 1;
}

[[noreturn]] void endLate(int /*signal*/) {
  ::_exit(static_cast<int>(g_late_status));
}

// Somebody else may send it, too: then it is a signal as the others are.
void endAfterAlarm(int signal, siginfo_t* info, void* /*context*/) {
  const bool is_sent = info->si_code <= 0;  // by a process, and not by the kernel's timer
  if (is_sent) {
    requestTermination(signal);
  } else {
    endLate(signal);
  }
}

void handleAlarm() {
  struct sigaction action = {};
  action.sa_sigaction = endAfterAlarm;
  action.sa_flags = SA_SIGINFO;
  sigemptyset(&action.sa_mask);
  sigaction(SIGALRM, &action, nullptr);
}

void handle(int signal, void (*handler)(int)) {
  struct sigaction action = {};
  action.sa_handler = handler;
  sigemptyset(&action.sa_mask);
  sigaction(signal, &action, nullptr);
}

// Memory may be what is wanting: nothing here asks for any.
[[noreturn]] void endInOrder() {
  constexpr char kWords[] = "An exception that nobody catches: the node ends.\n";
  constexpr std::chrono::seconds kPatience{2};
  g_failed_fatally = 1;
  g_termination_requested = 1;
  static_cast<void>(!::write(STDERR_FILENO, kWords, sizeof kWords - 1));
  std::this_thread::sleep_for(kPatience);
  std::abort();
}

// How long a signal may wait when no callback is due [s].
constexpr double kPatience = 0.02;

}  // namespace

void handleTerminationSignals() {
  for (const int signal :
       {SIGINT, SIGTERM, SIGQUIT, SIGUSR1, SIGUSR2, SIGXCPU, SIGXFSZ, SIGVTALRM, SIGPROF, SIGPWR}) {
    handle(signal, requestTermination);
  }
  // A terminal that is closed, such as that of ssh, sends this one; nohup lets a node outlive it.
  struct sigaction inherited = {};
  sigaction(SIGHUP, nullptr, &inherited);
  if (inherited.sa_handler != SIG_IGN) {
    handle(SIGHUP, requestTermination);
  }
  handleAlarm();
}

void endStartAfterSignal() {
  g_is_starting = 1;
}

// The time of a signal that came before ends; the time that endWithin() gives goes on.
void endStart() {
  if (g_is_starting != 0) {
    g_is_starting = 0;
    ::alarm(0);
  }
}

bool terminationRequested() {
  return g_termination_requested != 0;
}

void handleFatalExceptions() {
  std::set_terminate(endInOrder);
}

bool failedFatally() {
  return g_failed_fatally != 0;
}

void endWithin(unsigned seconds, int status) {
  g_is_starting = 0;
  g_late_status = status;
  handleAlarm();
  ::alarm(seconds);
}

void lateEndFails() {
  g_late_status = 1;
}

void spinUntilTermination() {
  endStart();
  while (ros::ok() && !terminationRequested()) {
    ros::getGlobalCallbackQueue()->callAvailable(ros::WallDuration(kPatience));
  }
}

void waitForTermination() {
  endStart();
  while (ros::ok() && !terminationRequested()) {
    ros::WallDuration(kPatience).sleep();
  }
}

}  // namespace sac
