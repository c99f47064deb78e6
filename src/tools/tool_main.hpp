#pragma once

#include <functional>
#include <optional>
#include <string>

#include <boost/program_options.hpp>

namespace sac {

/// Exit status of tools, beside their own: done; bad usage or unreadable input.
inline constexpr int kToolSuccess = 0;
inline constexpr int kToolUnusable = 2;

/// The main function of a tool: the status that `body` returns, or kToolUnusable, with "name:
/// message" on the standard error, when it throws.
int runTool(const char* name, const std::function<int()>& body);

/// Reads a command line into the targets of `known`, to which --help is added. Nothing when help
/// was asked for: it is printed, after `usage`. Throws boost::program_options::error.
std::optional<boost::program_options::variables_map> parseCommandLine(
    int argc,
    char** argv,
    boost::program_options::options_description& known,
    const std::string& usage);

}  // namespace sac
