#include "spherical_actuator_calibration/ros/recording/report_page.hpp"

#include <chrono>
#include <exception>
#include <filesystem>
#include <future>
#include <string>
#include <system_error>
#include <vector>

#include <boost/asio/io_context.hpp>
#include <boost/process.hpp>

namespace sac {
namespace {

namespace bp = boost::process;
namespace fs = std::filesystem;

/// A page takes seconds; a report of a hundred thousand samples takes minutes.
constexpr std::chrono::minutes kPatience{10};
/// A killed program ends at once [s].
constexpr std::chrono::seconds kEnd{1};

/// The last line: what goes before are warnings or a trace.
std::string lastLine(std::string text) {
  while (!text.empty() && text.back() == '\n') {
    text.pop_back();
  }
  const auto before = text.find_last_of('\n');
  return before == std::string::npos ? text : text.substr(before + 1);
}

/// The environment of this process, in which Python also finds the packages that were built or
/// installed with this program, whether or not somebody has sourced setup.bash.
bp::environment rendererEnvironment(const fs::path& program) {
  bp::environment environment = boost::this_process::environment();
  // Programs are in <prefix>/lib/<package>/.
  const fs::path packages = program.parent_path().parent_path() / "python3" / "dist-packages";
  const std::string before = environment["PYTHONPATH"].to_string();
  environment["PYTHONPATH"] = packages.string() + (before.empty() ? "" : ":" + before);
  return environment;
}

/// Runs a program to its end. Returns nothing, or why it failed. Throws std::system_error where
/// the system has no pipe for it.
std::string run(const std::string& program, const std::vector<std::string>& arguments) {
  boost::asio::io_context running;  // the reading of what it says, and the waiting for its end
  std::future<std::string> said;
  std::error_code error;
  bp::child child(program,
                  bp::args(arguments),
                  rendererEnvironment(program),
                  (bp::std_in < bp::null),
                  (bp::std_out > bp::null),
                  (bp::std_err > said),
                  running,
                  error);
  if (error) {
    return program + " cannot be started: " + error.message() + ".";
  }
  running.run_for(kPatience);
  if (!running.stopped()) {
    child.terminate(error);
    running.run_for(kEnd);
    return "it took too long.";
  }
  child.wait(error);
  if (child.exit_code() == 0) {
    return {};
  }
  const std::string sentence = lastLine(said.get());
  return sentence.empty() ? program + " ended early." : sentence;
}

}  // namespace

std::string writeReportPage(const std::string& report_path, const std::string& page_path) {
  std::error_code unknown;
  const fs::path self = fs::read_symlink("/proc/self/exe", unknown);
  const std::string program = (self.parent_path() / "render_report").string();
  std::string failure;
  try {
    failure = run(program, {report_path, page_path});
  } catch (const std::exception& error) {
    failure = std::string(error.what()) + ".";
  }
  return failure.empty() ? failure : "There is no page of the report: " + failure;
}

}  // namespace sac
