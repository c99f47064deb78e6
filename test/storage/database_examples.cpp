#include "storage/database_examples.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <limits>
#include <random>

#include <SQLiteCpp/Database.h>
#include <SQLiteCpp/Statement.h>

#include "support/scenarios.hpp"

namespace sac::database_examples {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// Draws numbers that use all bits of a double.
class Numbers {
 public:
  explicit Numbers(unsigned seed) : generator_(seed) {}

  double next() { return std::uniform_real_distribution<double>(-1.0, 1.0)(generator_); }
  Eigen::MatrixXd matrix(Eigen::Index rows, Eigen::Index columns) {
    return Eigen::MatrixXd::NullaryExpr(rows, columns, [this] { return next(); });
  }

 private:
  std::mt19937_64 generator_;
};

/// Tells −0 from 0, and takes NaN for itself.
std::uint64_t bitsOf(double value) {
  std::uint64_t bits = 0;
  std::memcpy(&bits, &value, sizeof value);
  return bits;
}

bool isSame(double a, double b) {
  return bitsOf(a) == bitsOf(b);
}

bool isSame(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b) {
  return a.rows() == b.rows() && a.cols() == b.cols() &&
         std::equal(a.data(), a.data() + a.size(), b.data(), [](double p, double q) {
           return isSame(p, q);
         });
}

bool isSame(const ParameterEstimate& a, const ParameterEstimate& b) {
  return a.name == b.name && isSame(a.nominal, b.nominal) && isSame(a.initial, b.initial) &&
         isSame(a.value, b.value) && isSame(a.stddev, b.stddev) && a.observable == b.observable &&
         a.unit == b.unit;
}

bool isSame(const SampleResidual& a, const SampleResidual& b) {
  return a.id == b.id && a.quantity == b.quantity && isSame(a.residual, b.residual) &&
         isSame(a.standardized, b.standardized) && a.rejected == b.rejected && a.reason == b.reason;
}

template <typename Entry>
bool isSame(const std::vector<Entry>& a, const std::vector<Entry>& b) {
  bool same = a.size() == b.size();
  for (std::size_t n = 0; same && n < a.size(); ++n) {
    same = isSame(a[n], b[n]);
  }
  return same;
}

}  // namespace

SessionIdentity identity() {
  SessionIdentity identity;
  identity.start.actuator = scenarios::paperNominal();
  identity.start.actuator.serial = "SA-001";
  identity.software = "0.1.0";
  return identity;
}

SessionIdentity jointIdentity() {
  SessionIdentity result = identity();
  result.start.actuator.poles.clear();
  result.start.actuator.coils.clear();
  result.start.actuator.torque_curve.reset();
  return result;
}

Sample sample(std::uint32_t id, Eigen::Index coils) {
  Numbers numbers(id);
  Sample sample;
  sample.id = id;
  sample.stamp = 1'717'156'800'123'456'789 + id;
  sample.validation = id % 2 == 0;
  sample.joint_position = numbers.matrix(3, 1);
  sample.joint_stddev = numbers.matrix(3, 1);
  sample.has_orientation = true;
  sample.R_stator_rotor = numbers.matrix(3, 3);
  sample.R_stator_rotor(0, 1) = -0.0;
  sample.has_torque = true;
  sample.torque = numbers.matrix(3, 1);
  sample.current = numbers.matrix(coils, 1);
  sample.duration = numbers.next();
  sample.measurements = 500 + id;
  sample.orientation_stddev = numbers.next();
  sample.torque_stddev = 5e-324;
  sample.dwell = sample.stamp - 250'000'000;
  sample.joint_shared_stddev = numbers.matrix(3, 1);
  sample.torque_shared_stddev = -0.0;
  return sample;
}

MotionSlice window(unsigned seed, Eigen::Index coils) {
  constexpr Stamp kStep = 1'000'000;  // [ns]
  constexpr Stamp kWindow = 250'000'000;
  constexpr int kReadings = 370;
  Numbers numbers(seed);
  MotionSlice slice;
  slice.window = {60, 310};
  MotionStreams& streams = slice.streams;
  streams.currents = StreamCurrents(kReadings, coils);
  for (int n = 0; n < kReadings; ++n) {
    const Stamp stamp = seed * kWindow + n * kStep;
    streams.joint_stamps.push_back(stamp);
    streams.joints.emplace_back(numbers.matrix(3, 1));
    streams.current_stamps.push_back(stamp + 1);
    streams.currents.row(n) = numbers.matrix(1, coils).cast<float>();
    if (n % 4 == 0) {
      const Eigen::Vector4d components = numbers.matrix(4, 1);
      streams.orientation_stamps.push_back(stamp + 2);
      streams.orientations.push_back(Eigen::Quaterniond(components).normalized());
    }
  }
  return slice;
}

