#include <cstdlib>
#include <iterator>
#include <optional>
#include <string>
#include <vector>

#include <console_bridge/console.h>

#include "fuzz/fuzz_targets.hpp"
#include "spherical_actuator_calibration/actuator/actuator_dimensions.hpp"
#include "spherical_actuator_calibration/actuator/description_file.hpp"
#include "spherical_actuator_calibration/actuator/urdf_file.hpp"
#include "spherical_actuator_calibration/assessment/calibration_certificate.hpp"
#include "spherical_actuator_calibration/base/csv_file.hpp"
#include "spherical_actuator_calibration/base/error.hpp"
#include "spherical_actuator_calibration/base/printable_text.hpp"
#include "spherical_actuator_calibration/calibration/calibration_config.hpp"
#include "spherical_actuator_calibration/drivers/current_amplifier.hpp"
#include "spherical_actuator_calibration/drivers/joint_sensor.hpp"
#include "spherical_actuator_calibration/drivers/register_codec.hpp"
#include "spherical_actuator_calibration/measurement/motion_plan_file.hpp"
#include "spherical_actuator_calibration/measurement/sample_file.hpp"
#include "spherical_actuator_calibration/planning/session_plan_file.hpp"
#include "spherical_actuator_calibration/planning/session_plan_record.hpp"
#include "spherical_actuator_calibration/study/study_file.hpp"

namespace sac::fuzz {
namespace {

constexpr std::size_t kCoils = 24;

std::string textOf(const std::uint8_t* data, std::size_t size) {
  return {data, data + size};
}

void require(bool holds) {
  if (!holds) {
    std::abort();
  }
}

/// Joints of corpus/robot.
Actuator drawnJoints() {
  Actuator actuator;
  for (std::size_t k = 0; k < kJoints; ++k) {
    actuator.joints[k].name = "joint_" + std::to_string(k + 1);
    actuator.joints[k].axis = Eigen::Vector3d::Unit(static_cast<Eigen::Index>(k));
  }
  return actuator;
}

/// What a reader makes of bytes; nothing when it refuses them in a sentence that can be shown.
template <typename Read>
auto accepted(const Read& read) -> std::optional<decltype(read())> {
  try {
    return read();
  } catch (const Error& error) {
    const std::string shown = printable(error.what());
    require(!shown.empty() && printable(shown) == shown);
    return std::nullopt;
  }
}

}  // namespace

void readDescriptionFile(const std::uint8_t* data, std::size_t size) {
  const auto description = accepted([&] { return parseDescription(textOf(data, size), "f.yaml"); });
  if (description) {
    // What is accepted can be written and read again, and is the same then.
    const auto text = accepted([&] { return renderDescription(*description, "g.yaml"); });
    if (text) {
      require(renderDescription(parseDescription(*text, "g.yaml"), "g.yaml") == *text);
    }
  }
}

void readDimensionsFile(const std::uint8_t* data, std::size_t size) {
  accepted([&] { return parseDimensions(textOf(data, size), "f.yaml"); });
}

void readConfigurationFile(const std::uint8_t* data, std::size_t size) {
  const auto config =
      accepted([&] { return parseCalibrationConfig(textOf(data, size), "f.yaml"); });
  if (config) {
    const std::string text = renderCalibrationConfig(*config);
    require(renderCalibrationConfig(parseCalibrationConfig(text, "g.yaml")) == text);
  }
}

void readRegisters(const std::uint8_t* data, std::size_t size) {
  const std::string text = textOf(data, size);
  accepted([&] {
    const YamlMap map = YamlMap::parse(text, "f.yaml");
    CurrentAmplifierOptions options = readCurrentAmplifierOptions(map);
    map.finish();
    return options;
  });
  accepted([&] {
    const YamlMap map = YamlMap::parse(text, "f.yaml");
    JointSensorOptions options = readJointSensorOptions(map);
    map.finish();
    return options;
  });
}

// Every bit pattern of registers is some number, and whole numbers come back. The first byte tells
// which of the types and orders they have.
void readRegisterWords(const std::uint8_t* data, std::size_t size) {
  constexpr RegisterType kTypes[] = {RegisterType::kInt16,
                                     RegisterType::kUint16,
                                     RegisterType::kInt32,
                                     RegisterType::kUint32,
                                     RegisterType::kFloat32};
  if (size == 0) {
    return;
  }
  const RegisterType type = kTypes[data[0] % std::size(kTypes)];
  const WordOrder order = data[0] < 0x80 ? WordOrder::kHighFirst : WordOrder::kLowFirst;
  for (std::size_t n = 1; n + 4 <= size; n += 4) {
    const std::uint16_t words[] = {static_cast<std::uint16_t>(data[n] << 8U | data[n + 1]),
                                   static_cast<std::uint16_t>(data[n + 2] << 8U | data[n + 3])};
    const double value = decodeRegisters(words, type, order);
    if (type != RegisterType::kFloat32) {
      const std::vector<std::uint16_t> again = encodeRegisters(value, type, order);
      require(decodeRegisters(again.data(), type, order) == value);
    }
  }
}

void readMotionFile(const std::uint8_t* data, std::size_t size) {
  const auto record = accepted([&] { return parseMotionPlan(textOf(data, size), "f.yaml"); });
  if (record) {
    const std::string text = renderMotionPlan(*record);
    require(renderMotionPlan(parseMotionPlan(text, "g.yaml")) == text);
    // It is for no actuator at all.
    accepted([&] {
      validate(record->plan, Actuator{});
      return true;
    });
  }
}

void readPlanFile(const std::uint8_t* data, std::size_t size) {
  const MemoryFile file(data, size);
  const auto plan = accepted([&] { return loadSessionPlan(file.path()); });
  if (plan) {
    accepted([&] { return renderSessionPlan(*plan); });
  }
}

void readSamplesFile(const std::uint8_t* data, std::size_t size) {
  const MemoryFile file(data, size);
  accepted([&] { return loadSamples(file.path(), kCoils); });
  accepted([&] { return loadSamples(file.path(), 0); });
}

void readTableFile(const std::uint8_t* data, std::size_t size) {
  constexpr std::size_t kMostRows = 1000;
  const MemoryFile file(data, size);
  const auto table = accepted([&] { return loadCsv(file.path(), kMostRows); });
  if (table) {
    require(!table->rows.empty() && table->rows.size() <= kMostRows);
  }
}

void readRobotDescription(const std::uint8_t* data, std::size_t size) {
  // urdfdom tells of every input on the standard error what it misses.
  console_bridge::setLogLevel(console_bridge::CONSOLE_BRIDGE_LOG_NONE);
  const Actuator nominal = drawnJoints();
  const auto text = accepted(
      [&] { return renderCalibratedUrdf(textOf(data, size), "f.urdf", nominal, nominal); });
  if (text) {
    // What is accepted fits the actuator, written again, too.
    require(renderCalibratedUrdf(*text, "g.urdf", nominal, nominal) == *text);
  }
}

void readStudyFile(const std::uint8_t* data, std::size_t size) {
  const MemoryFile file(data, size);
  const auto study = accepted([&] { return loadStudy(file.path()); });
  if (study) {
    accepted([&] { return renderStudy(*study); });
  }
}

void readIssuerFile(const std::uint8_t* data, std::size_t size) {
  const MemoryFile file(data, size);
  accepted([&] { return loadCertificateIssuer(file.path()); });
}

}  // namespace sac::fuzz
