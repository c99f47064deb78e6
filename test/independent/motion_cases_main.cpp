// motion_cases ACTUATOR.yaml STREAMS.txt...: runs the cycle motion on each file of streams and
// prints what came out, one line a fact, for programs that know the truth and share no code with
// this package; last the rows of the covariance of all parameters. A line of a file is J, C or O, a
// stamp [ns], and values: joint angles, currents, or an orientation as x y z w.

#include <algorithm>
#include <cstdio>
#include <exception>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "spherical_actuator_calibration/actuator/description_file.hpp"
#include "spherical_actuator_calibration/assessment/reported_covariance.hpp"
#include "spherical_actuator_calibration/calibration/calibration_config.hpp"
#include "spherical_actuator_calibration/estimation/calibration_state.hpp"
#include "spherical_actuator_calibration/motion/motion_estimator.hpp"

namespace sac {
namespace {

MotionRecording readStreams(const char* path, std::size_t coils) {
  std::ifstream file(path);
  MotionRecorder recorder(coils);
  std::string line;
  while (std::getline(file, line)) {
    std::istringstream words(line);
    char kind = 0;
    Stamp stamp = 0;
    words >> kind >> stamp;
    std::vector<double> values;
    for (double value = 0.0; words >> value;) {
      values.push_back(value);
    }
    if (kind == 'J') {
      recorder.add(JointMeasurement{stamp, Eigen::Vector3d(values.data())});
    } else if (kind == 'C') {
      const auto count = static_cast<Eigen::Index>(values.size());
      recorder.add(
          CurrentMeasurement{stamp, Eigen::Map<const Eigen::VectorXd>(values.data(), count)});
    } else {
      recorder.add(OrientationMeasurement{
          stamp, Eigen::Quaterniond(values[3], values[0], values[1], values[2])});
    }
  }
  return recorder.take();
}

void calibrate(const Actuator& nominal, const EffectSelection& effects, const char* path) {
  const MotionRecording recording = readStreams(path, nominal.coils.size());
  const CalibrationModel model(ParameterSpace(nominal, withMotionEffects(effects)));
  MotionProblem problem;
  problem.model = &model;
  problem.recording = &recording;
  problem.prior = nominalState(model.space(), {}).belief;
  for (Eigen::Index p = 0; p < model.space().size(); ++p) {
    problem.free.push_back(p);
  }
  const MotionEstimate found = estimateMotion(problem, {}, {});
  const Estimate& estimate = found.estimate;
  const MotionSummary& summary = found.summary;
  std::printf("case %s\n", path);
  std::printf(
      "motion %s termination %d used %zu chi_square %.6g %.6g noise %.3g %.3g %.3g %.3g "
      "%.3g iterations %d time %.3g\n",
      tellsMotion(recording) ? "moves" : "rests",
      static_cast<int>(estimate.termination),
      summary.used,
      summary.window_chi_square,
      summary.orientation_chi_square,
      summary.joint_stddev[0],
      summary.joint_stddev[1],
      summary.joint_stddev[2],
      summary.current_stddev,
      summary.orientation_stddev,
      estimate.iterations,
      estimate.solve_time);
  std::printf("held_out %zu chi_square %.6g probability %.6g\n",
              summary.held_out.windows,
              summary.held_out.reduced_chi_square,
              summary.held_out.probability);
  for (const WindowsLeftOut& left_out : summary.left_out) {
    std::printf("left_out %zu %s\n", left_out.count, left_out.reason.c_str());
  }
  const Eigen::VectorXd values = model.space().reportedValues(estimate.belief.x);
  const Eigen::VectorXd stddevs =
      model.space().reportedStddevs(estimate.belief.x, estimate.belief.covariance);
  for (Eigen::Index p = 0; p < model.space().size(); ++p) {
    const bool is_open =
        std::count(estimate.unobservable.begin(), estimate.unobservable.end(), p) != 0;
    std::printf("parameter %s %.17g %.17g %s\n",
                model.space().name(p).c_str(),
                values[p],
                stddevs[p],
                is_open ? "open" : "identified");
  }
  const Eigen::MatrixXd jacobian = reportedJacobian(model.space(), estimate.belief.x);
  const Eigen::MatrixXd covariance = jacobian * estimate.belief.covariance * jacobian.transpose();
  for (const auto& row : covariance.rowwise()) {
    std::printf("covariance");
    for (const double value : row) {
      std::printf(" %.17g", value);
    }
    std::printf("\n");
  }
}

}  // namespace
}  // namespace sac

int main(int argc, char** argv) {
  try {
    const sac::Actuator nominal = sac::loadActuator(argv[1]);
    sac::EffectSelection effects;
    for (int k = 2; k < argc; ++k) {
      const std::string word = argv[k];
      if (word.rfind("--model=", 0) == 0) {
        effects[word.substr(8)] = true;
      } else {
        sac::calibrate(nominal, effects, argv[k]);
      }
    }
  } catch (const std::exception& error) {
    std::fprintf(stderr, "motion_cases: %s\n", error.what());
    return 2;
  }
  return 0;
}
