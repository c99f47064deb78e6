#pragma once

#include <string>
#include <vector>

namespace sac {

/// Scalars as they are written to YAML files: read back with the same type and the same value by
/// YAML 1.1 (rosparam) and YAML 1.2 readers alike.

/// Fewest digits that give back the double to the last bit, always with a decimal point and a
/// signed exponent, for YAML 1.1 takes 1e-05 for a string. Not finite: .nan, .inf, -.inf.
std::string yamlNumber(double value);

/// A string, in quotes wherever a plain word could be taken for something else.
std::string yamlText(const std::string& text);

/// "[a, b, c]" of what is written already.
std::string yamlList(const std::vector<std::string>& items);

/// A map in one line, "{key: value, ...}", in the order of addition. Empty: "{}".
class YamlLine {
 public:
  /// `value` is written already: yamlNumber(), yamlText(), yamlList(), std::to_string()…
  YamlLine& add(const std::string& key, const std::string& value);
  std::string text() const { return "{" + items_ + "}"; }
  bool empty() const { return items_.empty(); }

 private:
  std::string items_;
};

}  // namespace sac
