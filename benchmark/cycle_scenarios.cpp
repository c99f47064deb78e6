#include "cycle_scenarios.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <random>
#include <sstream>

#include "spherical_actuator_calibration/base/numbering.hpp"
#include "spherical_actuator_calibration/base/pi.hpp"
#include "support/scenarios.hpp"

namespace sac::benchmarks {
namespace {

constexpr std::uint64_t kSeed = 20;
constexpr double kTilt = 0.6;                // [rad]
constexpr double kCurrent = 2.0;             // [A]
constexpr double kOrientationNoise = 1e-3;   // half width that the stated uncertainty stands for
constexpr double kTorqueNoise = 5e-4;        // the same [N·m]
constexpr std::size_t kPolesCycleCoil = 0;   // coil 1 of the paper
constexpr std::size_t kSingleCycleCoil = 1;  // coil 2 of the paper
constexpr std::size_t kTorquesPerOrientation = 12;
constexpr double kSequenceError = 1e-3;  // standard deviation after the sequence [rad]

std::size_t excitedCoil(Cycle cycle) {
  return cycle == Cycle::kPoles ? kPolesCycleCoil : kSingleCycleCoil;
}

std::vector<Sample> exactOrientations(std::size_t count,
                                      const Actuator& truth,
                                      scenarios::Generator& generator) {
  return scenarios::orientationSamples(truth,
                                       scenarios::randomPoses(count, kTilt, generator),
                                       0.0,
                                       scenarios::uniformStddev(kOrientationNoise),
                                       generator);
}

void addExactTorques(const std::vector<Eigen::Vector3d>& poses,
                     std::size_t coil,
                     const Actuator& truth,
                     scenarios::Generator& generator,
                     std::vector<Sample>& samples) {
  const std::vector<Sample> more = scenarios::torqueSamples(
      truth, poses, coil, kCurrent, 0.0, scenarios::uniformStddev(kTorqueNoise), generator);
  samples.insert(samples.end(), more.begin(), more.end());
}

/// Every coil in turn, each as often as the others.
std::vector<Sample> sessionSamples(std::size_t count, const Actuator& truth) {
  scenarios::Generator generator(kSeed);
  const std::size_t orientations = count / (kTorquesPerOrientation + 1);
  const std::size_t torques = count - orientations;
  std::vector<Sample> samples = exactOrientations(orientations, truth, generator);
  const std::size_t coils = truth.coils.size();
  for (std::size_t coil = 0; coil < coils; ++coil) {
    const std::size_t poses = torques / coils + (coil < torques % coils ? 1 : 0);
    addExactTorques(
        scenarios::randomPoses(poses, kTilt, generator), coil, truth, generator, samples);
  }
  return samples;
}

std::vector<Sample> makeSamples(Cycle cycle, std::size_t count, const Actuator& truth) {
  scenarios::Generator generator(kSeed);
  if (cycle == Cycle::kRefine) {
    return sessionSamples(count, truth);
  }
  if (cycle == Cycle::kJoint) {
    std::vector<Eigen::Vector3d> poses;
    for (std::size_t n = 0; n < count; ++n) {
      poses.push_back(scenarios::randomPose(kTilt, generator));
    }
    return scenarios::orientationSamples(
        truth, poses, 0.0, scenarios::uniformStddev(kOrientationNoise), generator);
  }
  const std::size_t coil = excitedCoil(cycle);
  const std::vector<Eigen::Vector3d> poses =
      scenarios::posesThatSeeEveryPole(truth, coil, count, kTilt, generator);
  return scenarios::torqueSamples(
      truth, poses, coil, kCurrent, 0.0, scenarios::uniformStddev(kTorqueNoise), generator);
}

CalibrationState initialState(Cycle cycle, const ParameterSpace& space, const Actuator& truth) {
  if (cycle == Cycle::kJoint) {
    return nominalState(space, {});
  }
  if (cycle == Cycle::kRefine) {
    CalibrationState state = nominalState(space, {});
    scenarios::Generator generator(kSeed + 1);
    std::normal_distribution<double> error(0.0, kSequenceError);
    state.belief.x = space.coordinatesOf(truth).unaryExpr(
        [&](double coordinate) { return coordinate + error(generator); });
    return state;
  }
  CalibrationState state = scenarios::exactJoints(space, truth, {});
  if (cycle == Cycle::kCoil) {
    const Eigen::Index known = space.coil(0);
    state.belief.x.head(known) = space.coordinatesOf(truth).head(known);
    state.belief.covariance.topRows(known).setZero();
    state.belief.covariance.leftCols(known).setZero();
    std::fill(state.identified.begin(), state.identified.begin() + known, true);
  }
  return state;
}

/// Writes numbers so that they are read back to the last bit.
class JsonWriter {
 public:
  JsonWriter() { out_.precision(std::numeric_limits<double>::max_digits10); }

