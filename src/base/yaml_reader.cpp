#include "spherical_actuator_calibration/base/yaml_reader.hpp"

#include <charconv>
#include <cmath>
#include <map>
#include <optional>
#include <set>
#include <system_error>
#include <utility>

#include <yaml-cpp/yaml.h>

#include "spherical_actuator_calibration/base/error.hpp"
#include "spherical_actuator_calibration/base/input_file.hpp"
#include "spherical_actuator_calibration/base/number_text.hpp"
#include "spherical_actuator_calibration/base/printable_text.hpp"
#include "yaml_document.hpp"

namespace sac {

namespace {

/// Line of what stands in no file that the user could open.
constexpr int kNoLine = 0;

}  // namespace

/// A value and the line where it, or its key, stands.
struct YamlMap::Entry {
  YAML::Node node;
  int line;
};

/// What the copies of one YamlMap share.
struct YamlMap::State {
  std::string file;
  LineNumbers line_numbers;
  std::string path;  ///< key path of this map; empty for the top map
  int line;
  std::map<std::string, Entry> entries;
  std::set<std::string> asked_for;
  std::vector<std::shared_ptr<State>> children;

  std::string keyPath(const std::string& key) const {
    return path.empty() ? excerpt(key) : path + "." + excerpt(key);
  }

