#include "session_connection.hpp"

#include <filesystem>

#include <SQLiteCpp/Transaction.h>

#include "session_schema.hpp"
#include "spherical_actuator_calibration/base/error.hpp"
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

// SQLite goes on writing to files that have lost their names, or that another disk hides.
[[noreturn]] void throwMoved(const std::string& path, const std::string& failure) {
  throw DataError(path + ": " + failure +
                  ", because the file was removed or replaced, or its folder was, or another disk "
                  "is mounted there; stop the node, put the folder back as it was, and start the "
                  "node again.");
}

}  // namespace

SessionConnection::SessionConnection(const std::string& path,
                                     const std::function<void(SQLite::Database&)>& fill)
    : path_(path), lock_(path), database_(openFile(path)) {
  const bool is_made = read(kOpenFailure, [this] { return hasSessionSchema(database_, path_); });
  read(kOpenFailure, [this] {
    // Every commit waits until its journal is on the disk; readers are never held up.
    database_.exec("PRAGMA journal_mode = WAL");
    database_.exec("PRAGMA synchronous = FULL");
  });
  if (is_made && isEarlierSchema(database_)) {
    write("the session database was not brought to the present format", upgradeSessionSchema);
  } else if (!is_made) {
    write("the session database was not made", [&fill](SQLite::Database& database) {
      createSessionSchema(database);
      fill(database);
    });
  }
  // Not before: a table that others refer to is made anew without it.
  read(kOpenFailure, [this] { database_.exec("PRAGMA foreign_keys = ON"); });
  files_ = filesInPlace();
  if (!(files_->front() == lock_.file())) {
    throwMoved(path_, kOpenFailure);
  }
  // The name of the file; SQLite sees to those of its journals only. A process that ended early may
  // have left this undone.
  syncFolder(std::filesystem::absolute(path_).parent_path());
}

void SessionConnection::write(const std::string& failure,
                              const std::function<void(SQLite::Database&)>& action) {
  requireInPlace(failure);
  read(failure, [&] {
    SQLite::Transaction transaction(database_, SQLite::TransactionBehavior::IMMEDIATE);
    action(database_);
    requireInPlace(failure);
    transaction.commit();
  });
  // Moved at this very moment: nobody knows whether it will be read back. Nothing more is stored
  // until the node starts again and reads what is there, so that a repetition is not stored twice.
  // One look decides: a second one could see a folder that went only then, refuse, and forget it.
  is_lost_ = files_ && !(filesInPlace() == *files_);
  if (is_lost_) {
    throwMoved(path_, failure);
  }
}

std::array<FileIdentity, 3> SessionConnection::filesInPlace() const {
  return {identityOf(path_), identityOf(path_ + "-wal"), identityOf(path_ + "-shm")};
}

void SessionConnection::requireInPlace(const std::string& failure) const {
  if (is_lost_ || (files_ && !(filesInPlace() == *files_))) {
    throwMoved(path_, failure);
  }
}

}  // namespace sac
