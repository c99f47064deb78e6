#include "spherical_actuator_calibration/drivers/joint_sensor.hpp"

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

#include <Eigen/LU>

#include "spherical_actuator_calibration/actuator/actuator.hpp"
#include "spherical_actuator_calibration/actuator/inverse_kinematics.hpp"
#include "spherical_actuator_calibration/base/error.hpp"
#include "spherical_actuator_calibration/base/numbering.hpp"

namespace sac {
namespace {

std::vector<RegisterRequest> requestsFor(const JointSensorOptions& options) {
  std::vector<RegisterRequest> requests;
  if (options.tilt) {
    requests.push_back(requestFor(options.tilt->x));
    requests.push_back(requestFor(options.tilt->y));
  }
  for (const EncoderOptions& encoder : options.encoders) {
    requests.push_back(requestFor(encoder.field));
  }
  return joinedRequests(std::move(requests));
}

TiltSensorOptions readTilt(const YamlMap& map) {
  TiltSensorOptions tilt;
  tilt.x = readRegisterField(map.map("x"));
  tilt.y = readRegisterField(map.map("y"));
  if (map.has("matrix")) {
    const std::vector<double> m = map.numbers("matrix", ValueRange::closed(-2.0, 2.0), 4);
    tilt.matrix << m[0], m[1], m[2], m[3];
    constexpr double kSmallestDeterminant = 0.1;
    if (std::abs(tilt.matrix.determinant()) < kSmallestDeterminant) {
      map.fail("matrix", "it is nearly singular: the two channels would tell the same.");
    }
  }
  return tilt;
}

EncoderOptions readEncoder(const YamlMap& map) {
  EncoderOptions encoder;
  encoder.joint = static_cast<std::size_t>(map.integer("joint", 1, kJoints, 3)) - 1;
  encoder.field = readRegisterField(map);
  encoder.counts_per_turn =
      map.number("counts_per_turn", ValueRange::nonNegative(), encoder.counts_per_turn);
  return encoder;
}

template <std::size_t N>
std::array<double, N> readSmall(const YamlMap& map, const char* key) {
  // Far beyond what a sensor is off by, and uncorrected() converges.
  constexpr double kLargest = 0.05;
  std::array<double, N> values = {};
  if (map.has(key)) {
    const std::vector<double> read = map.numbers(key, ValueRange::closed(-kLargest, kLargest), N);
    std::copy(read.begin(), read.end(), values.begin());
  }
  return values;
}

void readCorrections(const YamlMap& map, std::array<ReadingCorrection, kJoints>& corrections) {
  std::set<std::size_t> joints;
  for (const YamlMap& item : map.maps("corrections")) {
    const auto joint = static_cast<std::size_t>(item.integer("joint", 1, kJoints)) - 1;
    if (!joints.insert(joint).second) {
      item.fail("joint", "this joint has corrections already.");
    }
    corrections[joint] = {readSmall<kJoints>(item, "linear"), readSmall<4>(item, "harmonics")};
  }
}

JointGeometry geometryOf(const std::array<ReadingCorrection, kJoints>& corrections) {
  std::array<JointAxis, kJoints> joints;
  for (std::size_t k = 0; k < kJoints; ++k) {
    joints[k].correction = corrections[k];
  }
  return jointGeometry(joints);
}

/// Angles that become q by the corrections.
Eigen::Vector3d uncorrected(const JointGeometry& corrections, const Eigen::Vector3d& q) {
  constexpr int kRounds = 40;  // each leaves less than half of what is missing
  Eigen::Vector3d reading = q;
  for (int round = 0; corrections.is_corrected && round < kRounds; ++round) {
    reading += q - correctedReading(corrections, reading);
  }
  return reading;
}

void requireEachJointOnce(const JointSensorOptions& options, const YamlMap& map) {
  std::array<int, kJoints> sensors = {};
  if (options.tilt) {
    ++sensors[0];
    ++sensors[1];
  }
  for (const EncoderOptions& encoder : options.encoders) {
    ++sensors[encoder.joint];
  }
  for (std::size_t k = 0; k < kJoints; ++k) {
    if (sensors[k] != 1) {
      map.fail("encoders",
               "joint " + std::to_string(numberOf(k)) + " has " + std::to_string(sensors[k]) +
                   " sensors; each joint needs one.");
    }
  }
}

double angleOf(const RegisterField& field, const std::uint16_t* words, const char* name) {
  const double angle = field.decode(words);
  if (!std::isfinite(angle)) {
    throw DataError(std::string("The ") + name + " reads no finite number.");
  }
  return angle;
}

}  // namespace

JointSensorOptions readJointSensorOptions(const YamlMap& map) {
  JointSensorOptions options;
  options.link = readModbusLink(map.map("link"));
  options.rate = map.number("rate", ValueRange::closed(0.1, 5000.0, "Hz"), options.rate);
  if (map.has("tilt")) {
    options.tilt = readTilt(map.map("tilt"));
  }
  for (const YamlMap& item : map.maps("encoders")) {
    options.encoders.push_back(readEncoder(item));
  }
  requireEachJointOnce(options, map);
  if (map.has("corrections")) {
    readCorrections(map, options.corrections);
  }
  return options;
}

JointSensor::JointSensor(const JointSensorOptions& options, ModbusTransport& transport)
    : options_(options),
      corrections_(geometryOf(options.corrections)),
      transport_(transport),
      requests_(requestsFor(options)),
      answers_(requests_.size()),
      last_angles_(options.encoders.size()) {}

Eigen::Vector3d JointSensor::read() {
  for (std::size_t n = 0; n < requests_.size(); ++n) {
    const RegisterRequest& request = requests_[n];
    answers_[n] = transport_.read(request.unit, request.table, request.address, request.count);
  }
  Eigen::Vector3d q = Eigen::Vector3d::Zero();
  if (options_.tilt) {
    const TiltSensorOptions& tilt = *options_.tilt;
    const Eigen::Vector2d readings(angleOf(tilt.x, words(tilt.x), "tilt sensor's channel x"),
                                   angleOf(tilt.y, words(tilt.y), "tilt sensor's channel y"));
    const std::optional<Eigen::Vector2d> joints = jointsOf(tilt.matrix * readings);
    if (!joints) {
      throw DataError("The tilt sensor reads inclinations of " + std::to_string(readings.x()) +
                      " and " + std::to_string(readings.y()) +
                      " rad, which no pose has: check its registers and scale.");
    }
    q.head<2>() = *joints;
  }
  for (std::size_t n = 0; n < options_.encoders.size(); ++n) {
    const EncoderOptions& encoder = options_.encoders[n];
    q[static_cast<Eigen::Index>(encoder.joint)] =
        unwrapped(n, angleOf(encoder.field, words(encoder.field), "encoder"));
  }
  return correctedReading(corrections_, q);
}

const std::uint16_t* JointSensor::words(const RegisterField& field) const {
  for (std::size_t n = 0; n < requests_.size(); ++n) {
    const RegisterRequest& request = requests_[n];
    if (request.holds(requestFor(field))) {
      return &answers_[n][static_cast<std::size_t>(field.address - request.address)];
    }
  }
  throw DataError("A register of the joint sensors is in no request.");
}

// Before the first reading the angle nearest to zero is taken.
double JointSensor::unwrapped(std::size_t encoder, double angle) {
  const EncoderOptions& options = options_.encoders[encoder];
  const double turn = options.field.scale * options.counts_per_turn;
  if (turn > 0.0) {
    angle -= turn * std::round((angle - last_angles_[encoder].value_or(0.0)) / turn);
  }
  last_angles_[encoder] = angle;
  return angle;
}

Eigen::Vector2d inclinationsOf(const Eigen::Vector2d& q) {
  return {q[0], std::asin(std::cos(q[0]) * std::sin(q[1]))};
}

std::optional<Eigen::Vector2d> jointsOf(const Eigen::Vector2d& inclinations) {
  const double q1 = inclinations[0];
  if (!(std::abs(q1) <= kGimbalLock) || !(std::abs(inclinations[1]) <= kGimbalLock)) {
    return std::nullopt;
  }
  const double sine = std::sin(inclinations[1]) / std::cos(q1);
  if (std::abs(sine) > 1.0) {
    return std::nullopt;
  }
  return Eigen::Vector2d(q1, std::asin(sine));
}

std::vector<RegisterContent> encodeJoints(const JointSensorOptions& options,
                                          const Eigen::Vector3d& corrected) {
  const Eigen::Vector3d q = uncorrected(geometryOf(options.corrections), corrected);
  std::vector<RegisterContent> contents;
  const auto put = [&contents](const RegisterField& field, double value) {
    contents.push_back({field.unit, field.table, field.address, field.encode(value)});
  };
  if (options.tilt) {
    const Eigen::Vector2d readings = options.tilt->matrix.inverse() * inclinationsOf(q.head<2>());
    put(options.tilt->x, readings.x());
    put(options.tilt->y, readings.y());
  }
  for (const EncoderOptions& encoder : options.encoders) {
    double angle = q[static_cast<Eigen::Index>(encoder.joint)];
    if (encoder.counts_per_turn > 0.0) {
      // The register counts from 0 to counts_per_turn.
      const double counts = encoder.field.sign * angle / encoder.field.scale + encoder.field.zero;
      const double turns = std::floor(std::round(counts) / encoder.counts_per_turn);
      angle -= encoder.field.sign * encoder.field.scale * encoder.counts_per_turn * turns;
    }
    put(encoder.field, angle);
  }
  return contents;
}

}  // namespace sac
