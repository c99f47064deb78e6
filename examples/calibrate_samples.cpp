// Calibrates an actuator from samples in a file, without ROS:
//   calibrate_samples ACTUATOR.yaml SAMPLES.yaml
// Exit status: 0 all was identified; 1 some parameter was not; 2 bad usage or unreadable input.
#include <cstdio>
#include <exception>

#include <spherical_actuator_calibration/actuator/description_file.hpp>
#include <spherical_actuator_calibration/calibration/calibration_session.hpp>
#include <spherical_actuator_calibration/calibration/cycle_selection.hpp>
#include <spherical_actuator_calibration/measurement/sample_file.hpp>

int main(int argc, char** argv) {
  if (argc != 3) {
    std::fprintf(stderr, "usage: calibrate_samples ACTUATOR.yaml SAMPLES.yaml\n");
    return 2;
  }
  try {
    const sac::CalibratedDescription start = sac::loadDescription(argv[1]);
    const sac::CalibrationConfig config;  // defaults: config/calibration.yaml tells them
    sac::CalibrationSession session(
        start, sac::loadSamples(argv[2], sac::modelledCoils(start.actuator)), config);

    for (const sac::CycleRequest& cycle :
         sac::possibleCycles(session.model(), session.samples(), config.estimation)) {
      const sac::CycleReport& report = session.run(cycle);
      std::printf("%s: %s\n", sac::cycleText(cycle).c_str(), report.message.c_str());
    }
    for (const sac::ParameterEstimate& parameter : session.parameters()) {
      std::printf("%-16s %12.6f ± %.6f%s\n",
                  parameter.name.c_str(),
                  parameter.value,
                  parameter.stddev,
                  parameter.observable ? "" : " (not identified)");
    }
    return session.isComplete() ? 0 : 1;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "calibrate_samples: %s\n", error.what());
    return 2;
  }
}
