#include <algorithm>
#include <exception>

#include "spherical_actuator_calibration/base/error.hpp"
#include "spherical_actuator_calibration/base/printable_text.hpp"
#include "spherical_actuator_calibration/diagnosis/session_diagnosis.hpp"
#include "spherical_actuator_calibration/diagnosis/validity_check.hpp"
#include "spherical_actuator_calibration/ros/calibration_node/calibration_node.hpp"

namespace sac {
namespace {

bool hasSucceeded(const std::vector<CycleReport>& reports) {
  return std::any_of(
      reports.begin(), reports.end(), [](const CycleReport& report) { return report.success; });
}

}  // namespace

// Refinements with other effects take a second: a copy of the session keeps nobody waiting.
bool CalibrationNode::explainSamples(msg::Diagnose::Request& /*request*/,
                                     msg::Diagnose::Response& response) {
  try {
    std::unique_lock<std::mutex> lock(session_mutex_);
    const CalibrationSession session = session_.calibration();
    lock.unlock();
    const std::vector<Diagnosis> diagnoses = sac::diagnose(session);
    response.success = 1;
    response.message = verdictInWords(session, diagnoses);
    response.diagnoses = diagnosesToRos(diagnoses);
  } catch (const std::exception& error) {
    response.success = 0;
    response.message = printable(error.what());
  }
  return true;
}

bool CalibrationNode::checkParameters(msg::Diagnose::Request& /*request*/,
                                      msg::Diagnose::Response& response) {
  try {
    const std::lock_guard<std::mutex> lock(session_mutex_);
    const ValidityCheck check = checkValidity(session_.calibration());
    response.success = static_cast<std::uint8_t>(check.is_valid);
    response.message = check.message;
    response.diagnoses = diagnosesToRos(check.changes);
  } catch (const std::exception& error) {
    response.success = 0;
    response.message = printable(error.what());
  }
  return true;
}

void CalibrationNode::refuseMistakes(const CycleRequest& request,
                                     msg::Calibrate::Response& response) {
  const CalibrationSession& session = session_.calibration();
  if (hasSucceeded(session.reports())) {
    return;
  }
  const std::vector<Diagnosis> mistakes = diagnoseMistakes(session);
  if (mistakes.empty()) {
    return;
  }
  CycleReport refused;
  refused.cycle = request.cycle;
  refused.coil = request.coil;
  refused.message = "The cycle is refused. " + inWords(mistakes);
  response.report = topics_.stamped(reportToRos(refused, session_.grade()));
  response.report.diagnoses = diagnosesToRos(mistakes);
  topics_.publishReport(response.report);
  throw DataError(refused.message);
}

void CalibrationNode::explainFailure(msg::CalibrationReport& report) {
  const std::vector<Diagnosis> diagnoses = sac::diagnose(session_.calibration());
  report.diagnoses = diagnosesToRos(diagnoses);
  if (!diagnoses.empty()) {
    report.message += " " + inWords(diagnoses);
  }
}

}  // namespace sac
