#include "fuzz/fuzz_targets.hpp"

#include <stdexcept>

#include <sys/mman.h>

#include <unistd.h>

namespace sac::fuzz {

const std::vector<Target>& targets() {
  static const std::vector<Target> all = {
      {"description", readDescriptionFile},
      {"dimensions", readDimensionsFile},
      {"configuration", readConfigurationFile},
      {"registers", readRegisters},
      {"words", readRegisterWords},
      {"motion", readMotionFile},
      {"plan", readPlanFile},
      {"samples", readSamplesFile},
      {"table", readTableFile},
      {"robot", readRobotDescription},
      {"study", readStudyFile},
      {"issuer", readIssuerFile},
      {"messages", readMessages},
      {"recording", readRecording},
#ifdef SESSION_DATABASE
      {"database", readDatabase},
#endif
  };
  return all;
}

MemoryFile::MemoryFile(const std::uint8_t* data, std::size_t size)
    : descriptor_(::memfd_create("fuzz", MFD_CLOEXEC)) {
  std::size_t done = 0;
  while (descriptor_ >= 0 && done < size) {
    const ssize_t count = ::write(descriptor_, data + done, size - done);
    if (count < 0) {
      break;
    }
    done += static_cast<std::size_t>(count);
  }
  if (descriptor_ < 0 || done < size) {
    throw std::runtime_error("No file could be made in memory.");
  }
}

MemoryFile::~MemoryFile() {
  ::close(descriptor_);
}

std::string MemoryFile::path() const {
  return "/proc/self/fd/" + std::to_string(descriptor_);
}

}  // namespace sac::fuzz
