#include "session_connection.hpp"

#include <filesystem>

#include <SQLiteCpp/Transaction.h>

#include "session_schema.hpp"
#include "spherical_actuator_calibration/base/folder_sync.hpp"

namespace sac {
namespace {

/// How long another program, such as the sqlite3 shell, may hold up a transaction.
constexpr int kBusyTimeoutMilliseconds = 2000;

constexpr char kOpenFailure[] = "the session database cannot be opened";

SQLite::Database openFile(const std::string& path) {
  try {
    return SQLite::Database(
        path, SQLite::OPEN_READWRITE | SQLite::OPEN_CREATE, kBusyTimeoutMilliseconds);
  } catch (const SQLite::Exception& error) {
    throwStorageError(path, kOpenFailure, error);
  }
}

}  // namespace

SessionConnection::SessionConnection(const std::string& path,
                                     const std::function<void(SQLite::Database&)>& fill)
    : path_(path), lock_(path), database_(openFile(path)) {
  const bool is_made = read(kOpenFailure, [this] { return hasSessionSchema(database_, path_); });
  read(kOpenFailure, [this] {
    database_.exec("PRAGMA foreign_keys = ON");
    // Every commit waits until its journal is on the disk; readers are never held up.
    database_.exec("PRAGMA journal_mode = WAL");
    database_.exec("PRAGMA synchronous = FULL");
  });
  if (!is_made) {
    write("the session database was not made", [&fill](SQLite::Database& database) {
      createSessionSchema(database);
      fill(database);
    });
  }
  // The name of the file; SQLite sees to those of its journals only. A process that ended early may
  // have left this undone.
  syncFolder(std::filesystem::absolute(path_).parent_path());
}

void SessionConnection::write(const std::string& failure,
                              const std::function<void(SQLite::Database&)>& action) {
  read(failure, [&] {
    SQLite::Transaction transaction(database_, SQLite::TransactionBehavior::IMMEDIATE);
    action(database_);
    transaction.commit();
  });
}

}  // namespace sac
