#pragma once

#include <string>

namespace sac {

/// Asks that the system runs the calling thread, and those that it starts from then on, before
/// ordinary programs as soon as they have something to do: at a low real-time priority. Where that
/// is not permitted nothing changes.
void askForRealTime();

/// Puts the calling thread before the other threads of a program that runs in real time, so that
/// nothing that comes in, however much, delays it. Elsewhere nothing changes.
void goBeforeOtherThreads();

/// How the calling thread is scheduled, for people.
std::string describeScheduling();

}  // namespace sac
