#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace sac::fuzz {

/// Reads bytes as one kind of what comes from outside. Whatever the bytes are, the program neither
/// ends nor hangs: `run` lets no exception out that a reader does not promise.
struct Target {
  std::string name;  ///< its corpus is in corpus/<name>
  void (*run)(const std::uint8_t* data, std::size_t size);
};

/// All targets.
const std::vector<Target>& targets();

/// A file in memory that has a path, for readers of files.
class MemoryFile {
 public:
  MemoryFile(const std::uint8_t* data, std::size_t size);
  ~MemoryFile();
  MemoryFile(const MemoryFile&) = delete;
  MemoryFile& operator=(const MemoryFile&) = delete;

  std::string path() const;

 private:
  int descriptor_;
};

void readDescriptionFile(const std::uint8_t* data, std::size_t size);
void readDimensionsFile(const std::uint8_t* data, std::size_t size);
void readConfigurationFile(const std::uint8_t* data, std::size_t size);
void readRegisterWords(const std::uint8_t* data, std::size_t size);
void readRegisters(const std::uint8_t* data, std::size_t size);
void readMotionFile(const std::uint8_t* data, std::size_t size);
void readPlanFile(const std::uint8_t* data, std::size_t size);
void readSamplesFile(const std::uint8_t* data, std::size_t size);
void readTableFile(const std::uint8_t* data, std::size_t size);
void readRobotDescription(const std::uint8_t* data, std::size_t size);
void readStudyFile(const std::uint8_t* data, std::size_t size);
void readIssuerFile(const std::uint8_t* data, std::size_t size);
void readMessages(const std::uint8_t* data, std::size_t size);
void readRecording(const std::uint8_t* data, std::size_t size);
void readDatabase(const std::uint8_t* data, std::size_t size);

}  // namespace sac::fuzz
