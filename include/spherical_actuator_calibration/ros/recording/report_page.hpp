#pragma once

#include <string>

namespace sac {

/// Makes the page for people of a report file (assessment/report_file.hpp), by the program
/// render_report, which lies beside this one in a build as in an installation. The page is replaced
/// if it exists, and is whole or as before. Waits for it: some seconds.
///
/// Returns nothing, or, when there is no page, why: a sentence. Never throws, for the report stands
/// without its page.
std::string writeReportPage(const std::string& report_path, const std::string& page_path);

}  // namespace sac
