#include "spherical_actuator_calibration/ros/recording/report_page.hpp"

#include <array>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstddef>
#include <filesystem>
#include <string_view>
#include <system_error>
#include <vector>

#include <sys/wait.h>

#include <fcntl.h>
#include <poll.h>
#include <spawn.h>
#include <unistd.h>

namespace sac {
namespace {

namespace fs = std::filesystem;

/// A page takes seconds; a report of a hundred thousand samples takes minutes.
constexpr std::chrono::minutes kPatience{10};

std::string systemMessage(int error) {
  return std::generic_category().message(error);
}

/// Both ends of a pipe that no child inherits unasked; closed at the end.
class Pipe {
 public:
  Pipe() {
    if (::pipe2(ends_.data(), O_CLOEXEC) != 0) {
      ends_ = {-1, -1};
    }
  }
  ~Pipe() {
    closeEnd(ends_[0]);
    closeEnd(ends_[1]);
  }
  Pipe(const Pipe&) = delete;
  Pipe& operator=(const Pipe&) = delete;

  bool isOpen() const { return ends_[0] >= 0; }
  int reading() const { return ends_[0]; }
  int writing() const { return ends_[1]; }
  /// Only the child writes from now on.
  void closeWriting() { closeEnd(ends_[1]); }

 private:
  static void closeEnd(int& end) {
    if (end >= 0) {
      ::close(end);
      end = -1;
    }
  }

  std::array<int, 2> ends_ = {-1, -1};
};

/// The environment of this process, in which Python also finds the packages that were built or
/// installed with this program, whether or not somebody has sourced setup.bash.
std::vector<std::string> rendererEnvironment(const fs::path& programs) {
  // Programs are in <prefix>/lib/<package>/.
  const fs::path packages = programs.parent_path() / "python3" / "dist-packages";
  const std::string name = "PYTHONPATH=";
  std::string python_path = name + packages.string();
  std::vector<std::string> variables;
  for (char** variable = environ; *variable != nullptr; ++variable) {
    const std::string_view text = *variable;
    if (text.substr(0, name.size()) == name) {
      python_path.append(":").append(text.substr(name.size()));
    } else {
      variables.emplace_back(text);
    }
  }
  variables.push_back(python_path);
  return variables;
}

/// Starts a program with its standard error in the pipe. Returns an errno, 0 on success.
int start(const fs::path& program,
          const std::string& report_path,
          const std::string& page_path,
          const Pipe& errors,
          pid_t& child) {
  std::array<std::string, 3> words = {program.string(), report_path, page_path};
  std::array<char*, 4> arguments = {words[0].data(), words[1].data(), words[2].data(), nullptr};
  std::vector<std::string> variables = rendererEnvironment(program.parent_path());
  std::vector<char*> environment;
  environment.reserve(variables.size() + 1);
  for (std::string& variable : variables) {
    environment.push_back(variable.data());
  }
  environment.push_back(nullptr);
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
  posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
  posix_spawn_file_actions_adddup2(&actions, errors.writing(), STDERR_FILENO);
  const int error = ::posix_spawn(
      &child, program.c_str(), &actions, nullptr, arguments.data(), environment.data());
  posix_spawn_file_actions_destroy(&actions);
  return error;
}

/// What the child says until it ends. False when its time is over.
bool readAll(const Pipe& errors, std::string& said) {
  const auto deadline = std::chrono::steady_clock::now() + kPatience;
  std::array<char, 4096> buffer{};
  for (;;) {
    const auto rest = std::chrono::duration_cast<std::chrono::milliseconds>(
        deadline - std::chrono::steady_clock::now());
    if (rest.count() <= 0) {
      return false;
    }
    pollfd waiting = {errors.reading(), POLLIN, 0};
    if (::poll(&waiting, 1, static_cast<int>(rest.count())) <= 0) {
      continue;
    }
    const ssize_t count = ::read(errors.reading(), buffer.data(), buffer.size());
    if (count == 0) {
      return true;
    }
    if (count > 0) {
      said.append(buffer.data(), static_cast<std::size_t>(count));
    }
  }
}

int waitFor(pid_t child) {
  int status = 0;
  while (::waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  return status;
}

/// The last line: what goes before are warnings or a trace.
std::string lastLine(std::string text) {
  while (!text.empty() && text.back() == '\n') {
    text.pop_back();
  }
  const auto before = text.find_last_of('\n');
  return before == std::string::npos ? text : text.substr(before + 1);
}

}  // namespace

std::string writeReportPage(const std::string& report_path, const std::string& page_path) {
  const std::string failure = "There is no page of the report: ";
  std::error_code unknown;
  const fs::path self = fs::read_symlink("/proc/self/exe", unknown);
  const fs::path program = self.parent_path() / "render_report";
  Pipe errors;
  if (!errors.isOpen()) {
    return failure + systemMessage(errno) + ".";
  }
  pid_t child = -1;
  const int error = start(program, report_path, page_path, errors, child);
  if (error != 0) {
    return failure + program.string() + " cannot be started: " + systemMessage(error) + ".";
  }
  errors.closeWriting();
  std::string said;
  const bool has_ended = readAll(errors, said);
  if (!has_ended) {
    ::kill(child, SIGKILL);
  }
  const int status = waitFor(child);
  if (!has_ended) {
    return failure + "it took too long.";
  }
  if (WIFEXITED(status) && WEXITSTATUS(status) == 0) {
    return {};
  }
  return failure + (said.empty() ? program.string() + " ended early." : lastLine(said));
}

}  // namespace sac
