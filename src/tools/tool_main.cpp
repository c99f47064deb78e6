#include "tool_main.hpp"

#include <cstdio>
#include <exception>
#include <iostream>

namespace sac {

int runTool(const char* name, const std::function<int()>& body) {
  try {
    return body();
  } catch (const std::exception& error) {
    std::cout.flush();
    std::fflush(stdout);
    std::fprintf(stderr, "%s: %s\n", name, error.what());
    return kToolUnusable;
  }
}

std::optional<boost::program_options::variables_map> parseCommandLine(
    int argc,
    char** argv,
    boost::program_options::options_description& known,
    const std::string& usage) {
  namespace po = boost::program_options;
  known.add_options()("help,h", "print this help and exit");
  po::variables_map given;
  po::store(po::parse_command_line(argc, argv, known), given);
  if (given.count("help") > 0) {
    std::cout << usage << "\n" << known;
    return std::nullopt;
  }
  po::notify(given);
  return given;
}

}  // namespace sac
