// Names the mistakes of sessions in files, for judges that made the files without this package:
//   diagnose_samples [--effects] ACTUATOR.yaml SAMPLES.yaml [ACTUATOR.yaml SAMPLES.yaml ...]
// One line for each session: the processor time it took [s], and its causes, separated by blanks,
// or none. --effects: also effects of the laboratory; the messages follow, indented.
#include <cstdio>
#include <cstring>
#include <ctime>
#include <exception>

#include "spherical_actuator_calibration/actuator/description_file.hpp"
#include "spherical_actuator_calibration/diagnosis/session_diagnosis.hpp"
#include "spherical_actuator_calibration/measurement/sample_file.hpp"

namespace {

void tell(double seconds, const std::vector<sac::Diagnosis>& diagnoses, bool with_messages) {
  std::printf("%.4f ", seconds);
  for (const sac::Diagnosis& one : diagnoses) {
    std::printf("%s ", one.cause.c_str());
    std::fprintf(stderr, "%s: %.1f: %s\n", one.cause.c_str(), one.evidence, one.message.c_str());
  }
  std::printf("%s\n", diagnoses.empty() ? "none" : "");
  for (std::size_t n = 0; with_messages && n < diagnoses.size(); ++n) {
    std::printf("    %s\n", diagnoses[n].message.c_str());
  }
}

}  // namespace

int main(int argc, char** argv) {
  const bool with_effects = argc > 1 && std::strcmp(argv[1], "--effects") == 0;
  const int first = with_effects ? 2 : 1;
  if (argc < first + 2 || (argc - first) % 2 != 0) {
    std::fprintf(stderr, "usage: diagnose_samples [--effects] ACTUATOR.yaml SAMPLES.yaml ...\n");
    return 2;
  }
  try {
    for (int n = first; n < argc; n += 2) {
      const sac::Actuator actuator = sac::loadActuator(argv[n]);
      const std::vector<sac::Sample> samples =
          sac::loadSamples(argv[n + 1], sac::modelledCoils(actuator), actuator.has_joints);
      const sac::CalibrationSession session({actuator}, samples, {});
      const std::clock_t begin = std::clock();
      const std::vector<sac::Diagnosis> diagnoses =
          with_effects ? sac::diagnose(session) : sac::diagnoseMistakes(session);
      tell(static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC, diagnoses, with_effects);
    }
    return 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "diagnose_samples: %s\n", error.what());
    return 2;
  }
}
