#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>

#include <SQLiteCpp/Database.h>
#include <SQLiteCpp/Statement.h>

#include "fuzz/fuzz_targets.hpp"
#include "spherical_actuator_calibration/actuator/description_file.hpp"
#include "spherical_actuator_calibration/base/error.hpp"
#include "spherical_actuator_calibration/storage/live_session.hpp"
#include "support/source_dir.hpp"
#include "support/temporary_folder.hpp"

namespace sac::fuzz {
namespace {

namespace fs = std::filesystem;

constexpr char kDate[] = "2024-05-31T12:00:00Z";

/// Without poles and coils: a small database, quickly read.
CalibratedDescription start() {
  static const CalibratedDescription description =
      loadDescription(SOURCE_DIR "/config/examples/two_axis_positioner/actuator.yaml");
  return description;
}

Sample sampleAt(int n) {
  Sample sample;
  sample.stamp = 1'000'000'000LL * (n + 1);
  sample.joint_position = Eigen::Vector3d(0.1 * n, 0.02 * n * n, -0.1);
  sample.joint_stddev.setConstant(1e-4);
  sample.has_orientation = true;
  sample.orientation_stddev = 1e-4;
  sample.duration = 1.0;
  sample.measurements = 100;
  return sample;
}

/// Of an actuator without coils: none of use, but bytes of every kind.
MotionSlice windowAt(int n) {
  MotionSlice slice;
  slice.window = {2, 20};
  slice.streams.currents = StreamCurrents(24, 0);
  for (int k = 0; k < 24; ++k) {
    slice.streams.joint_stamps.push_back(250'000'000LL * n + 10'000'000LL * k);
    slice.streams.joints.emplace_back(0.01 * k, 0.0, 0.1 * k);
    slice.streams.current_stamps.push_back(slice.streams.joint_stamps.back());
    slice.streams.orientation_stamps.push_back(slice.streams.joint_stamps.back());
    slice.streams.orientations.push_back(Eigen::Quaterniond::Identity());
  }
  return slice;
}

/// A session with something in every table, and a copy of it that is spoilt and read each time.
class Sandbox {
 public:
  Sandbox() {
    {
      LiveSession session(start(), {}, folder_.path("whole.db"), "0.1.0");
      for (int n = 0; n < 6; ++n) {
        session.addSample(sampleAt(n), kDate);
      }
      session.run({Cycle::kJoint}, kDate);
      session.addMotion({windowAt(1), windowAt(2)}, kDate);
      session.removeSample(2, kDate);
      session.reset(kDate);
      session.restore(0, kDate);
    }
    whole_ = contentOf(folder_.path("whole.db"));
  }

  std::string fresh() const {
    for (const char* end : {"", "-journal", "-wal", "-shm"}) {
      fs::remove(path() + end);
    }
    std::ofstream(path(), std::ios::binary) << whole_;
    return path();
  }

  std::string path() const { return folder_.path("session.db"); }
  std::size_t size() const { return whole_.size(); }

 private:
  TemporaryFolder folder_;
  std::string whole_;
};

/// Takes numbers off the front of the bytes.
class Input {
 public:
  Input(const std::uint8_t* data, std::size_t size) : data_(data), left_(size) {}

  bool isEmpty() const { return left_ == 0; }
  std::uint8_t byte() {
    if (left_ == 0) {
      return 0;
    }
    --left_;
    return *data_++;
  }
  std::uint64_t number(int bytes) {
    std::uint64_t value = 0;
    for (int n = 0; n < bytes; ++n) {
      value = value << 8U | byte();
    }
    return value;
  }
  std::string text(std::size_t size) {
    std::string text;
    for (std::size_t n = 0; n < size && left_ > 0; ++n) {
      text.push_back(static_cast<char>(byte()));
    }
    return text;
  }

 private:
  const std::uint8_t* data_;
  std::size_t left_;
};

/// Gives cells of some row values of some type, or takes rows away.
void spoilCells(const std::string& path, Input& input) {
  const char* const tables[] = {"unit",
                                "samples",
                                "sample_currents",
                                "cycles",
                                "cycle_errors",
                                "cycle_estimates",
                                "cycle_residuals",
                                "motion_windows",
                                "revisions"};
  constexpr std::uint8_t kTaken = 224;  // and above: rows are taken away
  const SQLite::Database database(path, SQLite::OPEN_READWRITE);
  SQLite::Statement(database, "PRAGMA ignore_check_constraints = ON").executeStep();
  while (!input.isEmpty()) {
    const std::string table = tables[input.byte() % std::size(tables)];
    SQLite::Statement columns(database, "SELECT name FROM pragma_table_info('" + table + "')");
    std::vector<std::string> names;
    while (columns.executeStep()) {
      names.push_back(columns.getColumn(0).getString());
    }
    const std::string column = names[input.byte() % names.size()];
    const bool has_rowid = table != "sample_currents" && table.compare(0, 6, "cycle_") != 0;
    const std::string rows =
        has_rowid ? " WHERE rowid = " + std::to_string(input.byte() % 8) : std::string();
    const std::uint8_t kind = input.byte();
    if (kind >= kTaken) {
      SQLite::Statement(database, "PRAGMA foreign_keys = OFF").executeStep();
      SQLite::Statement(database, "DELETE FROM " + table + rows).exec();
      continue;
    }
    SQLite::Statement update(database, "UPDATE " + table + " SET " + column + " = ?" + rows);
    if (kind % 5 == 0) {
      update.bind(1, static_cast<std::int64_t>(input.number(8)));
    } else if (kind % 5 == 1) {
      const std::uint64_t bits = input.number(8);
      double value = 0.0;
      std::memcpy(&value, &bits, sizeof value);
      update.bind(1, value);
    } else if (kind % 5 == 2) {
      update.bind(1, input.text(input.byte()));
    } else if (kind % 5 == 3) {
      const std::string bytes = input.text(input.byte());
      update.bind(1, bytes.data(), static_cast<int>(bytes.size()));
    }
    try {
      update.exec();
    } catch (const SQLite::Exception&) {  // the type is not the column's
    }
  }
}

/// Writes bytes over those of the file.
void spoilFile(const std::string& path, std::size_t size, Input& input) {
  std::fstream file(path, std::ios::binary | std::ios::in | std::ios::out);
  while (!input.isEmpty()) {
    file.seekp(static_cast<std::streamoff>(input.number(3) % size));
    const std::string bytes = input.text(1 + input.byte() % 16);
    file.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  }
}

void readAll(const std::string& path) {
  LiveSession session(start(), {}, path, "0.1.0");
  for (const RevisionSummary& revision : session.database().revisions()) {
    try {
      session.database().revision(revision.number);
      session.database().cyclesOfRevision(revision.number);
      session.restore(revision.number, kDate);
      session.description(kDate);
    } catch (const Error&) {
    }
  }
  try {
    session.motionWindows();
  } catch (const Error&) {
  }
  session.lastReport();
  session.progress();
  session.grade();
  session.addSample(sampleAt(9), kDate);
  session.run({Cycle::kJoint}, kDate);
}

}  // namespace

void readDatabase(const std::uint8_t* data, std::size_t size) {
  static const Sandbox sandbox;
  if (size == 0) {
    return;
  }
  const std::string path = sandbox.fresh();
  Input input(data, size);
  try {
    if (input.byte() % 2 == 0) {
      spoilCells(path, input);
    } else {
      spoilFile(path, sandbox.size(), input);
    }
    readAll(path);
  } catch (const Error&) {
  } catch (const SQLite::Exception&) {  // of spoilCells()
  }
}

}  // namespace sac::fuzz
