#include "spherical_actuator_calibration/base/yaml_writer.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "spherical_actuator_calibration/base/number_text.hpp"

namespace sac {
namespace {

bool isLetter(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z');
}

bool isPlainCharacter(char c) {
  return isLetter(c) || (c >= '0' && c <= '9') || c == '_' || c == '-' || c == '.' || c == '/';
}

/// Words that some YAML reader takes for a truth value, nothing or a number.
bool isReservedWord(std::string word) {
  constexpr std::array<const char*, 12> kReserved = {
      "y", "n", "yes", "no", "on", "off", "true", "false", "null", "nan", "inf", "infinity"};
  std::transform(word.begin(), word.end(), word.begin(), [](char c) {
    return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  });
  return std::any_of(
      kReserved.begin(), kReserved.end(), [&](const char* other) { return word == other; });
}

bool isPlainWord(const std::string& text) {
  return !text.empty() && (isLetter(text[0]) || text[0] == '_' || text[0] == '/') &&
         std::all_of(text.begin(), text.end(), isPlainCharacter) && !isReservedWord(text);
}

/// "\x1b": a character that must not stand in a YAML file as it is.
std::string escaped(unsigned char c) {
  constexpr const char* kDigits = "0123456789abcdef";
  return std::string("\\x") + kDigits[c >> 4U] + kDigits[c & 0xFU];
}

}  // namespace

std::string yamlNumber(double value) {
  if (std::isnan(value)) {
    return ".nan";
  }
  if (std::isinf(value)) {
    return value > 0.0 ? ".inf" : "-.inf";
  }
  std::string text = shortestText(value);
  if (text.find('.') == std::string::npos) {
    text.insert(std::min(text.find('e'), text.size()), ".0");
  }
  return text;
}

std::string yamlText(const std::string& text) {
  if (isPlainWord(text)) {
    return text;
  }
  constexpr unsigned char kFirstPrintable = 0x20;
  constexpr unsigned char kDelete = 0x7f;
  std::string quoted = "\"";
  for (const char c : text) {
    const auto code = static_cast<unsigned char>(c);
    if (code < kFirstPrintable || code == kDelete) {
      quoted += escaped(code);
      continue;
    }
    if (c == '"' || c == '\\') {
      quoted += '\\';
    }
    quoted += c;
  }
  return quoted + "\"";
}

std::string yamlBoolean(bool value) {
  return value ? "true" : "false";
}

std::string yamlList(const std::vector<std::string>& items) {
  std::string text;
  for (const std::string& item : items) {
    text += (text.empty() ? "" : ", ") + item;
  }
  return "[" + text + "]";
}

YamlLine& YamlLine::add(const std::string& key, const std::string& value) {
  items_ += (items_.empty() ? "" : ", ") + key + ": " + value;
  return *this;
}

void YamlWriter::optional(int level, const std::string& key, const std::optional<double>& value) {
  if (value) {
    entry(level, key, yamlNumber(*value));
  }
}

void YamlWriter::list(int level, const std::string& key, const std::vector<std::string>& items) {
  line(level, key + (items.empty() ? ": []" : ":"));
  for (const std::string& item : items) {
    line(level + 1, "- " + item);
  }
}

void YamlWriter::line(int level, const std::string& text) {
  text_ << std::string(2 * static_cast<std::size_t>(level), ' ') << text << "\n";
}

}  // namespace sac
