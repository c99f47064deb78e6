#include "yaml_document.hpp"

#include <algorithm>
#include <cstddef>
#include <map>
#include <sstream>
#include <string_view>
#include <vector>

#include <yaml-cpp/eventhandler.h>

#include "spherical_actuator_calibration/base/printable_text.hpp"

namespace sac {
namespace {

constexpr std::size_t kMostKeys = 100'000;
constexpr std::size_t kMostOpen = 1000;
constexpr std::size_t kMostSigns = 2 * kMostYamlNodes;

/// Listens to the parser and counts, so that nothing is built of a text that is refused.
class Census : public YAML::EventHandler {
 public:
  void OnDocumentStart(const YAML::Mark& mark) override {
    ++documents_;
    // Of a stray sign such as "," yaml-cpp makes empty documents without end and never goes on.
    if (documents_ > 1 && mark.pos == begin_) {
      throw YamlDefect(mark.line + 1, "this is not valid YAML: a sign stands where none can.");
    }
    begin_ = mark.pos;
  }
  void OnDocumentEnd() override {}

  void OnNull(const YAML::Mark& mark, YAML::anchor_t /*anchor*/) override { count(mark, 1); }
  void OnScalar(const YAML::Mark& mark,
                const std::string& /*tag*/,
                YAML::anchor_t /*anchor*/,
                const std::string& /*value*/) override {
    count(mark, 1);
  }
  void OnAlias(const YAML::Mark& mark, YAML::anchor_t anchor) override {
    const bool is_open = std::any_of(open_.begin(), open_.end(), [anchor](const Collection& outer) {
      return outer.anchor == anchor;
    });
    if (is_open) {
      throw YamlDefect(mark.line + 1, "an alias stands within what it is an alias of.");
    }
    const auto size = sizes_.find(anchor);
    count(mark, size == sizes_.end() ? 1 : size->second);
  }

  void OnSequenceStart(const YAML::Mark& mark,
                       const std::string& /*tag*/,
                       YAML::anchor_t anchor,
                       YAML::EmitterStyle::value /*style*/) override {
    begin(mark, anchor, false);
  }
  void OnSequenceEnd() override { end(); }
  void OnMapStart(const YAML::Mark& mark,
                  const std::string& /*tag*/,
                  YAML::anchor_t anchor,
                  YAML::EmitterStyle::value /*style*/) override {
    begin(mark, anchor, true);
  }
  void OnMapEnd() override { end(); }

 private:
  /// A map or list that has begun and not ended.
  struct Collection {
    YAML::anchor_t anchor;
    std::size_t nodes_before;
    bool is_map;
    bool awaits_key = true;
  };

  void begin(const YAML::Mark& mark, YAML::anchor_t anchor, bool is_map) {
    countKey(mark);
    open_.push_back({anchor, nodes_, is_map});
    if (open_.size() > kDeepestYaml) {
      throw YamlDefect(mark.line + 1,
                       "maps and lists stand more than " + std::to_string(kDeepestYaml) +
                           " deep within each other.");
    }
    countNodes(mark, 1);
  }

  void end() {
    sizes_[open_.back().anchor] = nodes_ - open_.back().nodes_before;
    open_.pop_back();
  }

  void count(const YAML::Mark& mark, std::size_t nodes) {
    countKey(mark);
    countNodes(mark, nodes);
  }

  /// Keys and values of a map take turns.
  void countKey(const YAML::Mark& mark) {
    if (open_.empty() || !open_.back().is_map) {
      return;
    }
    keys_ += open_.back().awaits_key ? 1 : 0;
    open_.back().awaits_key = !open_.back().awaits_key;
    if (keys_ > kMostKeys) {
      throw YamlDefect(mark.line + 1,
                       "more than " + std::to_string(kMostKeys) + " keys are not read.");
    }
  }

  void countNodes(const YAML::Mark& mark, std::size_t nodes) {
    if (documents_ > 1) {
      throw YamlDefect(mark.line + 1, "only one YAML document is allowed in a file.");
    }
    nodes_ += nodes;
    if (nodes_ > kMostYamlNodes) {
      throw YamlDefect(mark.line + 1,
                       "more than " + std::to_string(kMostYamlNodes) +
                           " values, those of aliases included, are not read.");
    }
  }

  std::size_t documents_ = 0;
  int begin_ = 0;  ///< where the last document began
  std::size_t nodes_ = 0;
  std::size_t keys_ = 0;  ///< of all maps
  std::vector<Collection> open_;
  std::map<YAML::anchor_t, std::size_t> sizes_;  ///< of collections that have ended, in nodes
};

// yaml-cpp holds all that stands in brackets, 250 bytes for a sign, before it tells any of it. What
// is quoted or a comment counts, too: how much of that there is changes nothing by much.
void refuseWhatIsHeld(const std::string& text) {
  int line = 1;
  std::size_t open = 0;
  std::size_t signs = 0;
  for (const char sign : text) {
    line += sign == '\n' ? 1 : 0;
    if (sign == '[' || sign == '{') {
      ++open;
    } else if ((sign == ']' || sign == '}') && open > 0) {
      --open;
    }
    signs += std::string_view("[]{},:?&*!\"'").find(sign) != std::string_view::npos ? 1 : 0;
    if (open > kMostOpen) {
      throw YamlDefect(line, "more than " + std::to_string(kMostOpen) + " brackets are open here.");
    }
    if (signs > kMostSigns) {
      throw YamlDefect(line,
                       "more than " + std::to_string(kMostSigns) +
                           " brackets, commas, colons and the like are not read.");
    }
  }
}

#ifdef YAML_CPP_BEFORE_0_7
/// yaml-cpp never gets past a colon before the end of a list in brackets, nor past one in brackets
/// that ends the text, and takes memory without end meanwhile.
void refuseOpenColons(const std::string& text) {
  std::istringstream lines(text);
  std::string line;
  std::ptrdiff_t open = 0;
  int last = 0;  // line that ends with a colon, where nothing but comments has come since
  for (int number = 1; std::getline(lines, line); ++number) {
    const std::string content = line.substr(0, line.find('#'));
    if (content.find(":]") != std::string::npos) {
      throw YamlDefect(number, "a colon stands before \"]\": write what follows it.");
    }
    open +=
        std::count_if(content.begin(), content.end(), [](char c) { return c == '[' || c == '{'; });
    open -=
        std::count_if(content.begin(), content.end(), [](char c) { return c == ']' || c == '}'; });
    const std::size_t end = content.find_last_not_of(" \t\r");
    if (end != std::string::npos) {
      last = content[end] == ':' ? number : 0;
    }
  }
  if (last > 0 && open > 0) {
    throw YamlDefect(last, "the text ends with a colon, and a bracket is open.");
  }
}
#endif

}  // namespace

YAML::Node parseSingleDocument(const std::string& text) {
  refuseWhatIsHeld(text);
#ifdef YAML_CPP_BEFORE_0_7
  refuseOpenColons(text);
#endif
  try {
    std::istringstream stream(text);
    YAML::Parser parser(stream);
    Census census;
    while (parser.HandleNextDocument(census)) {
    }
    return YAML::Load(text);
  } catch (const YAML::Exception& error) {
    throw YamlDefect(error.mark.line + 1, "this is not valid YAML: " + excerpt(error.msg) + ".");
  }
}

}  // namespace sac
