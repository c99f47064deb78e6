// motion_cases ACTUATOR.yaml STREAMS.txt...: runs the cycle motion on each file of streams and
// prints what came out, one line a fact, for programs that know the truth and share no code with
// this package; last the rows of the covariance of all parameters. A line of a file is J, C, U or
// O, a stamp [ns], and values: joint angles, currents, commands, or an orientation as x y z w. With
// --live the windows are taken as they come, and one more line tells how far that is from all of
// them at once.

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <exception>
#include <fstream>
#include <optional>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "spherical_actuator_calibration/actuator/description_file.hpp"
#include "spherical_actuator_calibration/assessment/reported_covariance.hpp"
#include "spherical_actuator_calibration/calibration/calibration_config.hpp"
#include "spherical_actuator_calibration/estimation/calibration_state.hpp"
#include "spherical_actuator_calibration/motion/better_currents.hpp"
#include "spherical_actuator_calibration/motion/live_motion.hpp"
#include "spherical_actuator_calibration/motion/motion_estimator.hpp"
#include "support/motion_slices.hpp"

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
    } else if (kind == 'U') {
      const auto count = static_cast<Eigen::Index>(values.size());
      recorder.add(CurrentCommand{stamp, Eigen::Map<const Eigen::VectorXd>(values.data(), count)});
    } else {
      recorder.add(OrientationMeasurement{
          stamp, Eigen::Quaterniond(values[3], values[0], values[1], values[2])});
    }
  }
  return recorder.take();
}

/// Puts the estimate of windows as they came in place of that of all at once.
void followLive(const MotionProblem& problem, MotionEstimate& found) {
  LiveMotion live(*problem.model, problem.prior, problem.free, EstimationOptions());
  MotionRecording taken;
  for (const MotionStreams& streams : problem.recording->spans) {
    for (const MotionSlice& slice : slicesOf(streams)) {
      taken.spans.push_back(slice.streams);
      taken.windows.push_back(slice.window);
      live.add(slice);
    }
  }
  MotionProblem again = problem;
  again.recording = &taken;
  const ParameterBelief whole = estimateMotion(again, {}, {}).estimate.belief;
  const LiveEstimate& last = live.estimate();
  const Eigen::ArrayXd stddevs = whole.covariance.diagonal().array().sqrt();
  const Eigen::ArrayXd apart = (last.belief.x - whole.x).array() / stddevs;
  const Eigen::ArrayXd ratios = last.belief.covariance.diagonal().array().sqrt() / stddevs;
  std::printf("live %zu left_out %zu linearizations %d worst %.6g rms %.6g ratios %.6g %.6g\n",
              last.windows,
              last.left_out,
              last.linearizations,
              apart.abs().maxCoeff(),
              std::sqrt(apart.square().mean()),
              ratios.minCoeff(),
              ratios.maxCoeff());
  found.estimate.belief = last.belief;
  found.summary.window_chi_square = last.chi_square;
}

void printParameters(const ParameterSpace& space, const Estimate& estimate) {
  const Eigen::VectorXd values = space.reportedValues(estimate.belief.x);
  const Eigen::VectorXd stddevs =
      space.reportedStddevs(estimate.belief.x, estimate.belief.covariance);
  for (Eigen::Index p = 0; p < space.size(); ++p) {
    const bool is_open =
        std::count(estimate.unobservable.begin(), estimate.unobservable.end(), p) != 0;
    std::printf("parameter %s %.17g %.17g %s\n",
                space.name(p).c_str(),
                values[p],
                stddevs[p],
                is_open ? "open" : "identified");
  }
  const Eigen::MatrixXd jacobian = reportedJacobian(space, estimate.belief.x);
  const Eigen::MatrixXd covariance = jacobian * estimate.belief.covariance * jacobian.transpose();
  for (Eigen::Index row = 0; row < covariance.rows(); ++row) {
    std::printf("covariance");
    for (Eigen::Index column = 0; column < covariance.cols(); ++column) {
      std::printf(" %.17g", covariance(row, column));
    }
    std::printf("\n");
  }
}

/// χ² of an error that the model lacks, and its values with their standard deviations.
void printUnmodelled(const UnmodelledError& one) {
  std::printf("unmodelled %d %zu chi_square %.6g of %td distance %.3g %s %.3g",
              static_cast<int>(one.kind),
              one.joint + 1,
              one.value.dot(one.covariance.ldlt().solve(one.value)),
              one.value.size(),
              one.distance,
              one.most_shifted.c_str(),
              one.shift);
  for (Eigen::Index n = 0; n < one.value.size(); ++n) {
    std::printf(" %.6g %.3g", one.value[n], std::sqrt(one.covariance(n, n)));
  }
  std::printf("\n");
}

void printSkew(const JointSkew& skew) {
  if (!skew.isTold()) {
    return;
  }
  const Eigen::Vector2d stddev = skew.covariance.diagonal().cwiseSqrt();
  std::printf("skew %.6g %.3g %.6g %.3g shift %.3g %s of %.3g\n",
              skew.value[0],
              stddev[0],
              skew.value[1],
              stddev[1],
              skew.shift,
              skew.most_shifted.c_str(),
              skew.distance);
}

void calibrate(const Actuator& nominal,
               const EffectSelection& effects,
               bool is_live,
               const char* path) {
  const MotionRecording recording = readStreams(path, nominal.coils.size());
  const CalibrationModel model(ParameterSpace(nominal, withMotionEffects(effects)));
  MotionProblem problem;
  problem.model = &model;
  problem.recording = &recording;
  problem.prior = nominalState(model.space(), {}).belief;
  for (Eigen::Index p = 0; p < model.space().size(); ++p) {
    problem.free.push_back(p);
  }
  const std::optional<MotionRecording> commanded = byCommands(recording);
  MotionEstimate found = estimateByBetterCurrents(commanded, {}, problem);
  if (is_live) {
    followLive(problem, found);
  }
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
  std::printf("tracker colour %.6g alike %.3g\n", found.tracker_colour, found.orientations.alike);
  std::printf("alignment %.6g limit %.6g\n", found.alignment.ratio, found.alignment.limit());
  printSkew(found.skew);
  for (const UnmodelledError& one : found.unmodelled) {
    printUnmodelled(one);
  }
  for (const WindowsLeftOut& left_out : summary.left_out) {
    std::printf("left_out %zu %s\n", left_out.count, left_out.reason.c_str());
  }
  if (summary.response) {
    const CommandResponse& response = *summary.response;
    std::printf(
        "response %.9g %.9g %.3g\n", response.delay, response.lag, response.lateness_stddev);
  }
  printParameters(model.space(), estimate);
}

}  // namespace
}  // namespace sac

int main(int argc, char** argv) {
  try {
    const sac::Actuator nominal = sac::loadActuator(argv[1]);
    sac::EffectSelection effects;
    bool is_live = false;
    for (int k = 2; k < argc; ++k) {
      const std::string word = argv[k];
      if (word.rfind("--model=", 0) == 0) {
        effects[word.substr(8)] = true;
      } else if (word == "--live") {
        is_live = true;
      } else {
        sac::calibrate(nominal, effects, is_live, argv[k]);
      }
    }
  } catch (const std::exception& error) {
    std::fprintf(stderr, "motion_cases: %s\n", error.what());
    return 2;
  }
  return 0;
}
