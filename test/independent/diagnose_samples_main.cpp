// Names the mistakes of sessions in files, for judges that made the files without this package:
//   diagnose_samples ACTUATOR.yaml SAMPLES.yaml [ACTUATOR.yaml SAMPLES.yaml ...]
// One line for each session: the processor time it took [s], and its causes, separated by blanks,
// or none.
#include <cstdio>
#include <ctime>
#include <exception>

#include "spherical_actuator_calibration/actuator/description_file.hpp"
#include "spherical_actuator_calibration/diagnosis/diagnosis.hpp"
#include "spherical_actuator_calibration/measurement/sample_file.hpp"

int main(int argc, char** argv) {
  if (argc < 3 || argc % 2 == 0) {
    std::fprintf(stderr, "usage: diagnose_samples ACTUATOR.yaml SAMPLES.yaml ...\n");
    return 2;
  }
  try {
    for (int n = 1; n < argc; n += 2) {
      const sac::Actuator actuator = sac::loadActuator(argv[n]);
      const std::vector<sac::Sample> samples =
          sac::loadSamples(argv[n + 1], sac::modelledCoils(actuator));
      const std::clock_t begin = std::clock();
      const sac::WiringDiagnosis diagnosis = sac::diagnoseWiring(actuator, samples, {});
      std::printf("%.4f ", static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC);
      for (const sac::Diagnosis& mistake : diagnosis.mistakes) {
        std::printf("%s ", mistake.cause.c_str());
        std::fprintf(stderr,
                     "%s: %.1f: %s\n",
                     mistake.cause.c_str(),
                     mistake.evidence,
                     mistake.message.c_str());
      }
      std::printf("%s\n", diagnosis.mistakes.empty() ? "none" : "");
    }
    return 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "diagnose_samples: %s\n", error.what());
    return 2;
  }
}
