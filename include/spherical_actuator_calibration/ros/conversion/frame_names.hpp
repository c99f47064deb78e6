#pragma once

#include <string>

namespace sac {

/// Whether a header's frame is the wanted one; a leading slash, as in old recordings, is tolerated.
bool isFrame(const std::string& frame_id, const std::string& frame);

}  // namespace sac
