#include "motion_table.hpp"

#include <cstddef>

#include "number_bytes.hpp"
#include "row_access.hpp"
#include "spherical_actuator_calibration/motion/motion_slice.hpp"

namespace sac::motion_table {
namespace {

/// Takes values off the front of bytes.
class Bytes {
 public:
  explicit Bytes(std::string bytes) : bytes_(std::move(bytes)) {}

  /// How many rows of so many bytes there are. Throws RowDefect where there is more beside them.
  std::size_t rows(std::size_t size) const {
    if (bytes_.size() % size != 0) {
      throw RowDefect("a stream of a motion does not end with a measurement");
    }
    return bytes_.size() / size;
  }

  template <typename Value>
  Value take() {
    const auto value = numberAt<Value>(bytes_, place_);
    place_ += sizeof value;
    return value;
  }

 private:
  std::string bytes_;
  std::size_t place_ = 0;
};

std::string jointsOf(const MotionStreams& streams) {
  std::string bytes;
  for (std::size_t n = 0; n < streams.joints.size(); ++n) {
    appendNumber(bytes, streams.joint_stamps[n]);
    for (const double angle : streams.joints[n]) {
      appendNumber(bytes, angle);
    }
  }
  return bytes;
}

std::string currentsOf(const MotionStreams& streams) {
  std::string bytes;
  for (std::size_t n = 0; n < streams.current_stamps.size(); ++n) {
    appendNumber(bytes, streams.current_stamps[n]);
    for (const float current : streams.currents.row(static_cast<Eigen::Index>(n))) {
      appendNumber(bytes, current);
    }
  }
  return bytes;
}

std::string orientationsOf(const MotionStreams& streams) {
  std::string bytes;
  for (std::size_t n = 0; n < streams.orientations.size(); ++n) {
    appendNumber(bytes, streams.orientation_stamps[n]);
    for (const double component : streams.orientations[n].coeffs()) {
      appendNumber(bytes, component);
    }
  }
  return bytes;
}

void readJoints(Bytes bytes, MotionStreams& streams) {
  const std::size_t count = bytes.rows(sizeof(Stamp) + 3 * sizeof(double));
  for (std::size_t n = 0; n < count; ++n) {
    streams.joint_stamps.push_back(bytes.take<Stamp>());
    Eigen::Vector3d position;
    for (double& angle : position) {
      angle = bytes.take<double>();
    }
    streams.joints.push_back(position);
  }
}

void readCurrents(Bytes bytes, std::size_t coils, MotionStreams& streams) {
  const std::size_t count = bytes.rows(sizeof(Stamp) + coils * sizeof(float));
  streams.currents =
      StreamCurrents(static_cast<Eigen::Index>(count), static_cast<Eigen::Index>(coils));
  for (std::size_t n = 0; n < count; ++n) {
    streams.current_stamps.push_back(bytes.take<Stamp>());
    for (float& current : streams.currents.row(static_cast<Eigen::Index>(n))) {
      current = bytes.take<float>();
    }
  }
}

void readOrientations(Bytes bytes, MotionStreams& streams) {
  const std::size_t count = bytes.rows(sizeof(Stamp) + 4 * sizeof(double));
  for (std::size_t n = 0; n < count; ++n) {
    streams.orientation_stamps.push_back(bytes.take<Stamp>());
    Eigen::Quaterniond orientation;
    for (double& component : orientation.coeffs()) {
      component = bytes.take<double>();
    }
    streams.orientations.push_back(orientation);
  }
}

}  // namespace

void insert(const SQLite::Database& database, const MotionSlice& slice, const std::string& date) {
  RowWriter row(database,
                "INSERT INTO motion_windows (date, first, last, coils, joints, currents, "
                "orientations) VALUES (?, ?, ?, ?, ?, ?, ?)");
  row.put(date).put(slice.window.first).put(slice.window.last);
  row.put(static_cast<std::size_t>(slice.streams.currents.cols()));
  row.putBytes(jointsOf(slice.streams));
  row.putBytes(currentsOf(slice.streams));
  row.putBytes(orientationsOf(slice.streams));
  row.write();
  RowWriter(database,
            "DELETE FROM motion_windows WHERE id IN (SELECT id FROM (SELECT id, "
            "sum(length(joints) + length(currents) + length(orientations)) OVER "
            "(ORDER BY id DESC) AS bytes FROM motion_windows) WHERE bytes > ?)")
      .put(kMostBytes)
      .write();
}

std::vector<MotionSlice> all(const SQLite::Database& database) {
  RowReader row(database,
                "SELECT first, last, coils, joints, currents, orientations FROM motion_windows "
                "ORDER BY id");
  std::vector<MotionSlice> slices;
  while (row.next()) {
    MotionSlice& slice = slices.emplace_back();
    slice.window.first = row.count();
    slice.window.last = row.count();
    const std::size_t coils = row.count();
    readJoints(Bytes(row.bytes()), slice.streams);
    readCurrents(Bytes(row.bytes()), coils, slice.streams);
    readOrientations(Bytes(row.bytes()), slice.streams);
  }
  return slices;
}

void clear(const SQLite::Database& database) {
  RowWriter(database, "DELETE FROM motion_windows").write();
}

}  // namespace sac::motion_table
