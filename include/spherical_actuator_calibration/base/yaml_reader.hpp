#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "spherical_actuator_calibration/base/value_range.hpp"

namespace sac {

/// Whether messages tell the line: not where the text came from elsewhere than a file.
enum class LineNumbers { kTold, kOmitted };

/// One map of a YAML file, read key by key with types and ranges. Reading is strict: every error is
/// a ConfigError of the form "file.yaml:12: actuator.poles[3].polar: 2.1 is outside [-1.5708,
/// 1.5708] rad." Entries of sequences count from 0 in these key paths.
///
/// Getters with a fallback serve optional keys: they return it when the key is absent. A key that
/// is present without a value ("polar:") is a wrong type, not an absent key.
///
/// Usage: read everything, then call finish() once on the top map; it rejects what nobody asked
/// for. Copies of a YamlMap refer to the same map.
class YamlMap {
 public:
  /// Top map of a file. Throws when the file cannot be read, is empty, is not YAML, holds several
  /// documents or a document that is no map, or when a key is given twice.
  static YamlMap load(const std::string& path);
  /// The same for text in memory; `name` stands for the file in messages.
  static YamlMap parse(const std::string& text,
                       const std::string& name,
                       LineNumbers line_numbers = LineNumbers::kTold);

  bool has(const std::string& key) const;
  /// Whether a key is there and holds a map.
  bool hasMap(const std::string& key) const;
  /// Whether a key is there and holds a list.
  bool hasList(const std::string& key) const;

  /// The file, or what stands for it in messages.
  const std::string& file() const;

  /// A finite number within the range. Quoted numbers are strings, hence wrong.
  double number(const std::string& key, const ValueRange& range) const;
  double number(const std::string& key, const ValueRange& range, double fallback) const;

  /// A whole number, minimum ≤ value ≤ maximum.
  std::int64_t integer(const std::string& key, std::int64_t minimum, std::int64_t maximum) const;
  std::int64_t integer(const std::string& key,
                       std::int64_t minimum,
                       std::int64_t maximum,
                       std::int64_t fallback) const;

  /// true or false.
  bool boolean(const std::string& key) const;
  bool boolean(const std::string& key, bool fallback) const;

  /// A string, possibly empty. A value that YAML takes for a number or truth value needs quotes.
  std::string text(const std::string& key) const;
  std::string text(const std::string& key, const std::string& fallback) const;
  /// A string with at least one character.
  std::string nonEmptyText(const std::string& key) const;

  /// One of the allowed words.
  std::string choice(const std::string& key, const std::vector<std::string>& allowed) const;
  std::string choice(const std::string& key,
                     const std::vector<std::string>& allowed,
                     const std::string& fallback) const;

  /// A sequence of finite numbers within the range, of any length.
  std::vector<double> numbers(const std::string& key, const ValueRange& range) const;
  /// A sequence of exactly `size` of them.
  std::vector<double> numbers(const std::string& key,
                              const ValueRange& range,
                              std::size_t size) const;

  /// A sequence of strings, each with at least one character.
  std::vector<std::string> texts(const std::string& key) const;

  /// A map below this one.
  YamlMap map(const std::string& key) const;
  /// A sequence of maps.
  std::vector<YamlMap> maps(const std::string& key) const;

  /// Rejects every key of this map, and of all maps taken from it, that no getter asked for.
  void finish() const;

  /// "file.yaml:12: actuator.poles[3].polar" ("name: actuator.poles[3].polar" without line
  /// numbers), for messages about the value of a key that is there
  /// (or, with the line of the map, of one that is not).
  std::string where(const std::string& key) const;

  /// Throws ConfigError: where(key), then the sentence.
  [[noreturn]] void fail(const std::string& key, const std::string& sentence) const;

 private:
  struct State;
  struct Entry;

  explicit YamlMap(std::shared_ptr<State> state);

  const Entry* find(const std::string& key) const;
  const Entry& require(const std::string& key) const;
  YamlMap child(const Entry& entry, const std::string& path) const;
  std::vector<Entry> sequence(const std::string& key) const;

  std::shared_ptr<State> state_;
};

}  // namespace sac
