#include "revision_lines.hpp"

#include <algorithm>
#include <cmath>

#include "shown_unit.hpp"
#include "spherical_actuator_calibration/CalibrationReport.h"
#include "spherical_actuator_calibration/base/printable_text.hpp"
#include "spherical_actuator_calibration/base/text_format.hpp"

namespace sac {
namespace {

std::string folderOf(const std::string& path) {
  const std::size_t end = path.find_last_of('/');
  if (end == std::string::npos || end == 0) {
    return path;
  }
  const std::size_t before = path.find_last_of('/', end - 1);
  return path.substr(before + 1, end - before - 1);
}

std::string readable(std::string date) {
  std::replace(date.begin(), date.end(), 'T', ' ');
  if (!date.empty() && date.back() == 'Z') {
    date.pop_back();
  }
  return date;
}

std::string errorInWords(const msg::Revision& revision) {
  if (!std::isfinite(revision.error_before) || !std::isfinite(revision.error_after)) {
    return "";
  }
  const ShownUnit unit = shownIn(revision.error_unit);
  return number("%.4g", unit.factor * revision.error_before) + " → " +
         withUnit("%.4g", unit.factor * revision.error_after, unit.name) + ", " +
         counted(revision.samples_used,
                 revision.origin == msg::CalibrationReport::MOTION ? "window" : "sample");
}

}  // namespace

std::vector<RevisionLine> revisionLines(const std::vector<msg::Revision>& revisions,
                                        std::uint32_t in_force) {
  std::vector<RevisionLine> lines;
  lines.reserve(revisions.size());
  for (const msg::Revision& revision : revisions) {
    RevisionLine line;
    line.number = revision.number;
    line.restorable = revision.restorable != 0;
    line.name = (line.restorable ? "" : printable(folderOf(revision.session)) + " ") +
                std::to_string(revision.number) +
                (line.restorable && line.number == in_force ? ", in force" : "");
    line.date = printable(readable(revision.date));
    line.origin = printable(revision.origin);
    line.error = printable(errorInWords(revision));
    line.drift = printable(revision.drift);
    lines.push_back(line);
  }
  std::reverse(lines.begin(), lines.end());
  return lines;
}

}  // namespace sac
