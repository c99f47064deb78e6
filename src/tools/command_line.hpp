#pragma once

#include <iosfwd>
#include <memory>
#include <optional>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include <boost/program_options.hpp>

#include "spherical_actuator_calibration/base/atomic_file.hpp"
#include "spherical_actuator_calibration/base/error.hpp"

namespace sac {

/// The command line of a tool: options are declared with the variables they fill in, whose present
/// values are the defaults, and --help is there by itself. Options must be written in full: a
/// misspelt one must not become another.
class CommandLine {
 public:
  /// `introduction`: what --help prints before the options.
  explicit CommandLine(std::string introduction);

  /// The options added from now on stand below this caption.
  void beginGroup(const std::string& caption);

  /// An option that must be given. `unit` stands for its value in the help.
  void addRequired(const std::string& name,
                   std::string& target,
                   const std::string& unit,
                   const std::string& help);

  /// An option whose default is the present value of `target`.
  template <typename Value>
  void add(const std::string& name,
           Value& target,
           const std::string& unit,
           const std::string& help) {
    // Shown with few digits.
    std::ostringstream shown;
    shown << target;
    addOption(name,
              boost::program_options::value<Value>(&target)
                  ->default_value(target, shown.str())
                  ->value_name(unit),
              help);
  }

  /// An option without a default.
  template <typename Value>
  void add(const std::string& name,
           std::optional<Value>& target,
           const std::string& unit,
           const std::string& help) {
    const auto store = [name, &target](const Value& value) {
      requireContent(name, value);
      target = value;
    };
    addOption(
        name, boost::program_options::value<Value>()->value_name(unit)->notifier(store), help);
  }

  /// A switch that sets `target`.
  void addSwitch(const std::string& name, bool& target, const std::string& help);

  /// --force: replaces files that exist.
  void addForce(OverwritePolicy& target);

  /// What is given without a name of an option.
  void addOperands(std::vector<std::string>& target);

  /// Fills in the targets. False when help was asked for: it is printed to `out` and nothing else
  /// is done. Throws ConfigError that names the option.
  bool parse(int argc, const char* const* argv, std::ostream& out);

  /// Whether an option was given, even with its default value. After parse().
  bool wasGiven(const std::string& name) const;

 private:
  void addOption(const std::string& name,
                 const boost::program_options::value_semantic* value,
                 const std::string& help);

  static void requireContent(const std::string& name, const std::string& value);
  template <typename Value>
  static void requireContent(const std::string& /*name*/, const Value& /*value*/) {}

  std::string introduction_;
  std::vector<std::unique_ptr<boost::program_options::options_description>> groups_;
  std::vector<std::string> required_;
  std::vector<std::string>* operands_ = nullptr;
  boost::program_options::variables_map given_;
};

/// The value that a word of an option stands for. Throws ConfigError that names the option and the
/// words it takes: "--tracker: "maybe" is none of: on, off."
template <typename Value>
Value choose(const std::string& option,
             const std::string& word,
             const std::vector<std::pair<std::string, Value>>& choices) {
  std::string words;
  for (const auto& [name, value] : choices) {
    if (name == word) {
      return value;
    }
    words += (words.empty() ? "" : ", ") + name;
  }
  throw ConfigError("--" + option + ": \"" + word + "\" is none of: " + words + ".");
}

}  // namespace sac