  int lineOf(const YAML::Node& node) const {
    return line_numbers == LineNumbers::kTold ? node.Mark().line + 1 : kNoLine;
  }
};

namespace {

/// "file.yaml:12: key.path", each of the last two only if there is one.
std::string location(const std::string& file, int line, const std::string& path) {
  const std::string place = line == kNoLine ? file : file + ":" + std::to_string(line);
  return path.empty() ? place : place + ": " + path;
}

[[noreturn]] void failAt(const std::string& file,
                         int line,
                         const std::string& path,
                         const std::string& sentence) {
  throw ConfigError(location(file, line, path) + ": " + sentence);
}

std::string entryPath(const std::string& path, std::size_t index) {
  return path + "[" + std::to_string(index) + "]";
}

/// How a value of the wrong type is called in messages.
std::string describe(const YAML::Node& node) {
  if (node.IsMap()) {
    return "a map";
  }
  if (node.IsSequence()) {
    return "a list";
  }
  return node.IsScalar() ? "\"" + excerpt(node.Scalar()) + "\"" : "an empty value";
}

/// A scalar that YAML may take for something else than a string.
bool isPlainScalar(const YAML::Node& node) {
  constexpr const char* kTagOfQuoted = "!";
  return node.IsScalar() && node.Tag() != kTagOfQuoted;
}

/// The text of a number without its plus sign, which the readers of numbers do not know.
std::string withoutPlus(const std::string& text) {
  return text.size() > 1 && text[0] == '+' && text[1] != '-' ? text.substr(1) : text;
}

/// Reads the whole text as a number, YAML's spellings of infinity and NaN included.
bool readNumber(const YAML::Node& node, double& number) {
  if (!isPlainScalar(node)) {
    return false;
  }
  if (const std::optional<double> value = parsedNumber(withoutPlus(node.Scalar()))) {
    number = *value;
    return true;
  }
  return YAML::convert<double>::decode(node, number) && !std::isfinite(number);
}

/// Reads the whole text as a whole number.
bool readNumber(const YAML::Node& node, std::int64_t& number) {
  if (!isPlainScalar(node)) {
    return false;
  }
  const std::string text = withoutPlus(node.Scalar());
  const char* const end = text.data() + text.size();
  const std::from_chars_result result = std::from_chars(text.data(), end, number);
  return result.ec == std::errc() && result.ptr == end;
}

bool readBoolean(const YAML::Node& node, bool& value) {
  // A lone y or n is a name (of a joint, say), as for other readers; yaml-cpp would take it.
  return isPlainScalar(node) && node.Scalar().size() > 1 &&
         YAML::convert<bool>::decode(node, value);
}

bool isText(const YAML::Node& node) {
  double number = 0.0;
  bool truth = false;
  return node.IsScalar() && !readNumber(node, number) && !readBoolean(node, truth);
}

std::string join(const std::vector<std::string>& words) {
  std::string text;
  for (const std::string& word : words) {
    text += (text.empty() ? "" : ", ") + word;
  }
  return text;
}

}  // namespace

YamlMap::YamlMap(std::shared_ptr<State> state) : state_(std::move(state)) {}

YamlMap YamlMap::load(const std::string& path) {
  return parse(readInputFile(path, kLargestDescription), path);
}

YamlMap YamlMap::parse(const std::string& text, const std::string& name, LineNumbers line_numbers) {
  YAML::Node document;
  try {
    document = parseSingleDocument(text);
  } catch (const YamlDefect& defect) {
    failAt(name, defect.line, "", defect.what());
  }
  if (!document.IsDefined() || document.IsNull()) {
    throw ConfigError(name + ": the file is empty.");
  }
  const auto above = std::make_shared<State>(State{name, line_numbers, "", kNoLine, {}, {}, {}});
  return YamlMap(above).child({document, above->lineOf(document)}, "");
}

YamlMap YamlMap::child(const Entry& entry, const std::string& path) const {
  const std::string& file = state_->file;
  if (!entry.node.IsMap()) {
    failAt(file, entry.line, path, describe(entry.node) + " is not a map of keys and values.");
  }
  State state{file, state_->line_numbers, path, entry.line, {}, {}, {}};
  for (const auto& pair : entry.node) {
    const int line = state_->lineOf(pair.first);
    if (!pair.first.IsScalar()) {
      failAt(file, line, path, describe(pair.first) + " cannot be a key.");
    }
    const std::string& key = pair.first.Scalar();
    const auto [place, is_new] = state.entries.try_emplace(key, Entry{pair.second, line});
    if (!is_new) {
      failAt(file,
             line,
             state.keyPath(key),
             "the key is given twice, first in line " + std::to_string(place->second.line) + ".");
    }
  }
  state_->children.push_back(std::make_shared<State>(std::move(state)));
  return YamlMap(state_->children.back());
}

const YamlMap::Entry* YamlMap::find(const std::string& key) const {
  state_->asked_for.insert(key);
  const auto place = state_->entries.find(key);
  return place == state_->entries.end() ? nullptr : &place->second;
}

const YamlMap::Entry& YamlMap::require(const std::string& key) const {
  const Entry* entry = find(key);
  if (entry == nullptr) {
    fail(key, "the key is missing.");
  }
  return *entry;
}

bool YamlMap::has(const std::string& key) const {
  return find(key) != nullptr;
}

bool YamlMap::hasMap(const std::string& key) const {
  const Entry* entry = find(key);
  return entry != nullptr && entry->node.IsMap();
}

bool YamlMap::hasList(const std::string& key) const {
  const Entry* entry = find(key);
  return entry != nullptr && entry->node.IsSequence();
}

const std::string& YamlMap::file() const {
  return state_->file;
}

double YamlMap::number(const std::string& key, const ValueRange& range) const {
  const Entry& entry = require(key);
  double value = 0.0;
  if (!readNumber(entry.node, value)) {
    fail(key, describe(entry.node) + " is not a number; allowed is " + range.text() + ".");
  }
  requireInRange(where(key), value, range);
  return value;
}

double YamlMap::number(const std::string& key, const ValueRange& range, double fallback) const {
  return has(key) ? number(key, range) : fallback;
}

std::int64_t YamlMap::integer(const std::string& key,
                              std::int64_t minimum,
                              std::int64_t maximum) const {
  const Entry& entry = require(key);
  const std::string range = "[" + std::to_string(minimum) + ", " + std::to_string(maximum) + "]";
  std::int64_t value = 0;
  if (!readNumber(entry.node, value)) {
    fail(key, describe(entry.node) + " is not a whole number; allowed is " + range + ".");
  }
  if (value < minimum || value > maximum) {
    fail(key, std::to_string(value) + " is outside " + range + ".");
  }
  return value;
}

std::int64_t YamlMap::integer(const std::string& key,
                              std::int64_t minimum,
                              std::int64_t maximum,
                              std::int64_t fallback) const {
  return has(key) ? integer(key, minimum, maximum) : fallback;
}

bool YamlMap::boolean(const std::string& key) const {
  const Entry& entry = require(key);
  bool value = false;
  if (!readBoolean(entry.node, value)) {
    fail(key, describe(entry.node) + " is neither true nor false.");
  }
  return value;
}

bool YamlMap::boolean(const std::string& key, bool fallback) const {
  return has(key) ? boolean(key) : fallback;
}

std::string YamlMap::text(const std::string& key) const {
  const Entry& entry = require(key);
  if (!isText(entry.node)) {
    fail(key, describe(entry.node) + " is not a string; write a string in quotes.");
  }
  return entry.node.Scalar();
}

std::string YamlMap::text(const std::string& key, const std::string& fallback) const {
  return has(key) ? text(key) : fallback;
}

std::string YamlMap::nonEmptyText(const std::string& key) const {
  std::string value = text(key);
  if (value.empty()) {
    fail(key, "the string is empty; at least one character is needed.");
  }
  return value;
}

std::string YamlMap::choice(const std::string& key, const std::vector<std::string>& allowed) const {
  const Entry& entry = require(key);
  for (const std::string& word : allowed) {
    if (entry.node.IsScalar() && entry.node.Scalar() == word) {
      return word;
    }
  }
  fail(key, describe(entry.node) + " is not one of: " + join(allowed) + ".");
}

std::string YamlMap::choice(const std::string& key,
                            const std::vector<std::string>& allowed,
                            const std::string& fallback) const {
  return has(key) ? choice(key, allowed) : fallback;
}

std::vector<YamlMap::Entry> YamlMap::sequence(const std::string& key) const {
  const Entry& entry = require(key);
  if (!entry.node.IsSequence()) {
    fail(key, describe(entry.node) + " is not a list.");
  }
  std::vector<Entry> items;
  for (const YAML::Node& item : entry.node) {
    items.push_back({item, state_->lineOf(item)});
  }
  return items;
}

std::vector<double> YamlMap::numbers(const std::string& key, const ValueRange& range) const {
  std::vector<double> values;
  for (const Entry& item : sequence(key)) {
    const std::string path = entryPath(state_->keyPath(key), values.size());
    double value = 0.0;
    if (!readNumber(item.node, value)) {
      failAt(state_->file,
             item.line,
             path,
             describe(item.node) + " is not a number; allowed is " + range.text() + ".");
    }
    requireInRange(location(state_->file, item.line, path), value, range);
    values.push_back(value);
  }
  return values;
}

std::vector<double> YamlMap::numbers(const std::string& key,
                                     const ValueRange& range,
                                     std::size_t size) const {
  std::vector<double> values = numbers(key, range);
  if (values.size() != size) {
    fail(key,
         "the list has " + std::to_string(values.size()) + " numbers; exactly " +
             std::to_string(size) + " are needed.");
  }
  return values;
}

std::vector<std::string> YamlMap::texts(const std::string& key) const {
  std::vector<std::string> values;
  for (const Entry& item : sequence(key)) {
    if (!isText(item.node) || item.node.Scalar().empty()) {
      failAt(state_->file,
             item.line,
             entryPath(state_->keyPath(key), values.size()),
             describe(item.node) + " is not a string with at least one character.");
    }
    values.push_back(item.node.Scalar());
  }
  return values;
}

YamlMap YamlMap::map(const std::string& key) const {
  return child(require(key), state_->keyPath(key));
}

std::vector<YamlMap> YamlMap::maps(const std::string& key) const {
  std::vector<YamlMap> items;
  for (const Entry& item : sequence(key)) {
    items.push_back(child(item, entryPath(state_->keyPath(key), items.size())));
  }
  return items;
}

void YamlMap::finish() const {
  for (const auto& [key, entry] : state_->entries) {
    if (state_->asked_for.count(key) == 0) {
      const std::vector<std::string> known(state_->asked_for.begin(), state_->asked_for.end());
      const std::string hint = known.empty() ? "." : "; known are: " + join(known) + ".";
      fail(key, "the key is unknown here" + hint);
    }
  }
  for (const std::shared_ptr<State>& item : state_->children) {
    YamlMap(item).finish();
  }
}

std::string YamlMap::where(const std::string& key) const {
  const auto place = state_->entries.find(key);
  const int line = place == state_->entries.end() ? state_->line : place->second.line;
  return location(state_->file, line, state_->keyPath(key));
}

void YamlMap::fail(const std::string& key, const std::string& sentence) const {
  throw ConfigError(where(key) + ": " + sentence);
}

}  // namespace sac
