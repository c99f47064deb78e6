#include "support/synthetic_streams.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <random>

#include "spherical_actuator_calibration/base/rotations.hpp"

namespace sac::synthetic {
namespace {

using Generator = std::mt19937_64;

/// Stamp of the begin of every script.
constexpr Stamp kBegin = 1'600'000'000'000'000'000;

Eigen::VectorXd normal(Eigen::Index size, double stddev, Generator& generator) {
  std::normal_distribution<double> distribution(0.0, 1.0);
  Eigen::VectorXd noise(size);
  for (double& value : noise) {
    value = stddev * distribution(generator);
  }
  return noise;
}

/// Times of measurement at a rate, with a random phase and jitter.
std::vector<double> timesAt(double rate, double jitter, double duration, Generator& generator) {
  std::vector<double> times;
  if (rate <= 0.0) {
    return times;
  }
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  const double phase = unit(generator);
  for (double index = 0.0; (index + 1.0) / rate < duration; index += 1.0) {
    times.push_back((index + 0.5 * phase + 0.5 * jitter * unit(generator)) / rate);
  }
  return times;
}

/// One measurement on its way into the builder.
struct Arrival {
  double time;
  std::function<void(SampleBuilder&)> add;
};

template <typename Measurement>
void appendArrivals(const std::vector<Measurement>& stream,
                    double largest_delay,
                    Generator& generator,
                    std::vector<Arrival>& arrivals) {
  std::uniform_real_distribution<double> delay(0.0, largest_delay);
  // A wrong stamp does not change when a measurement arrives.
  constexpr double kLargestStep = 5.0;
  double previous = 0.0;
  for (const Measurement& measurement : stream) {
    const double arrival =
        timeOf(measurement.stamp) + (largest_delay > 0.0 ? delay(generator) : 0.0);
    if (arrival < previous + kLargestStep) {
      previous = std::max(previous, arrival);
    }
    arrivals.push_back(
        {previous, [&measurement](SampleBuilder& builder) { builder.add(measurement); }});
  }
}

}  // namespace

Stamp stampAt(double time) {
  return kBegin + ticksFromSeconds(time);
}

double timeOf(Stamp stamp) {
  return secondsBetween(kBegin, stamp);
}

Script::Script(std::size_t coils)
    : zero_current_(Eigen::VectorXd::Zero(static_cast<Eigen::Index>(coils))) {}

Script& Script::moveTo(const Eigen::Vector3d& position, double duration) {
  return append(Profile::kMinimumJerk, duration, position, zero_current_, zero_current_);
}

Script& Script::driftBy(const Eigen::Vector3d& step, double duration) {
  const Eigen::VectorXd current = phases_.empty() ? zero_current_ : phases_.back().current_to;
  return append(Profile::kUniform, duration, position(this->duration()) + step, current, current);
}

Script& Script::rest(double duration) {
  return append(
      Profile::kUniform, duration, position(this->duration()), zero_current_, zero_current_);
}

Script& Script::excite(std::size_t coil, double current, double duration) {
  Eigen::VectorXd currents = zero_current_;
  currents[static_cast<Eigen::Index>(coil)] = current;
  return append(Profile::kUniform, duration, position(this->duration()), currents, currents);
}

Script& Script::rampTo(std::size_t coil, double current, double duration) {
  const Eigen::VectorXd from = phases_.empty() ? zero_current_ : phases_.back().current_to;
  Eigen::VectorXd to = from;
  to[static_cast<Eigen::Index>(coil)] = current;
  return append(Profile::kUniform, duration, position(this->duration()), from, to);
}

double Script::duration() const {
  return phases_.empty() ? 0.0 : phases_.back().begin + phases_.back().duration;
}

Eigen::Vector3d Script::position(double time) const {
  if (phases_.empty()) {
    return Eigen::Vector3d::Zero();
  }
  const Phase& phase = phaseAt(time);
  const double s = std::clamp((time - phase.begin) / phase.duration, 0.0, 1.0);
  const double share =
      phase.profile == Profile::kUniform ? s : s * s * s * (10.0 - 15.0 * s + 6.0 * s * s);
  return phase.from + share * (phase.to - phase.from);
}

Eigen::VectorXd Script::current(double time) const {
  const Phase& phase = phaseAt(time);
  const double s = std::clamp((time - phase.begin) / phase.duration, 0.0, 1.0);
  return phase.current_from + s * (phase.current_to - phase.current_from);
}

Eigen::Matrix3d Script::orientation(const Eigen::Vector3d& position) {
  return rotationExp(position.x() * Eigen::Vector3d::UnitX()) *
         rotationExp(position.y() * Eigen::Vector3d::UnitY()) *
         rotationExp(position.z() * Eigen::Vector3d::UnitZ());
}

Eigen::Vector3d Script::torque(const Eigen::VectorXd& current) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (Eigen::Index j = 0; j < current.size(); ++j) {
    const auto angle = static_cast<double>(j);
    sum += 0.1 * current[j] * Eigen::Vector3d(std::cos(angle), std::sin(angle), 0.5);
  }
  return sum;
}

