#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>

#include <SQLiteCpp/Column.h>
#include <SQLiteCpp/Database.h>
#include <SQLiteCpp/Statement.h>

#include "spherical_actuator_calibration/base/error.hpp"
#include "spherical_actuator_calibration/base/printable_text.hpp"

namespace sac {

/// A row holds what it cannot hold; what() has no full stop.
class RowDefect : public DataError {
 public:
  using DataError::DataError;
};

/// Writes rows: values go to the parameters of an SQL statement one after the other.
class RowWriter {
 public:
  RowWriter(const SQLite::Database& database, const char* sql) : statement_(database, sql) {}

  /// SQLite has no NaN: it becomes NULL.
  RowWriter& put(double value) { return bound(value); }
  RowWriter& put(std::int64_t value) { return bound(value); }
  RowWriter& put(std::uint32_t value) { return bound(value); }
  RowWriter& put(std::size_t value) { return bound(static_cast<std::int64_t>(value)); }
  RowWriter& put(bool value) { return bound(value ? 1 : 0); }
  RowWriter& put(const std::string& value) { return bound(value); }
  RowWriter& put(const char* value) { return bound(value); }
  template <typename Value>
  RowWriter& put(const std::optional<Value>& value) {
    return value ? put(*value) : skip();
  }
  RowWriter& putBytes(const std::string& bytes) {
    statement_.bind(next_++, bytes.data(), static_cast<int>(bytes.size()));
    return *this;
  }

  /// Runs the statement with the values put since the last time; returns the number of changed
  /// rows.
  int write() {
    const int changed = statement_.exec();
    statement_.reset();
    statement_.clearBindings();
    next_ = 1;
    return changed;
  }

 private:
  template <typename Value>
  RowWriter& bound(const Value& value) {
    statement_.bind(next_++, value);
    return *this;
  }
  RowWriter& skip() {
    ++next_;
    return *this;
  }

  SQLite::Statement statement_;
  int next_ = 1;
};

/// Reads rows: columns of a query one after the other.
class RowReader {
 public:
  RowReader(const SQLite::Database& database, const char* sql) : statement_(database, sql) {}
  /// With the value of the only parameter.
  RowReader(const SQLite::Database& database, const char* sql, std::int64_t parameter)
      : statement_(database, sql) {
    statement_.bind(1, parameter);
  }

  /// Value of a parameter, the first of which is 1. Before next().
  void bind(int parameter, std::int64_t value) { statement_.bind(parameter, value); }
  void bindBytes(int parameter, const std::string& bytes) {
    statement_.bind(parameter, bytes.data(), static_cast<int>(bytes.size()));
  }

  /// Goes to the next row; false when there is none.
  bool next() {
    column_ = 0;
    return statement_.executeStep();
  }

  /// Throws RowDefect when it is none: SQLite would read any word as 0.
  double number() {
    const SQLite::Column value = column();
    if (value.isText() || value.isBlob()) {
      throw RowDefect("\"" + excerpt(value.getString()) + "\" stands where a number is wanted");
    }
    return value.isNull() ? std::numeric_limits<double>::quiet_NaN() : value.getDouble();
  }
  std::int64_t integer() { return column().getInt64(); }
  /// Throws RowDefect when it is none, or too large.
  std::uint32_t count() {
    const std::int64_t value = integer();
    if (value < 0 || value > std::numeric_limits<std::uint32_t>::max()) {
      throw RowDefect(std::to_string(value) + " stands where a number of 32 bits is wanted");
    }
    return static_cast<std::uint32_t>(value);
  }
  bool flag() { return integer() != 0; }
  std::string text() { return column().getString(); }
  /// Bytes of a BLOB.
  std::string bytes() { return column().getString(); }

 private:
  SQLite::Column column() { return statement_.getColumn(column_++); }

  SQLite::Statement statement_;
  int column_ = 0;
};

}  // namespace sac
