#pragma once

#include <functional>
#include <optional>
#include <string>

#include <SQLiteCpp/Database.h>
#include <SQLiteCpp/Exception.h>

#include "file_content.hpp"
#include "page_watch.hpp"
#include "process_lock.hpp"
#include "row_access.hpp"
#include "storage_error.hpp"

namespace sac {

/// The open file of a session database, locked against other writers. Turns the errors of SQLite,
/// and rows that hold what they cannot hold, into DataError that names the file.
class SessionConnection {
 public:
  /// Opens the file, or makes it with the session's tables and what `fill` writes into them. Throws
  /// DataError.
  SessionConnection(const std::string& path, const std::function<void(SQLite::Database&)>& fill);

  const std::string& path() const { return path_; }
  const SQLite::Database& database() const { return database_; }

  /// Runs `action` and returns its result. `failure` tells in errors what did not happen.
  template <typename Action>
  auto read(const std::string& failure, Action action) const {
    requireFilesBeside(failure);
    try {
      return action();
    } catch (const SQLite::Exception& error) {
      fail(failure, error);
    } catch (const RowDefect& defect) {
      throwDamaged(path_, defect.what());
    }
  }

  /// Runs `action` in one transaction, which is on the disk when this returns, in the file that
  /// stands at path() and in which nobody else has changed a byte. When it throws, nothing is
  /// stored. An action that does nothing asks whether all that was stored is there.
  void write(const std::string& failure, const std::function<void(SQLite::Database&)>& action);

 private:
  [[noreturn]] void fail(const std::string& failure, const SQLite::Exception& error) const;
  /// Refuses what SQLite would open beside the file and wait for.
  void requireFilesBeside(const std::string& failure) const;
  /// Refuses what would be stored where it cannot be read back.
  void requireInPlace(const std::string& failure) const;
  void requireContent(const std::string& failure) const;
  /// What stands in the file now.
  FileContent content() const { return {lock_.descriptor(), page_}; }

  std::string path_;
  ProcessLock lock_;
  PageWatch watch_;
  SQLite::Database database_;
  std::size_t page_ = 0;                ///< size of one [byte]
  std::optional<FileContent> content_;  ///< that SQLite left behind, once it is opened
  bool is_lost_ = false;                ///< a transaction may be where nobody reads it
};

}  // namespace sac
