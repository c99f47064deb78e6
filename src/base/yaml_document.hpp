#pragma once

#include <cstddef>
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

/// Maps and lists within each other, at most.
inline constexpr std::size_t kDeepestYaml = 64;
/// Of a document, at most; an alias counts as much as what it stands for.
inline constexpr std::size_t kMostYamlNodes = 1'000'000;

/// The one document of a text; null when there is none. Its size is known before it is built.
/// Throws YamlDefect.
YAML::Node parseSingleDocument(const std::string& text);

}  // namespace sac
