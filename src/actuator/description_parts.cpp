#include "description_parts.hpp"

#include <algorithm>
#include <filesystem>
#include <utility>

#include "spherical_actuator_calibration/base/csv_file.hpp"
#include "spherical_actuator_calibration/base/error.hpp"
#include "spherical_actuator_calibration/base/pi.hpp"
#include "spherical_actuator_calibration/base/value_range.hpp"
#include "torque_of_a_coil.hpp"

namespace sac {
namespace {

template <std::size_t kSize>
std::array<double, kSize> arrayOf(const std::vector<double>& values) {
  std::array<double, kSize> result = {};
  std::copy_n(values.begin(), kSize, result.begin());
  return result;
}

template <std::size_t kSize>
std::optional<std::array<double, kSize>> optionalArray(const YamlMap& map, const std::string& key) {
  return map.has(key) ? std::optional(arrayOf<kSize>(map.numbers(key, ValueRange::finite(), kSize)))
                      : std::nullopt;
}

/// A file with a line "angle, torque" or "angle, torque, stddev" for each point.
TorqueTable readTableFile(const YamlMap& map) {
  std::filesystem::path path = map.nonEmptyText("table");
  if (path.is_relative()) {
    path = std::filesystem::path(map.file()).parent_path() / path;
  }
  constexpr std::size_t kWithoutStddev = 2;
  constexpr std::size_t kWithStddev = 3;
  TorqueTable table;
  const CsvFile file = loadCsv(path.string(), kMostTablePoints);
  for (const CsvRow& row : file.rows) {
    const std::size_t columns = file.rows.front().values.size();
    if (columns != kWithoutStddev && columns != kWithStddev) {
      row.fail("a point is an angle, a torque and, if known, its standard deviation.");
    }
    row.requireColumns(columns);
    table.angles.push_back(row.values[0]);
    table.torques.push_back(row.values[1]);
    if (columns == kWithStddev) {
      table.stddevs.push_back(row.values[2]);
    }
  }
  return table;
}

TorqueTable readTable(const YamlMap& map) {
  if (!map.hasMap("table")) {
    return readTableFile(map);
  }
  const YamlMap lists = map.map("table");
  TorqueTable table;
  table.angles = lists.numbers("angles", ValueRange::finite());
  table.torques = lists.numbers("torques", ValueRange::finite());
  if (lists.has("stddevs")) {
    table.stddevs = lists.numbers("stddevs", ValueRange::nonNegative("N*m/A"));
  }
  return table;
}

Eigen::Vector3d vectorOf(const YamlMap& map, const std::string& key) {
  const std::vector<double> values = map.numbers(key, ValueRange::finite("rad"), kJoints);
  return {values[0], values[1], values[2]};
}

}  // namespace

TorqueCurveDescription readTorqueCurve(const YamlMap& actuator) {
  const YamlMap map = actuator.map("torque_curve");
  const bool has_table = map.has("table");
  TorqueCurveDescription curve;
  const std::string unit = has_table ? map.choice("angle_unit", {"deg", "rad"}, "deg")
                                     : map.choice("angle_unit", {"deg", "rad"});
  curve.angle_unit = unit == "deg" ? AngleUnit::kDegree : AngleUnit::kRadian;
  const ValueRange angles = ValueRange::open(0.0, unit == "deg" ? 180.0 : kPi, unit);
  if (has_table) {
    curve.table = readTable(map);
  }
  if (!has_table || map.has("coefficients")) {
    curve.coefficients = map.numbers("coefficients", ValueRange::finite());
  }
  if (!has_table || map.has("blend_start")) {
    curve.blend_start = map.number("blend_start", angles);
  }
  if (!has_table || map.has("support")) {
    const std::vector<double> support = map.numbers("support", angles, 2);
    curve.support_begin = support[0];
    curve.support_end = support[1];
  }
  completeFromTable(curve);
  try {
    validate(curve);
    requireTorqueOfACoil(curve);
  } catch (const ConfigError& error) {
    actuator.fail("torque_curve", error.what());
  }
  return curve;
}

std::string torqueCurveLine(const TorqueCurveDescription& curve) {
  YamlLine line;
  line.add("angle_unit", curve.angle_unit == AngleUnit::kDegree ? "deg" : "rad");
  if (!curve.coefficients.empty()) {
    line.add("coefficients", yamlNumbers(curve.coefficients));
  }
  if (!curve.table.empty()) {
    YamlLine table;
    table.add("angles", yamlNumbers(curve.table.angles));
    table.add("torques", yamlNumbers(curve.table.torques));
    if (!curve.table.stddevs.empty()) {
      table.add("stddevs", yamlNumbers(curve.table.stddevs));
    }
    line.add("table", table.text());
  }
  line.add("blend_start", yamlNumber(curve.blend_start));
  line.add("support", yamlNumbers(std::array{curve.support_begin, curve.support_end}));
  return line.text();
}

std::optional<std::array<double, kJoints>> readLinear(const YamlMap& joint) {
  return optionalArray<kJoints>(joint, "linear");
}

std::optional<std::array<double, 4>> readHarmonics(const YamlMap& joint) {
  return optionalArray<4>(joint, "harmonics");
}

std::shared_ptr<const OrientationMap> readOrientationMap(const YamlMap& actuator) {
  if (!actuator.has("orientation_map")) {
    return nullptr;
  }
  const YamlMap map = actuator.map("orientation_map");
  const ValueRange positive = ValueRange::positive("rad");
  OrientationMapDescription description;
  description.length = arrayOf<kJoints>(map.numbers("length", positive, kJoints));
  description.amplitude = arrayOf<3>(map.numbers("amplitude", positive, 3));
  description.noise = arrayOf<3>(map.numbers("noise", positive, 3));
  if (map.has("tracker_noise")) {
    description.tracker_noise = map.number("tracker_noise", positive);
  }
  for (const YamlMap& point : map.maps("points")) {
    description.readings.push_back(vectorOf(point, "reading"));
    description.rotations.push_back(vectorOf(point, "rotation"));
  }
  try {
    return std::make_shared<OrientationMap>(std::move(description));
  } catch (const ConfigError& error) {
    actuator.fail("orientation_map", error.what());
  }
}

void writeOrientationMap(YamlWriter& writer, const OrientationMap& map) {
  const OrientationMapDescription& description = map.description();
  writer.map(1, "orientation_map");
  writer.entry(2, "length", yamlNumbers(description.length));
  writer.entry(2, "amplitude", yamlNumbers(description.amplitude));
  writer.entry(2, "noise", yamlNumbers(description.noise));
  if (description.tracker_noise > 0.0) {
    writer.entry(2, "tracker_noise", yamlNumber(description.tracker_noise));
  }
  std::vector<std::string> points;
  for (std::size_t n = 0; n < description.readings.size(); ++n) {
    points.push_back(YamlLine()
                         .add("reading", yamlNumbers(description.readings[n]))
                         .add("rotation", yamlNumbers(description.rotations[n]))
                         .text());
  }
  writer.list(2, "points", points);
}

CovarianceRecord readCovariance(const YamlMap& calibration) {
  const YamlMap map = calibration.map("covariance");
  CovarianceRecord record;
  record.effects = map.texts("effects");
  record.names = map.texts("names");
  const std::size_t size = record.names.size();
  record.lower = map.numbers("lower", ValueRange::finite(), size * (size + 1) / 2);
  return record;
}

void writeCovariance(YamlWriter& writer, const CovarianceRecord& covariance) {
  const auto texts = [](const std::vector<std::string>& values) {
    std::vector<std::string> items;
    std::transform(values.begin(), values.end(), std::back_inserter(items), yamlText);
    return yamlList(items);
  };
  writer.map(2, "covariance");
  writer.entry(3, "effects", texts(covariance.effects));
  writer.entry(3, "names", texts(covariance.names));
  writer.entry(3, "lower", yamlNumbers(covariance.lower));
}

}  // namespace sac
