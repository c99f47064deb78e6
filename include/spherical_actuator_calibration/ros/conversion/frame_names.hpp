#pragma once

#include <string>

namespace sac {

/// Whether a header's frame is the wanted one; a leading slash, as in old recordings, is tolerated.
bool isFrame(const std::string& frame_id, const std::string& frame);

/// What is wrong with a message in another frame: "is in the frame "a", not in "b"".
std::string otherFrame(const std::string& frame_id, const std::string& frame);

}  // namespace sac
