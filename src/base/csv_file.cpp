#include "spherical_actuator_calibration/base/csv_file.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <sstream>
#include <string>

#include "spherical_actuator_calibration/base/error.hpp"
#include "spherical_actuator_calibration/base/input_file.hpp"
#include "spherical_actuator_calibration/base/number_text.hpp"
#include "spherical_actuator_calibration/base/printable_text.hpp"

namespace sac {
namespace {

constexpr char kBlanks[] = " \t\r";
/// Of UTF-8: spreadsheets and tools of Windows write it before the first line.
constexpr char kByteOrderMark[] = "\xEF\xBB\xBF";

std::string trimmed(const std::string& text) {
  const std::size_t begin = text.find_first_not_of(kBlanks);
  return begin == std::string::npos
             ? ""
             : text.substr(begin, text.find_last_not_of(kBlanks) - begin + 1);
}

std::vector<std::string> cellsOf(const std::string& line) {
  std::vector<std::string> cells;
  std::size_t begin = 0;
  while (true) {
    const std::size_t comma = line.find(',', begin);
    cells.push_back(trimmed(line.substr(begin, comma - begin)));
    if (comma == std::string::npos) {
      return cells;
    }
    begin = comma + 1;
  }
}

/// Names of columns: every cell begins like a word, and none is a number ("nan").
bool isHeading(const std::vector<std::string>& cells) {
  return std::none_of(cells.begin(), cells.end(), [](const std::string& cell) {
    constexpr char kNoWord[] = "0123456789+-.,;";
    return cell.empty() || std::string(kNoWord).find(cell.front()) != std::string::npos ||
           parsedNumber(cell).has_value();
  });
}

CsvRow readRow(const std::string& place, const std::vector<std::string>& cells) {
  CsvRow row;
  row.place = place;
  for (const std::string& cell : cells) {
    const std::optional<double> number = parsedNumber(cell);
    if (!number || !std::isfinite(*number)) {
      row.fail("\"" + excerpt(cell) +
               "\" is not a finite number; numbers are separated by commas.");
    }
    row.values.push_back(*number);
  }
  return row;
}

}  // namespace

void CsvRow::requireColumns(std::size_t columns) const {
  if (values.size() != columns) {
    fail(std::to_string(values.size()) + " numbers; " + std::to_string(columns) + " are needed.");
  }
}

void CsvRow::fail(const std::string& sentence) const {
  throw ConfigError(place + ": " + sentence);
}

CsvFile loadCsv(const std::string& path, std::size_t most_rows) {
  std::istringstream text(readInputFile(path));
  if (text.str().rfind(kByteOrderMark, 0) == 0) {
    text.ignore(std::char_traits<char>::length(kByteOrderMark));
  }
  CsvFile file;
  bool may_be_heading = true;
  std::string line;
  for (std::size_t number = 1; std::getline(text, line); ++number) {
    line = trimmed(line);
    if (line.empty() || line.front() == '#') {
      continue;
    }
    const std::vector<std::string> cells = cellsOf(line);
    if (may_be_heading && isHeading(cells)) {
      file.has_heading = true;
    } else {
      file.rows.push_back(readRow(path + ":" + std::to_string(number), cells));
    }
    may_be_heading = false;
    if (file.rows.size() > most_rows) {
      file.rows.back().fail("more than " + std::to_string(most_rows) + " lines of numbers.");
    }
  }
  if (file.rows.empty()) {
    throw ConfigError(path + ": there is no line of numbers.");
  }
  return file;
}

}  // namespace sac
