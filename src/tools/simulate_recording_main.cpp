#include <cstdio>
#include <filesystem>
#include <iostream>

#include "simulate_recording_options.hpp"
#include "spherical_actuator_calibration/actuator/actuator_design.hpp"
#include "spherical_actuator_calibration/actuator/description_file.hpp"
#include "spherical_actuator_calibration/emulation/manufacturing_errors.hpp"
#include "spherical_actuator_calibration/emulation/session_simulator.hpp"
#include "spherical_actuator_calibration/measurement/session_plan.hpp"
#include "spherical_actuator_calibration/planning/session_plan_file.hpp"
#include "spherical_actuator_calibration/ros/emulation_node/session_bag_writer.hpp"
#include "tool_main.hpp"

namespace sac {
namespace {

Actuator truthOf(const Actuator& nominal, const SimulateRecordingOptions& options) {
  if (!options.truth_in_path) {
    return manufacturedActuator(nominal, options.errors, options.simulation.seed);
  }
  Actuator truth = loadActuator(*options.truth_in_path);
  requireSameDesign(nominal, truth);
  return truth;
}

SessionPlan planOf(const Actuator& nominal, const SimulateRecordingOptions& options) {
  return options.plan_path ? loadPlannedSession(*options.plan_path, nominal)
                           : planSession(nominal, options.plan, options.simulation.seed);
}

void printSummary(const SimulateRecordingOptions& options,
                  const SimulatedSession& session,
                  std::uint64_t messages) {
  const double megabytes =
      1e-6 * static_cast<double>(std::filesystem::file_size(options.output_path));
  std::printf("%s: %zu dwells in %.1f s, %llu messages, %.1f MB\n",
              options.output_path.c_str(),
              session.dwells.size(),
              session.duration,
              static_cast<unsigned long long>(messages),
              megabytes);
  if (!session.bad_dwells.empty()) {
    std::printf("tracker off in the dwells");
    for (const std::size_t dwell : session.bad_dwells) {
      std::printf(" %zu", dwell + 1);
    }
    std::printf("\n");
  }
  std::printf("truth: %s\n", options.truth_path.c_str());
}

void simulateRecording(const SimulateRecordingOptions& options) {
  const CalibratedDescription description = loadDescription(options.actuator_path);
  const Actuator& nominal = description.actuator;
  const Actuator truth = truthOf(nominal, options);
  const SessionPlan plan = planOf(nominal, options);
  requireNewFile(options.output_path, options.bag.overwrite);
  requireNewFile(options.truth_path, options.bag.overwrite);

  SessionBagWriter writer(options.output_path, description, options.bag);
  const SimulatedSession session =
      simulateSession(truth, plan, options.simulation, writer, terminalProgress("recording"));
  saveDescription(options.truth_path, {truth}, options.bag.overwrite);
  writer.close();
  printSummary(options, session, writer.messages());
}

}  // namespace
}  // namespace sac

int main(int argc, char** argv) {
  return sac::runTool("simulate_recording", [&] {
    const auto options = sac::parseSimulateRecordingOptions(argc, argv, std::cout);
    if (options) {
      sac::simulateRecording(*options);
    }
    return sac::kToolSuccess;
  });
}
