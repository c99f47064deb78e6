#include "spherical_actuator_calibration/base/folder_sync.hpp"

#include <fcntl.h>
#include <unistd.h>

namespace sac {

void syncFolder(const std::string& folder) {
  const int descriptor = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (descriptor >= 0) {
    ::fsync(descriptor);
    ::close(descriptor);
  }
}

}  // namespace sac
