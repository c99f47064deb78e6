#include "command_line.hpp"

#include <ostream>
#include <utility>

namespace sac {

namespace po = boost::program_options;

namespace {

constexpr char kOperands[] = "operands";

}  // namespace

CommandLine::CommandLine(std::string introduction) : introduction_(std::move(introduction)) {}

void CommandLine::beginGroup(const std::string& caption) {
  const bool is_first = groups_.empty();
  groups_.push_back(std::make_unique<po::options_description>(caption));
  if (is_first) {
    groups_.back()->add_options()("help,h", "print this help and exit");
  }
}

void CommandLine::addRequired(const std::string& name,
                              std::string& target,
                              const std::string& unit,
                              const std::string& help) {
  required_.push_back(name);
  const auto store = [name, &target](const std::string& value) {
    requireContent(name, value);
    target = value;
  };
  addOption(name, po::value<std::string>()->value_name(unit)->notifier(store), help + "; needed");
}

void CommandLine::addRequiredInput(const std::string& name,
                                   std::string& path,
                                   const std::string& unit,
                                   const std::string& help) {
  addRequired(name, path, unit, help);
  roles_.emplace_back([name, &path](FileRoles& files) { files.read("--" + name, path); });
}

void CommandLine::addRequiredOutput(const std::string& name,
                                    std::string& path,
                                    const std::string& unit,
                                    const std::string& help) {
  addRequired(name, path, unit, help);
  roles_.emplace_back([name, &path](FileRoles& files) { files.write("--" + name, path); });
}

void CommandLine::addSwitch(const std::string& name, bool& target, const std::string& help) {
  addOption(name, po::bool_switch(&target), help);
}

void CommandLine::addForce(OverwritePolicy& target) {
  const auto store = [&target](bool force) {
    if (force) {
      target = OverwritePolicy::kReplace;
    }
  };
  addOption("force", po::bool_switch()->notifier(store), "replace files that exist");
}

void CommandLine::addInputs(std::vector<std::string>& paths, const std::string& name) {
  operands_ = &paths;
  roles_.emplace_back([name, &paths](FileRoles& files) { files.read(name, paths); });
}

bool CommandLine::parse(int argc, const char* const* argv, std::ostream& out) {
  given_.clear();
  files_ = FileRoles();
  po::options_description shown;
  for (const auto& group : groups_) {
    shown.add(*group);
  }
  po::options_description all;
  all.add(shown);
  po::positional_options_description positional;
  if (operands_ != nullptr) {
    all.add_options()(kOperands, po::value(operands_));
    positional.add(kOperands, -1);
  }
  const int style = po::command_line_style::unix_style & ~po::command_line_style::allow_guessing;
  try {
    po::store(
        po::command_line_parser(argc, argv).options(all).positional(positional).style(style).run(),
        given_);
    if (given_.count("help") > 0) {
      out << introduction_ << shown << "\n";
      return false;
    }
    for (const std::string& name : required_) {
      if (given_.count(name) == 0) {
        throw ConfigError("--" + name + " is needed; --help tells what it is.");
      }
    }
    po::notify(given_);
  } catch (const po::error& error) {
    throw ConfigError(std::string(error.what()) + "; --help tells the options.");
  }
  for (const auto& enter : roles_) {
    enter(files_);
  }
  files_.requireSeparate();
  return true;
}

void CommandLine::requireSeparate(const std::string& name, const std::string& path) {
  files_.write("--" + name, path);
  files_.requireSeparate();
}

bool CommandLine::wasGiven(const std::string& name) const {
  return given_.count(name) > 0 && !given_[name].defaulted();
}

void CommandLine::addOption(const std::string& name,
                            const po::value_semantic* value,
                            const std::string& help) {
  if (groups_.empty()) {
    beginGroup("Options");
  }
  groups_.back()->add_options()(name.c_str(), value, help.c_str());
}

void CommandLine::requireContent(const std::string& name, const std::string& value) {
  if (value.empty()) {
    throw ConfigError("--" + name + " needs a value.");
  }
}

}  // namespace sac
