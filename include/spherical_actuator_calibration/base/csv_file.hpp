#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace sac {

/// One line of numbers.
struct CsvRow {
  std::string place;  ///< "file.csv:12"
  std::vector<double> values;

  /// Throws ConfigError that names the line unless it has so many numbers.
  void requireColumns(std::size_t columns) const;
  /// Throws ConfigError: the place, then the sentence.
  [[noreturn]] void fail(const std::string& sentence) const;
};

/// Numbers in lines, separated by commas.
struct CsvFile {
  std::vector<CsvRow> rows;
  bool has_heading = false;  ///< names of columns before them
};

/// Reads a file of numbers. Empty lines and lines that begin with # are left out, and a first line
/// of words (names of columns). Throws ConfigError that names file and line for what is no finite
/// number, for a file without numbers, and for more than `most_rows` lines of them.
CsvFile loadCsv(const std::string& path, std::size_t most_rows);

}  // namespace sac
