#include "spherical_actuator_calibration/actuator/description_file.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <utility>

#include "description_parts.hpp"
#include "spherical_actuator_calibration/actuator/cycle.hpp"
#include "spherical_actuator_calibration/base/error.hpp"
#include "spherical_actuator_calibration/base/numbering.hpp"
#include "spherical_actuator_calibration/base/pi.hpp"
#include "spherical_actuator_calibration/base/printable_text.hpp"
#include "spherical_actuator_calibration/base/rotations.hpp"
#include "spherical_actuator_calibration/base/value_range.hpp"
#include "spherical_actuator_calibration/base/yaml_reader.hpp"

namespace sac {
namespace {

// ---- actuator
// --------------------------------------------------------------------------------------

Eigen::Vector3d readUnitAxis(const YamlMap& joint) {
  // An axis this close to unit length was normalised before: saved again, it is the same.
  constexpr double kRounding = 1e-14;
  const std::vector<double> values = joint.numbers("axis", ValueRange::finite(), kJoints);
  const Eigen::Vector3d axis(values[0], values[1], values[2]);
  requireInRange(joint.where("axis") + ": length",
                 axis.norm(),
                 ValueRange::closed(1.0 - kUnitTolerance, 1.0 + kUnitTolerance));
  return std::abs(axis.norm() - 1.0) > kRounding ? axis.normalized() : axis;
}

std::optional<double> optionalNumber(const YamlMap& map,
                                     const std::string& key,
                                     const ValueRange& range) {
  return map.has(key) ? std::make_optional(map.number(key, range)) : std::nullopt;
}

JointStddev readJointStddev(const YamlMap& joint) {
  if (!joint.has("stddev")) {
    return {};
  }
  const YamlMap map = joint.map("stddev");
  const ValueRange range = ValueRange::nonNegative("rad");
  return {optionalNumber(map, "offset", range),
          optionalNumber(map, "axis_u", range),
          optionalNumber(map, "axis_v", range),
          readLinear(map),
          readHarmonics(map)};
}

AxisStddev readAxisStddev(const YamlMap& pole_or_coil) {
  if (!pole_or_coil.has("stddev")) {
    return {};
  }
  const YamlMap map = pole_or_coil.map("stddev");
  const ValueRange range = ValueRange::nonNegative("rad");
  return {optionalNumber(map, "polar", range),
          optionalNumber(map, "azimuth", range),
          optionalNumber(map, "gain", ValueRange::nonNegative())};
}

void readJoints(const YamlMap& map, CalibratedDescription& description) {
  const std::vector<YamlMap> items = map.maps("joints");
  if (items.empty()) {
    description.actuator.has_joints = false;
    description.actuator.joints = freeRotorJoints();
    return;
  }
  if (items.size() != kJoints) {
    map.fail("joints",
             "the list has " + std::to_string(items.size()) + " joints; " +
                 std::to_string(kJoints) +
                 " are needed, or none where only a tracker tells the "
                 "orientation.");
  }
  std::array<JointAxis, kJoints>& joints = description.actuator.joints;
  for (std::size_t k = 0; k < kJoints; ++k) {
    const YamlMap& item = items[k];
    const std::string name = item.nonEmptyText("name");
    const auto* const end = joints.begin() + k;
    if (std::any_of(joints.cbegin(), end, [&](const auto& other) { return other.name == name; })) {
      item.fail("name",
                "\"" + excerpt(name) + "\" is another joint's name; each joint needs its own.");
    }
    joints[k] = {name, readUnitAxis(item), item.number("offset", ValueRange::finite("rad"))};
    joints[k].correction = {readLinear(item).value_or(ReadingCorrection{}.linear),
                            readHarmonics(item).value_or(ReadingCorrection{}.harmonics)};
    description.stddevs.joints[k] = readJointStddev(item);
  }
}

double readPolar(const YamlMap& item) {
  // π/2 as people write it, rounded up, is meant to be in range.
  constexpr double kRoundedLimit = 1.5708;
  const double polar =
      item.number("polar", ValueRange::closed(-kRoundedLimit, kRoundedLimit, "rad"));
  return std::clamp(polar, -kPi / 2.0, kPi / 2.0);
}

int readPolarity(const YamlMap& item) {
  using Limits = std::numeric_limits<std::int64_t>;
  const std::int64_t polarity = item.integer("polarity", Limits::min(), Limits::max());
  if (polarity != 1 && polarity != -1) {
    item.fail("polarity", std::to_string(polarity) + " is neither 1 nor -1.");
  }
  return static_cast<int>(polarity);
}

/// What poles and coils have in common.
template <typename PoleOrCoil>
PoleOrCoil readAngles(const YamlMap& item) {
  PoleOrCoil axis;
  axis.polar = readPolar(item);
  axis.azimuth = item.number("azimuth", ValueRange::finite("rad"));
  axis.gain = item.number("gain", ValueRange::positive(), axis.gain);
  return axis;
}

void readPoles(const YamlMap& map, CalibratedDescription& description) {
  for (const YamlMap& item : map.maps("poles")) {
    PoleAxis pole = readAngles<PoleAxis>(item);
    pole.polarity = readPolarity(item);
    description.actuator.poles.push_back(pole);
    description.stddevs.poles.push_back(readAxisStddev(item));
  }
}

void readCoils(const YamlMap& map, CalibratedDescription& description) {
  for (const YamlMap& item : map.maps("coils")) {
    description.actuator.coils.push_back(readAngles<CoilAxis>(item));
    description.stddevs.coils.push_back(readAxisStddev(item));
  }
}

Workspace readWorkspace(const YamlMap& actuator) {
  const YamlMap map = actuator.map("workspace");
  return {map.number("tilt_limit", ValueRange::open(0.0, kPi / 2.0, "rad"))};
}

// ---- calibration
// -----------------------------------------------------------------------------------

/// A count that fits its message field.
std::uint32_t readCount(const YamlMap& map, const std::string& key) {
  return static_cast<std::uint32_t>(map.integer(key, 0, std::numeric_limits<std::uint32_t>::max()));
}

std::string readDate(const YamlMap& map) {
  const std::string form = "dddd-dd-ddTdd:dd:dd";
  std::string date = map.text("date");
  const auto fits = [](char expected, char c) {
    return expected == 'd' ? c >= '0' && c <= '9' : c == expected;
  };
  if (date.size() < form.size() || !std::equal(form.begin(), form.end(), date.begin(), fits)) {
    map.fail("date", "\"" + excerpt(date) + "\" is not of the form 2024-05-31T12:00:00Z.");
  }
  return date;
}

CycleRecord readCycle(const YamlMap& map) {
  CycleRecord record;
  record.cycle = map.choice("cycle", cycleNames());
  record.coil = indexOf(readCount(map, "coil"));
  record.samples_used = readCount(map, "samples_used");
  record.samples_rejected = readCount(map, "samples_rejected");
  record.error_before = map.number("error_before", ValueRange::nonNegative());
  record.error_after = map.number("error_after", ValueRange::nonNegative());
  record.unit = map.nonEmptyText("unit");
  record.reduced_chi_square = map.number("reduced_chi_square", ValueRange::nonNegative());
  return record;
}

ValidationRecord readValidation(const YamlMap& map) {
  return {readCount(map, "samples"),
          optionalNumber(map, "orientation_rms", ValueRange::nonNegative("rad")),
          optionalNumber(map, "torque_rms", ValueRange::nonNegative("N*m")),
          map.boolean("contradicted", false)};
}

MapRecord readMapRecord(const YamlMap& map) {
  return {readCount(map, "regions"),
          map.number("axes_rms", ValueRange::nonNegative("rad")),
          map.number("map_rms", ValueRange::nonNegative("rad")),
          map.number("inside", ValueRange::closed(0.0, 1.0))};
}

CalibrationRecord readCalibration(const YamlMap& map) {
  CalibrationRecord record;
  record.date = readDate(map);
  record.revision = readCount(map, "revision");
  for (const YamlMap& item : map.maps("source")) {
    record.source.push_back({item.nonEmptyText("recording"), item.nonEmptyText("checksum")});
  }
  record.software = map.nonEmptyText("software");
  for (const YamlMap& item : map.maps("cycles")) {
    record.cycles.push_back(readCycle(item));
  }
  if (map.has("effects")) {
    for (const YamlMap& item : map.maps("effects")) {
      record.effects.push_back({item.nonEmptyText("name"),
                                item.number("value", ValueRange::finite()),
                                item.number("stddev", ValueRange::nonNegative())});
    }
  }
  record.unidentified = map.texts("unidentified");
  if (map.has("validation")) {
    record.validation = readValidation(map.map("validation"));
  }
  record.orientation_uncertainty =
      optionalNumber(map, "orientation_uncertainty", ValueRange::nonNegative("rad"));
  record.torque_uncertainty =
      optionalNumber(map, "torque_uncertainty", ValueRange::nonNegative("N*m/A"));
  if (map.has("covariance")) {
    record.covariance = readCovariance(map);
  }
  if (map.has("orientation_map")) {
    record.orientation_map = readMapRecord(map.map("orientation_map"));
  }
  return record;
}

TorqueCurveStddev readCurveStddev(const YamlMap& map) {
  TorqueCurveStddev stddev;
  stddev.angles = map.numbers("angles", ValueRange::nonNegative());
  stddev.torques = map.numbers("torques", ValueRange::nonNegative("N*m/A"), stddev.angles.size());
  return stddev;
}

/// What moves the rotor beside its coils.
void readDynamics(const YamlMap& map, CalibratedDescription& description) {
  Actuator& actuator = description.actuator;
  const auto vector = [&](const char* key, const ValueRange& range) {
    const std::vector<double> c = map.numbers(key, range, kJoints);
    return Eigen::Vector3d(c[0], c[1], c[2]);
  };
  if (map.has("rotor_unbalance")) {
    actuator.unbalance = vector("rotor_unbalance", ValueRange::finite("N*m"));
  }
  if (map.has("rotor_unbalance_stddev")) {
    description.stddevs.unbalance =
        vector("rotor_unbalance_stddev", ValueRange::nonNegative("N*m"));
  }
  if (map.has("rotor_inertia")) {
    const YamlMap inertia = map.map("rotor_inertia");
    const auto moment = [&](const char* key) {
      return inertia.number(key, ValueRange::finite("kg*m^2"));
    };
    Eigen::Matrix3d J;
    J(0, 0) = moment("xx");
    J(1, 1) = moment("yy");
    J(2, 2) = moment("zz");
    J(0, 1) = J(1, 0) = moment("xy");
    J(0, 2) = J(2, 0) = moment("xz");
    J(1, 2) = J(2, 1) = moment("yz");
    actuator.inertia = J;
  }
  if (map.has("rotor_friction")) {
    const YamlMap friction = map.map("rotor_friction");
    actuator.friction = {friction.number("viscous", ValueRange::finite("N*m*s/rad")),
                         friction.number("coulomb", ValueRange::finite("N*m"))};
  }
}

}  // namespace

CalibratedDescription readDescription(const YamlMap& file) {
  const YamlMap map = file.map("actuator");
  CalibratedDescription description;
  Actuator& actuator = description.actuator;
  actuator.name = map.nonEmptyText("name");
  actuator.serial = map.text("serial", "");
  readJoints(map, description);
  if (map.has("poles")) {
    readPoles(map, description);
  }
  if (map.has("coils")) {
    readCoils(map, description);
  }
  if (map.has("torque_curve")) {
    actuator.torque_curve = readTorqueCurve(map);
  }
  if (map.has("torque_curve_stddev")) {
    description.stddevs.torque_curve = readCurveStddev(map.map("torque_curve_stddev"));
  }
  actuator.workspace = readWorkspace(map);
  readDynamics(map, description);
  actuator.orientation_map = readOrientationMap(map);
  try {
    validate(actuator);
  } catch (const ConfigError& error) {
    file.fail("actuator", error.what());
  }
  if (map.has("calibration")) {
    description.calibration = readCalibration(map.map("calibration"));
  }
  file.finish();
  return description;
}

CalibratedDescription parseDescription(const std::string& text, const std::string& name) {
  return readDescription(YamlMap::parse(text, name));
}

bool isContradicted(const CalibratedDescription& description) {
  return description.calibration && description.calibration->validation &&
         description.calibration->validation->contradicted;
}

bool isAsDrawn(const CalibratedDescription& description) {
  const Actuator& actuator = description.actuator;
  const ParameterStddevs& stddevs = description.stddevs;
  const auto is_open = [](const AxisStddev& axis) { return !axis.polar || !axis.azimuth; };
  const auto is_joint_open = [](const JointStddev& joint) {
    return !joint.offset || !joint.axis_u || !joint.axis_v;
  };
  return stddevs.poles.size() != actuator.poles.size() ||
         stddevs.coils.size() != actuator.coils.size() ||
         (actuator.has_joints &&
          std::any_of(stddevs.joints.begin(), stddevs.joints.end(), is_joint_open)) ||
         std::any_of(stddevs.poles.begin(), stddevs.poles.end(), is_open) ||
         std::any_of(stddevs.coils.begin(), stddevs.coils.end(), is_open);
}

CalibratedDescription loadDescription(const std::string& path) {
  return readDescription(YamlMap::load(path));
}

Actuator loadActuator(const std::string& path) {
  return loadDescription(path).actuator;
}

void saveDescription(const std::string& path,
                     const CalibratedDescription& description,
                     OverwritePolicy policy) {
  writeFileAtomically(path, renderDescription(description, path), policy);
}

}  // namespace sac