CalibrationState state(unsigned seed, Eigen::Index parameters) {
  Numbers numbers(seed);
  CalibrationState state;
  state.belief.x = numbers.matrix(parameters, 1);
  state.belief.covariance = numbers.matrix(parameters, parameters);
  state.belief.covariance(0, 0) = -0.0;
  for (Eigen::Index p = 0; p < parameters; ++p) {
    state.identified.push_back(numbers.next() > 0.0);
  }
  return state;
}

CycleReport report(unsigned seed, std::uint32_t samples, Eigen::Index parameters) {
  Numbers numbers(seed);
  CycleReport report;
  report.cycle = Cycle::kCoil;
  report.coil = 2;
  report.success = true;
  report.message = "Coil 3: \"η\" and 'ϕ' identified; refine next.";
  report.samples_used = samples;
  report.samples_rejected = seed;
  report.iterations = 4;
  report.error_measure = ErrorMeasure::kTorque;
  report.error_history = {kInfinity, numbers.next(), -0.0, numbers.next()};
  report.doubts = {"Residuals are 2.0 times \"theirs\".", ""};
  report.degrees_of_freedom = 57;
  report.reduced_chi_square = numbers.next();
  report.condition_number = kInfinity;
  report.solve_time = numbers.next();
  for (Eigen::Index p = 0; p < parameters; ++p) {
    ParameterEstimate estimate;
    estimate.name = "parameter_" + std::to_string(p);
    estimate.nominal = numbers.next();
    estimate.initial = numbers.next();
    estimate.value = numbers.next();
    estimate.stddev = numbers.next();
    estimate.observable = p % 2 == 0;
    estimate.unit = p % 3 == 0 ? "N·m" : "rad";
    report.estimates.push_back(estimate);
  }
  for (std::uint32_t id = 1; id <= samples; ++id) {
    SampleResidual residual;
    residual.id = id;
    residual.quantity = id % 2 == 0 ? Quantity::kTorque : Quantity::kOrientation;
    residual.residual = numbers.next();
    residual.standardized = -kInfinity;
    residual.rejected = id % 3 == 0;
    residual.reason = residual.rejected ? "It is 9 times its uncertainty." : "";
    report.residuals.push_back(residual);
  }
  report.orientation_uncertainty = numbers.next();
  report.torque_uncertainty = numbers.next();
  return report;
}

bool isSame(const MotionSlice& a, const MotionSlice& b) {
  const MotionStreams& p = a.streams;
  const MotionStreams& q = b.streams;
  return a.window.first == b.window.first && a.window.last == b.window.last &&
         p.joint_stamps == q.joint_stamps && p.joints == q.joints &&
         p.current_stamps == q.current_stamps && p.currents == q.currents &&
         p.orientation_stamps == q.orientation_stamps &&
         std::equal(
             p.orientations.begin(),
             p.orientations.end(),
             q.orientations.begin(),
             q.orientations.end(),
             [](const auto& one, const auto& other) { return one.coeffs() == other.coeffs(); });
}

bool isSame(const Sample& a, const Sample& b) {
  return a.id == b.id && a.stamp == b.stamp && a.validation == b.validation &&
         isSame(a.joint_position, b.joint_position) && isSame(a.joint_stddev, b.joint_stddev) &&
         a.has_orientation == b.has_orientation && isSame(a.R_stator_rotor, b.R_stator_rotor) &&
         a.has_torque == b.has_torque && isSame(a.torque, b.torque) &&
         isSame(a.current, b.current) && isSame(a.duration, b.duration) &&
         a.measurements == b.measurements && isSame(a.orientation_stddev, b.orientation_stddev) &&
         isSame(a.torque_stddev, b.torque_stddev) && a.dwell == b.dwell &&
         isSame(a.joint_shared_stddev, b.joint_shared_stddev) &&
         isSame(a.torque_shared_stddev, b.torque_shared_stddev);
}

bool isSame(const CalibrationState& a, const CalibrationState& b) {
  return isSame(a.belief.x, b.belief.x) && isSame(a.belief.covariance, b.belief.covariance) &&
         a.identified == b.identified;
}

bool isSame(const CycleReport& a, const CycleReport& b) {
  return a.cycle == b.cycle && a.coil == b.coil && a.success == b.success &&
         a.contradicted == b.contradicted && a.doubts == b.doubts &&
         a.degrees_of_freedom == b.degrees_of_freedom && a.message == b.message &&
         a.samples_used == b.samples_used && a.samples_rejected == b.samples_rejected &&
         a.iterations == b.iterations && a.error_measure == b.error_measure &&
         isSame(a.error_history, b.error_history) &&
         isSame(a.reduced_chi_square, b.reduced_chi_square) &&
         isSame(a.condition_number, b.condition_number) && isSame(a.solve_time, b.solve_time) &&
         isSame(a.estimates, b.estimates) && isSame(a.residuals, b.residuals) &&
         isSame(a.orientation_uncertainty, b.orientation_uncertainty) &&
         isSame(a.torque_uncertainty, b.torque_uncertainty);
}

