#pragma once

#include <functional>
#include <iosfwd>
#include <memory>
#include <optional>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include <boost/program_options.hpp>

#include "file_roles.hpp"
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

  // The same of files. What a run writes must be no file that it reads or writes already:
  // FileRoles.
  template <typename Path>
  void addInput(const std::string& name,
                Path& path,
                const std::string& unit,
                const std::string& help) {
    add(name, path, unit, help);
    roles_.emplace_back([name, &path](FileRoles& files) { files.read("--" + name, path); });
  }
  template <typename Path>
  void addOutput(const std::string& name,
                 Path& path,
                 const std::string& unit,
                 const std::string& help) {
    add(name, path, unit, help);
    roles_.emplace_back([name, &path](FileRoles& files) { files.write("--" + name, path); });
  }
  void addRequiredInput(const std::string& name,
                        std::string& path,
                        const std::string& unit,
                        const std::string& help);
  void addRequiredOutput(const std::string& name,
                         std::string& path,
                         const std::string& unit,
                         const std::string& help);

  /// A switch that sets `target`.
  void addSwitch(const std::string& name, bool& target, const std::string& help);

  /// --force: replaces files that exist.
  void addForce(OverwritePolicy& target);

  /// Files to read that are given without a name of an option. `name` stands for one in the help.
  void addInputs(std::vector<std::string>& paths, const std::string& name);

  /// Fills in the targets. False when help was asked for: it is printed to `out` and nothing else
  /// is done. Throws ConfigError that names the option.
  bool parse(int argc, const char* const* argv, std::ostream& out);

  /// After parse(): what else is written because of an option. Throws ConfigError when the run
  /// reads or writes that file already.
  void requireSeparate(const std::string& name, const std::string& path);

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
  std::vector<std::function<void(FileRoles&)>> roles_;  ///< of the files that are given
  FileRoles files_;
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
