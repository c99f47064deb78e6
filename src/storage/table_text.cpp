#include "table_text.hpp"

#include <algorithm>
#include <cctype>

#include "row_access.hpp"
#include "spherical_actuator_calibration/base/printable_text.hpp"

namespace sac {
namespace {

/// Collects what stands between commas, with one space where there is any.
class Parts {
 public:
  void add(char sign) {
    if (std::isspace(static_cast<unsigned char>(sign)) == 0) {
      part_ += has_space_ && !part_.empty() ? std::string{' ', sign} : std::string{sign};
      has_space_ = false;
    } else {
      has_space_ = true;
    }
  }
  void end() {
    if (!part_.empty()) {
      parts_.insert(part_);
    }
    part_.clear();
    has_space_ = false;
  }
  const std::set<std::string>& all() const { return parts_; }

 private:
  std::string part_;
  bool has_space_ = false;
  std::set<std::string> parts_;
};

// Quotes and comments need no care: every sign is in some part, so that a text of which all parts
// are known holds nothing else.
std::set<std::string> partsOf(const std::string& sql) {
  Parts parts;
  int depth = 0;
  for (const char sign : sql) {
    depth -= sign == ')' ? 1 : 0;
    const bool is_border =
        (sign == ',' && depth == 1) || (sign == '(' && depth == 0) || (sign == ')' && depth == 0);
    depth += sign == '(' ? 1 : 0;
    if (is_border) {
      parts.end();
    } else {
      parts.add(sign);
    }
  }
  parts.end();
  return parts.all();
}

}  // namespace

TableTexts tableTexts(const SQLite::Database& database) {
  TableTexts result;
  RowReader row(database, "SELECT name, sql FROM sqlite_schema WHERE type = 'table'");
  while (row.next()) {
    const std::string name = row.text();
    result[name] = partsOf(row.text());
  }
  return result;
}

std::string foreignObject(const SQLite::Database& database, const TableTexts& own) {
  RowReader row(database, "SELECT type, name, coalesce(sql, '') FROM sqlite_schema");
  while (row.next()) {
    const std::string type = row.text();
    const std::string name = row.text();
    const std::string sql = row.text();
    if (type == "index" && sql.empty()) {
      continue;  // SQLite makes it for a constraint of a table
    }
    const auto table = own.find(name);
    const std::set<std::string> parts = partsOf(sql);
    if (type != "table" || table == own.end() ||
        !std::includes(table->second.begin(), table->second.end(), parts.begin(), parts.end())) {
      return "the " + printable(type) + " \"" + printable(name) + "\"";
    }
  }
  return "";
}

}  // namespace sac