MotionSummary summary() {
  Numbers numbers(9);
  MotionSummary summary;
  summary.duration = numbers.next();
  summary.windows = 80;
  summary.used = 71;
  summary.values = 18;
  summary.left_out = {{"the rotor rests", 4}, {"it contradicts \"the others\"", 5}};
  summary.orientations = 4801;
  summary.orientations_rejected = 2;
  summary.joint_stddev = Eigen::Vector3d(numbers.next(), numbers.next(), numbers.next());
  summary.current_stddev = numbers.next();
  summary.orientation_stddev = numbers.next();
  summary.response = CommandResponse{numbers.next(), numbers.next(), numbers.next()};
  summary.held_out.windows = 8;
  summary.held_out.rejected = 1;
  summary.held_out.orientations = 480;
  summary.held_out.orientation_rms = numbers.next();
  summary.held_out.torque_rms = numbers.next();
  summary.held_out.reduced_chi_square = numbers.next();
  summary.held_out.probability = numbers.next();
  for (const std::size_t window : {9U, 19U}) {
    ObservationResidual residual;
    residual.observation = {window, Quantity::kTorque};
    residual.residual = Eigen::Vector3d(numbers.next(), numbers.next(), numbers.next());
    residual.standardized = numbers.next();
    residual.rejected = window > 10;
    summary.held_out.residuals.push_back(residual);
  }
  summary.window_chi_square = numbers.next();
  summary.orientation_chi_square = kInfinity;
  return summary;
}

bool isSame(const MotionSummary& a, const MotionSummary& b) {
  const auto response = [](const MotionSummary& of) {
    const CommandResponse one = of.response.value_or(CommandResponse());
    return Eigen::MatrixXd(Eigen::Vector3d(one.delay, one.lag, one.lateness_stddev));
  };
  const auto numbers = [](const MotionSummary& of) {
    Eigen::MatrixXd all(8, 1);
    all << of.duration, of.current_stddev, of.orientation_stddev, of.held_out.orientation_rms,
        of.held_out.torque_rms, of.held_out.reduced_chi_square, of.held_out.probability,
        of.window_chi_square;
    return all;
  };
  const auto counts = [](const MotionSummary& of) {
    return std::array<std::size_t, 8>{of.windows,
                                      of.used,
                                      of.values,
                                      of.orientations,
                                      of.orientations_rejected,
                                      of.held_out.windows,
                                      of.held_out.rejected,
                                      of.held_out.orientations};
  };
  const bool same_held_out = std::equal(
      a.held_out.residuals.begin(),
      a.held_out.residuals.end(),
      b.held_out.residuals.begin(),
      b.held_out.residuals.end(),
      [](const ObservationResidual& one, const ObservationResidual& other) {
        return one.observation.sample == other.observation.sample &&
               one.observation.quantity == other.observation.quantity &&
               isSame(Eigen::MatrixXd(one.residual), Eigen::MatrixXd(other.residual)) &&
               isSame(one.standardized, other.standardized) && one.rejected == other.rejected;
      });
  return same_held_out && counts(a) == counts(b) && isSame(numbers(a), numbers(b)) &&
         isSame(a.orientation_chi_square, b.orientation_chi_square) &&
         isSame(Eigen::MatrixXd(a.joint_stddev), Eigen::MatrixXd(b.joint_stddev)) &&
         a.response.has_value() == b.response.has_value() && isSame(response(a), response(b)) &&
         std::equal(a.left_out.begin(),
                    a.left_out.end(),
                    b.left_out.begin(),
                    b.left_out.end(),
                    [](const WindowsLeftOut& one, const WindowsLeftOut& other) {
                      return one.reason == other.reason && one.count == other.count;
                    });
}

std::string query(const std::string& path, const std::string& sql) {
  const SQLite::Database database(path, SQLite::OPEN_READWRITE);
  SQLite::Statement statement(database, sql);
  std::string answer;
  while (statement.executeStep()) {
    answer += (answer.empty() ? "" : "\n") + statement.getColumn(0).getString();
  }
  return answer;
}

void change(const std::string& path, const std::string& sql) {
  SQLite::Database(path, SQLite::OPEN_READWRITE).exec(sql);
}

}  // namespace sac::database_examples
