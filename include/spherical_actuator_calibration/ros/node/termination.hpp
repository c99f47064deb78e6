#pragma once

namespace sac {

/// Makes SIGINT, SIGTERM, SIGHUP and SIGQUIT end spinUntilTermination() instead of the process, so
/// that a node's objects are destroyed in order; and so do SIGALRM, SIGUSR1, SIGUSR2, SIGXCPU and
/// others that end a process which does not expect them. roscpp by itself dies on all but SIGINT
/// without any clean-up. SIGHUP stays ignored where it is, as nohup wants it. Call after
/// ros::init() with ros::init_options::NoSigintHandler.
void handleTerminationSignals();

/// Until the loops below begin, two seconds after such a signal end the program with status 1: it
/// may be asking a master that never answers.
void endStartAfterSignal();

/// The start is over: before a loop of one's own that looks for signals.
void endStart();

/// True once one of these signals came.
bool terminationRequested();

/// Makes an exception that nobody catches, such as one of want of memory in a thread of roscpp, end
/// the program as SIGTERM does, so that what is dangerous ends first: its thread stands still. What
/// has not ended two seconds later is aborted.
void handleFatalExceptions();

/// True once there was one: the exit status must tell it.
bool failedFatally();

/// Ends the program with this exit status so many seconds from now, unless it has ended by then:
/// all that is left to do is to take leave of a master, which may not answer.
void endWithin(unsigned seconds, int status);

/// The status of endWithin() is 1 from now on, whatever was said. For any thread.
void lateEndFails();

/// Serves the global callback queue until a signal came or ROS is shut down from outside. ROS
/// itself still runs afterwards in the first case, so that last messages can be sent.
void spinUntilTermination();

/// The same for a node whose callbacks are served by spinners: only waits.
void waitForTermination();

}  // namespace sac