  template <typename Vector>
  void add(const char* key, const Vector& values) {
    start(key);
    out_ << '[';
    for (Eigen::Index n = 0; n < values.size(); ++n) {
      out_ << (n == 0 ? "" : ", ") << values[n];
    }
    out_ << ']';
  }
  /// Elements are objects, already written.
  void add(const char* key, const std::vector<std::string>& objects) {
    start(key);
    out_ << '[';
    for (std::size_t n = 0; n < objects.size(); ++n) {
      out_ << (n == 0 ? "" : ",\n") << objects[n];
    }
    out_ << ']';
  }
  void addObject(const char* key, const std::string& object) {
    start(key);
    out_ << object;
  }
  void addNumber(const char* key, double value) {
    start(key);
    out_ << value;
  }
  std::string text() const { return "{" + out_.str() + "}"; }

 private:
  void start(const char* key) { out_ << (out_.tellp() == 0 ? "" : ", ") << '"' << key << "\": "; }

  std::ostringstream out_;
};

std::string toJson(const Actuator& actuator) {
  JsonWriter json;
  std::vector<std::string> joints;
  for (const JointAxis& joint : actuator.joints) {
    JsonWriter entry;
    entry.add("axis", joint.axis);
    entry.addNumber("offset", joint.offset);
    joints.push_back(entry.text());
  }
  std::vector<std::string> poles;
  for (const PoleAxis& pole : actuator.poles) {
    JsonWriter entry;
    entry.add("angles", Eigen::Vector2d(pole.polar, pole.azimuth));
    entry.addNumber("polarity", pole.polarity);
    poles.push_back(entry.text());
  }
  std::vector<std::string> coils;
  for (const CoilAxis& coil : actuator.coils) {
    JsonWriter entry;
    entry.add("angles", Eigen::Vector2d(coil.polar, coil.azimuth));
    coils.push_back(entry.text());
  }
  json.add("joints", joints);
  json.add("poles", poles);
  json.add("coils", coils);
  return json.text();
}

std::string toJson(const TorqueCurve& curve) {
  const std::vector<double>& coefficients = curve.coefficientsInRadians();
  JsonWriter json;
  json.add("coefficients",
           Eigen::Map<const Eigen::VectorXd>(coefficients.data(),
                                             static_cast<Eigen::Index>(coefficients.size())));
  json.addNumber("blend_start", curve.blendStart());
  json.addNumber("support_begin", curve.supportBegin());
  json.addNumber("support_end", curve.supportEnd());
  json.addNumber("k1", curve.linearCoefficient());
  json.addNumber("k3", curve.cubicCoefficient());
  return json.text();
}

std::string toJson(const Sample& sample) {
  JsonWriter json;
  json.add("q", sample.joint_position);
  const Eigen::Matrix3d by_rows = sample.R_stator_rotor.transpose();
  json.add("R", Eigen::Map<const Eigen::Matrix<double, 9, 1>>(by_rows.data()));
  json.add("torque", sample.torque);
  json.add("current", sample.current);
  return json.text();
}

}  // namespace

CycleScenario manyCoilsScenario(std::size_t coils, std::size_t samples) {
  constexpr std::size_t kLayers = 8;
  constexpr double kHighest = 0.35;     // elevation of the outermost layers [rad]
  constexpr double kMadeWithin = 0.02;  // errors of manufacture [rad]
  scenarios::Generator generator(kSeed);
  Actuator nominal = scenarios::paperNominal();
  nominal.coils.clear();
  for (std::size_t j = 0; j < coils; ++j) {
    const std::size_t layer = j % kLayers;
    const double elevation =
        kHighest * (2.0 * static_cast<double>(layer) / static_cast<double>(kLayers - 1) - 1.0);
    nominal.coils.push_back(
        {elevation, 2.0 * kPi * static_cast<double>(j) / static_cast<double>(coils), 1.0});
  }
  const Actuator truth = scenarios::perturbed(nominal, kMadeWithin, kMadeWithin, generator);
  const std::size_t orientations = samples / (kTorquesPerOrientation + 1);
  std::vector<Sample> session = exactOrientations(orientations, truth, generator);
  const std::size_t each = std::max(nominal.poles.size(), (samples - orientations) / coils);
  for (std::size_t coil = 0; coil < coils; ++coil) {
    addExactTorques(scenarios::posesThatSeeEveryPole(truth, coil, each, kTilt, generator),
                    coil,
                    truth,
                    generator,
                    session);
  }
  CalibrationModel model{ParameterSpace(nominal)};
  CalibrationState state = initialState(Cycle::kRefine, model.space(), truth);
  return {std::move(model), {Cycle::kRefine, std::nullopt}, std::move(session), state, truth};
}

CycleScenario cycleScenario(Cycle cycle, std::size_t samples) {
  const Actuator truth = scenarios::paperTruth();
  CalibrationModel model{ParameterSpace(scenarios::paperNominal())};
  CalibrationState state = initialState(cycle, model.space(), truth);
  const bool has_coil = cycle == Cycle::kPoles || cycle == Cycle::kCoil;
  const CycleRequest request{
      cycle, has_coil ? std::optional<std::size_t>(excitedCoil(cycle)) : std::nullopt};
  return {std::move(model), request, makeSamples(cycle, samples, truth), std::move(state), truth};
}

EstimationProblem problemOf(const CycleScenario& scenario) {
  EstimationProblem problem;
  problem.model = &scenario.model;
  problem.samples = &scenario.samples;
  problem.observations =
      selectObservations(scenario.model.space(), scenario.samples, scenario.request, {});
  problem.prior = scenario.state.belief;
  return problem;
}

double worstError(const CycleScenario& scenario, const Eigen::VectorXd& x) {
  const ParameterSpace& space = scenario.model.space();
  const Eigen::VectorXd truth = space.coordinatesOf(scenario.truth);
  double worst = 0.0;
  for (const Eigen::Index p : selectCoordinates(space, scenario.samples, scenario.request, {})) {
    worst = std::max(worst, std::abs(x[p] - truth[p]));
  }
  return worst;
}

std::string toJson(const CycleScenario& scenario, const CalibrationState& solution) {
  const ParameterSpace& space = scenario.model.space();
  JsonWriter json;
  json.addNumber("coil", static_cast<double>(numberOrZero(scenario.request.coil)));
  json.addObject("initial", toJson(space.actuatorAt(scenario.state.belief.x)));
  json.addObject("solution", toJson(space.actuatorAt(solution.belief.x)));
  json.addObject("curve", toJson(scenario.model.curve()));
  std::vector<std::string> samples;
  for (const Sample& sample : scenario.samples) {
    samples.push_back(toJson(sample));
  }
  json.add("samples", samples);
  return json.text();
}

}  // namespace sac::benchmarks
