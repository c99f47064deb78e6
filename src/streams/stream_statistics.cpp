#include "spherical_actuator_calibration/streams/stream_statistics.hpp"

#include <numeric>
#include <vector>

namespace sac {
namespace {

/// By DropReason.
constexpr std::array<const char*, kDropReasons> kDropTexts = {
    "without stamp",
    "not finite",
    "not a unit quaternion",
    "of wrong size",
    "repeated",
    "late",
    "with a stamp that leaps away",
    "behind the other streams",
};

std::string joined(const std::vector<std::string>& parts) {
  std::string text;
  for (const std::string& part : parts) {
    text += (text.empty() ? "" : ", ") + part;
  }
  return text;
}

std::string counted(std::uint64_t count, const std::string& singular, const std::string& plural) {
  return std::to_string(count) + " " + (count == 1 ? singular : plural);
}

std::string dropText(const StreamStatistics& statistics) {
  std::vector<std::string> reasons;
  for (std::size_t k = 0; k < kDropReasons; ++k) {
    if (statistics.dropped[k] > 0) {
      reasons.push_back(std::to_string(statistics.dropped[k]) + " " + kDropTexts[k]);
    }
  }
  const std::string total = std::to_string(statistics.droppedInAll()) + " dropped";
  return reasons.empty() ? total : total + " (" + joined(reasons) + ")";
}

}  // namespace

const char* describe(DropReason reason) {
  return kDropTexts[static_cast<std::size_t>(reason)];
}

std::uint64_t StreamStatistics::droppedInAll() const {
  return std::accumulate(dropped.begin(), dropped.end(), std::uint64_t{0});
}

std::string describe(const std::string& stream, const StreamStatistics& statistics) {
  std::vector<std::string> parts = {std::to_string(statistics.received) + " received",
                                    dropText(statistics)};
  if (statistics.gaps > 0) {
    parts.push_back(counted(statistics.gaps, "gap", "gaps"));
  }
  if (statistics.clock_resets > 0) {
    parts.push_back(counted(statistics.clock_resets, "clock reset", "clock resets"));
  }
  if (statistics.glitches > 0) {
    parts.push_back(counted(statistics.glitches, "glitch", "glitches") + " left out of means");
  }
  return stream + ": " + joined(parts) + ".";
}

}  // namespace sac