Script& Script::append(Profile profile,
                       double duration,
                       const Eigen::Vector3d& to,
                       const Eigen::VectorXd& current_from,
                       const Eigen::VectorXd& current_to) {
  const double begin = this->duration();
  phases_.push_back({begin, duration, profile, position(begin), to, current_from, current_to});
  return *this;
}

const Script::Phase& Script::phaseAt(double time) const {
  const auto next =
      std::upper_bound(phases_.begin(), phases_.end(), time, [](double value, const Phase& phase) {
        return value < phase.begin;
      });
  return next == phases_.begin() ? *next : *(next - 1);
}

Streams record(const Script& script, const Sensors& sensors, std::uint64_t seed) {
  Generator generator(seed);
  const double duration = script.duration();
  Streams streams;
  for (const double t : timesAt(sensors.joint_rate, sensors.jitter, duration, generator)) {
    streams.joints.push_back(
        {stampAt(t), script.position(t) + normal(3, sensors.joint_noise, generator)});
  }
  for (const double t : timesAt(sensors.orientation_rate, sensors.jitter, duration, generator)) {
    const Eigen::Matrix3d R = rotationExp(normal(3, sensors.orientation_noise, generator)) *
                              Script::orientation(script.position(t));
    streams.orientations.push_back({stampAt(t), Eigen::Quaterniond(R)});
  }
  for (const double t : timesAt(sensors.torque_rate, sensors.jitter, duration, generator)) {
    streams.torques.push_back({stampAt(t),
                               Script::torque(script.current(t)) + sensors.torque_bias +
                                   normal(3, sensors.torque_noise, generator)});
  }
  for (const double t : timesAt(sensors.current_rate, sensors.jitter, duration, generator)) {
    Eigen::VectorXd current = script.current(t);
    current += normal(current.size(), sensors.current_noise, generator);
    current.array() += sensors.current_offset;
    streams.currents.push_back({stampAt(t), current});
  }
  return streams;
}

void feed(SampleBuilder& builder, const Streams& streams) {
  feedDelayed(builder, streams, 0.0, 0);
}

void feedDelayed(SampleBuilder& builder,
                 const Streams& streams,
                 double largest_delay,
                 std::uint64_t seed) {
  Generator generator(seed);
  std::vector<Arrival> arrivals;
  appendArrivals(streams.joints, largest_delay, generator, arrivals);
  appendArrivals(streams.orientations, largest_delay, generator, arrivals);
  appendArrivals(streams.torques, largest_delay, generator, arrivals);
  appendArrivals(streams.currents, largest_delay, generator, arrivals);
  std::stable_sort(arrivals.begin(), arrivals.end(), [](const Arrival& a, const Arrival& b) {
    return a.time < b.time;
  });
  for (const Arrival& arrival : arrivals) {
    arrival.add(builder);
  }
}

std::vector<Sample> samplesOf(SampleBuilder& builder, const Streams& streams) {
  feed(builder, streams);
  builder.finish();
  return builder.takeSamples();
}

}  // namespace sac::synthetic
