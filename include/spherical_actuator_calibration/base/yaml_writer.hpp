#pragma once

#include <optional>
#include <sstream>
#include <string>
#include <vector>

namespace sac {

// Scalars as they are written to YAML files: read back with the same type and the same value by
// YAML 1.1 (rosparam) and YAML 1.2 readers alike.

/// Fewest digits that give back the double to the last bit, always with a decimal point and a
/// signed exponent, for YAML 1.1 takes 1e-05 for a string. Not finite: .nan, .inf, -.inf.
std::string yamlNumber(double value);

/// A string, in quotes wherever a plain word could be taken for something else.
std::string yamlText(const std::string& text);

/// true or false.
std::string yamlBoolean(bool value);

/// "[a, b, c]" of what is written already.
std::string yamlList(const std::vector<std::string>& items);

/// "[0.1, 0.2]" of a container of doubles, of Eigen or not.
template <typename Numbers>
std::string yamlNumbers(const Numbers& values) {
  std::vector<std::string> items;
  items.reserve(static_cast<std::size_t>(values.size()));
  for (const double value : values) {
    items.push_back(yamlNumber(value));
  }
  return yamlList(items);
}

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

/// A YAML file as it grows: maps and lists in one another, two spaces a level, level 0 on top.
/// Values are written already, as for YamlLine.
class YamlWriter {
 public:
  /// What follows a level deeper belongs to this key.
  void map(int level, const std::string& key) { line(level, key + ":"); }
  void entry(int level, const std::string& key, const std::string& value) {
    line(level, key + ": " + value);
  }
  /// Nothing where there is no value.
  void optional(int level, const std::string& key, const std::optional<double>& value);
  /// One line per item; "key: []" without any.
  void list(int level, const std::string& key, const std::vector<std::string>& items);
  /// A line as it is: a comment, the first key of a map in a list.
  void line(int level, const std::string& text);

  std::string text() const { return text_.str(); }

 private:
  std::ostringstream text_;
};

}  // namespace sac
