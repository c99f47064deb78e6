#pragma once

#include <stdexcept>
#include <string>

#include <yaml-cpp/yaml.h>

namespace sac {

/// Why a text is no single YAML document of a size that is read.
struct YamlDefect : std::runtime_error {
  YamlDefect(int line_number, const std::string& sentence)
      : std::runtime_error(sentence), line(line_number) {}
  int line;  ///< counts from 1
};

/// The one document of a text; null when there is none. Its size is known before it is built: maps
/// and lists within each other are at most 64 deep, and it has at most a million nodes, where an
/// alias counts as much as what it stands for. Throws YamlDefect.
YAML::Node parseSingleDocument(const std::string& text);

}  // namespace sac
