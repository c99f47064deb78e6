// calibrate_cases ACTUATOR.yaml CONFIG.yaml SAMPLES.yaml...: runs all possible cycles on each file
// of samples and prints what came out, one line a fact, for programs that know the truth and share
// no code with this package.

#include <algorithm>
#include <cstdio>
#include <ctime>
#include <exception>

#include "spherical_actuator_calibration/actuator/description_file.hpp"
#include "spherical_actuator_calibration/assessment/calibration_grade.hpp"
#include "spherical_actuator_calibration/calibration/calibration_session.hpp"
#include "spherical_actuator_calibration/calibration/cycle_selection.hpp"
#include "spherical_actuator_calibration/diagnosis/session_diagnosis.hpp"
#include "spherical_actuator_calibration/diagnosis/validity_check.hpp"
#include "spherical_actuator_calibration/measurement/sample_file.hpp"

namespace sac {
namespace {

/// Of the first `count` coordinates, those of the joints, row after row.
void printCovariance(const Eigen::MatrixXd& covariance, Eigen::Index count) {
  std::printf("covariance");
  for (Eigen::Index a = 0; a < count; ++a) {
    for (Eigen::Index b = 0; b < count; ++b) {
      std::printf(" %.17g", covariance(a, b));
    }
  }
  std::printf("\n");
}

/// Runs a cycle, and tells the processor time that it took; whether it succeeded.
bool run(CalibrationSession& session, const CycleRequest& request) {
  const std::clock_t begin = std::clock();
  const CycleReport& report = session.run(request);
  const double taken = static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC;
  std::printf("cycle %s %s rejected %u chi_square %.6g seconds %.6g %s\n",
              cycleText(request).c_str(),
              report.success ? "success" : "refused",
              report.samples_rejected,
              report.reduced_chi_square,
              taken,
              report.message.c_str());
  return report.success;
}

/// Whether held-out samples find the parameters in force still valid.
void check(const CalibrationSession& session) {
  const std::vector<Sample>& samples = session.samples();
  if (std::any_of(
          samples.begin(), samples.end(), [](const Sample& one) { return one.validation; })) {
    const ValidityCheck answer = checkValidity(session);
    std::printf("check %s %s\n", answer.is_valid ? "valid" : "changed", answer.message.c_str());
  }
}

void calibrate(const CalibratedDescription& start,
               const CalibrationConfig& config,
               const char* path) {
  const Actuator& actuator = start.actuator;
  CalibrationSession session(
      start, loadSamples(path, actuator.coils.size(), actuator.has_joints), config);
  std::printf("case %s\n", path);
  bool succeeded = true;
  for (const CycleRequest& request :
       possibleCycles(session.model(), session.samples(), config.estimation)) {
    succeeded = run(session, request);
  }
  if (!succeeded) {
    for (const Diagnosis& one : diagnose(session)) {
      std::printf("diagnosis %s %s\n", one.cause.c_str(), one.message.c_str());
    }
  }
  check(session);
  for (const ParameterEstimate& one : session.parameters()) {
    std::printf("parameter %s %.17g %.17g %s\n",
                one.name.c_str(),
                one.value,
                one.stddev,
                one.observable ? "identified" : "open");
  }
  std::printf("complete %s\n", session.isComplete() ? "yes" : "no");
  printCovariance(session.state().belief.covariance, session.model().space().pole(0));
  const GradedCalibration graded = gradeCalibration(session);
  std::printf("grade %s %s\n", gradeName(graded.grade).c_str(), graded.reason.c_str());
}

}  // namespace
}  // namespace sac

int main(int argc, char** argv) {
  try {
    if (argc < 4) {
      std::fprintf(stderr, "Usage: calibrate_cases ACTUATOR.yaml CONFIG.yaml SAMPLES.yaml...\n");
      return 2;
    }
    const sac::CalibratedDescription start = sac::loadDescription(argv[1]);
    const sac::CalibrationConfig config = sac::loadCalibrationConfig(argv[2]);
    for (int n = 3; n < argc; ++n) {
      sac::calibrate(start, config, argv[n]);
    }
    return 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "calibrate_cases: %s\n", error.what());
    return 2;
  }
}
