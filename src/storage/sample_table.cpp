#include "sample_table.hpp"

#include <cstddef>
#include <limits>
#include <map>
#include <string>

#include "row_access.hpp"
#include "spherical_actuator_calibration/base/numbering.hpp"

namespace sac::sample_table {
namespace {

/// More coils no actuator has.
constexpr std::uint32_t kMostCoils = 10'000;

/// Currents of the samples in use.
std::map<std::uint32_t, std::vector<double>> currents(const SQLite::Database& database) {
  RowReader row(
      database,
      "SELECT sample, coil, current FROM sample_currents JOIN samples ON samples.id = sample "
      "WHERE removal IS NULL ORDER BY sample, coil");
  std::map<std::uint32_t, std::vector<double>> result;
  while (row.next()) {
    const std::uint32_t sample = row.count();
    std::vector<double>& values = result[sample];
    const std::uint32_t coil = row.count();
    if (coil != numberOf(values.size()) || coil > kMostCoils) {
      throw RowDefect("Sample " + std::to_string(sample) +
                      ": its currents are not those of coils 1, 2, 3 and so on: coil " +
                      std::to_string(coil) + " stands where coil " +
                      std::to_string(numberOf(values.size())) + " is due");
    }
    values.push_back(row.number());
  }
  return result;
}

Eigen::Vector3d vector(RowReader& row) {
  Eigen::Vector3d value;
  for (Eigen::Index k = 0; k < value.size(); ++k) {
    value[k] = row.number();
  }
  return value;
}

Eigen::Matrix3d matrix(RowReader& row) {
  Eigen::Matrix3d value;
  for (Eigen::Index k = 0; k < value.rows(); ++k) {
    value.row(k) = vector(row);
  }
  return value;
}

void put(RowWriter& row, const Eigen::Vector3d& value) {
  for (Eigen::Index k = 0; k < value.size(); ++k) {
    row.put(value[k]);
  }
}

void put(RowWriter& row, const Eigen::Matrix3d& value) {
  for (Eigen::Index k = 0; k < value.rows(); ++k) {
    put(row, Eigen::Vector3d(value.row(k)));
  }
}

Sample read(RowReader& row) {
  Sample sample;
  sample.id = row.count();
  sample.stamp = row.integer();
  sample.validation = row.flag();
  sample.joint_position = vector(row);
  sample.joint_stddev = vector(row);
  sample.has_orientation = row.flag();
  sample.R_stator_rotor = matrix(row);
  sample.has_torque = row.flag();
  sample.torque = vector(row);
  sample.duration = row.number();
  sample.measurements = row.count();
  sample.orientation_stddev = row.number();
  sample.torque_stddev = row.number();
  sample.dwell = row.integer();
  sample.joint_shared_stddev = vector(row);
  sample.torque_shared_stddev = row.number();
  return sample;
}

}  // namespace

void insert(const SQLite::Database& database, const Sample& sample, const std::string& date) {
  RowWriter row(database,
                "INSERT INTO samples (id, date, stamp, validation, joint_1, joint_2, joint_3, "
                "joint_1_stddev, joint_2_stddev, joint_3_stddev, has_orientation, r11, r12, r13, "
                "r21, r22, r23, r31, r32, r33, has_torque, torque_x, torque_y, torque_z, duration, "
                "measurements, orientation_stddev, torque_stddev, dwell, joint_1_shared_stddev, "
                "joint_2_shared_stddev, joint_3_shared_stddev, torque_shared_stddev) VALUES (?, "
                "?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, "
                "?, ?, ?, ?, ?)");
  row.put(sample.id).put(date).put(sample.stamp).put(sample.validation);
  put(row, sample.joint_position);
  put(row, sample.joint_stddev);
  row.put(sample.has_orientation);
  put(row, sample.R_stator_rotor);
  row.put(sample.has_torque);
  put(row, sample.torque);
  row.put(sample.duration).put(sample.measurements);
  row.put(sample.orientation_stddev).put(sample.torque_stddev);
  row.put(sample.dwell);
  put(row, sample.joint_shared_stddev);
  row.put(sample.torque_shared_stddev);
  row.write();

  RowWriter current(database,
                    "INSERT INTO sample_currents (sample, coil, current) VALUES (?, ?, ?)");
  for (Eigen::Index j = 0; j < sample.current.size(); ++j) {
    const std::size_t coil = numberOf(static_cast<std::size_t>(j));
    current.put(sample.id).put(coil).put(sample.current[j]).write();
  }
}

std::vector<Sample> inUse(const SQLite::Database& database) {
  const std::map<std::uint32_t, std::vector<double>> currents_of = currents(database);
  RowReader row(database,
                "SELECT id, stamp, validation, joint_1, joint_2, joint_3, joint_1_stddev, "
                "joint_2_stddev, joint_3_stddev, has_orientation, r11, r12, r13, r21, r22, r23, "
                "r31, r32, r33, has_torque, torque_x, torque_y, torque_z, duration, measurements, "
                "orientation_stddev, torque_stddev, dwell, joint_1_shared_stddev, "
                "joint_2_shared_stddev, joint_3_shared_stddev, torque_shared_stddev "
                "FROM samples WHERE removal IS NULL ORDER BY id");
  std::vector<Sample> samples;
  while (row.next()) {
    samples.push_back(read(row));
    const auto current = currents_of.find(samples.back().id);
    if (current != currents_of.end()) {
      const std::vector<double>& values = current->second;
      samples.back().current = Eigen::Map<const Eigen::VectorXd>(
          values.data(), static_cast<Eigen::Index>(values.size()));
    }
  }
  return samples;
}

bool remove(const SQLite::Database& database, std::uint32_t id, const std::string& date) {
  RowWriter row(database,
                "UPDATE samples SET removal = 'removed', removal_date = ? "
                "WHERE id = ? AND removal IS NULL");
  return row.put(date).put(id).write() == 1;
}

std::size_t clear(const SQLite::Database& database, const std::string& date) {
  RowWriter row(database,
                "UPDATE samples SET removal = 'cleared', removal_date = ? WHERE removal IS NULL");
  return static_cast<std::size_t>(row.put(date).write());
}

std::uint32_t nextId(const SQLite::Database& database) {
  RowReader row(database, "SELECT coalesce(max(id), 0) FROM samples");
  row.next();
  const std::uint32_t last = row.count();
  if (last == std::numeric_limits<std::uint32_t>::max()) {
    throw RowDefect("the last number of a sample is taken");
  }
  return last + 1;
}

}  // namespace sac::sample_table
