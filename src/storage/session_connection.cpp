#include "session_connection.hpp"

#include <filesystem>
#include <utility>

#include <SQLiteCpp/Transaction.h>

#include "busy_timeout.hpp"
#include "files_beside.hpp"
#include "row_access.hpp"
#include "session_schema.hpp"
#include "spherical_actuator_calibration/base/error.hpp"
#include "spherical_actuator_calibration/base/folder_sync.hpp"

#include <sqlite3.h>

namespace sac {
namespace {

constexpr char kOpenFailure[] = "the session database cannot be opened";

SQLite::Database openFile(const std::string& path) {
  try {
    return SQLite::Database(
        path, SQLite::OPEN_READWRITE | SQLite::OPEN_CREATE, kBusyTimeoutMilliseconds);
  } catch (const SQLite::Exception& error) {
    throwStorageError(path, kOpenFailure, error);
  }
}

constexpr char kLost[] =
    ", because the file was removed or replaced, or another program changed or shortened it, or "
    "its folder was replaced, or another disk is mounted there. Until it is stopped, the node "
    "holds its session: list_samples shows the samples, and save writes the parameters while the "
    "folder is there. Then stop the node, put the folder back as it was, or a copy of it, and "
    "start the node again.";

// SQLite goes on writing to files that have lost their names, or that another disk hides, and takes
// any content that is a database for its own.
[[noreturn]] void throwLost(const std::string& path, const std::string& failure) {
  throw DataError(path + ": " + failure + kLost);
}

[[noreturn]] void throwReplaced(const std::string& path, const std::string& failure) {
  throw DataError(
      path + ": " + failure +
      ", because the file was removed, replaced or changed at this moment; put it back as it "
      "was, and start the node again.");
}

/// Undoes before what a transaction that was killed left half written.
std::size_t pageSize(const SQLite::Database& database) {
  RowReader(database, "PRAGMA user_version").next();
  RowReader size(database, "PRAGMA page_size");
  size.next();
  return size.count();
}

/// A journal that is void between two transactions, and no shared memory: what others do to a log
/// beside the file would take back what was acknowledged, and a shorter memory end the process.
void setJournal(SQLite::Database& database, const std::string& path) {
  RowReader mode(database, "PRAGMA journal_mode = TRUNCATE");
  if (!mode.next() || mode.text() != "truncate") {
    throw DataError(path + ": " + kOpenFailure +
                    ", because its journal cannot be made another; close other programs that work "
                    "with the file, and try again.");
  }
  // Every commit waits until it is on the disk, and with it that its journal is void.
  database.exec("PRAGMA synchronous = FULL");
}

}  // namespace

SessionConnection::SessionConnection(const std::string& path,
                                     const std::function<void(SQLite::Database&)>& fill)
    : path_(path), lock_(path), database_(openFile(path)) {
  watch_.attach(database_);
  page_ = read(kOpenFailure, [this] { return pageSize(database_); });
  watch_.expect(content());
  sqlite3_db_release_memory(database_.getHandle());  // what was read before that
  const bool is_made = read(kOpenFailure, [this] { return hasSessionSchema(database_, path_); });
  read(kOpenFailure, [this] { setJournal(database_, path_); });
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
  FileContent now = content();
  if (!(identityOf(path_) == lock_.file()) || !(now == watch_.expected())) {
    throwReplaced(path_, kOpenFailure);
  }
  content_ = std::move(now);
  // The name of the file; SQLite sees to that of its journal only. A process that ended early may
  // have left this undone.
  syncFolder(std::filesystem::absolute(path_).parent_path());
}

void SessionConnection::write(const std::string& failure,
                              const std::function<void(SQLite::Database&)>& action) {
  requireInPlace(failure);
  if (content_) {
    watch_.expect(*content_);  // not what a transaction that failed would have made of it
  }
  read(failure, [&] {
    SQLite::Transaction transaction(database_, SQLite::TransactionBehavior::IMMEDIATE);
    // Not before: SQLite has now undone what a transaction that failed left half written.
    requireContent(failure);
    action(database_);
    requireInPlace(failure);
    transaction.commit();
  });
  if (!content_) {  // it is being opened
    return;
  }
  // Changed at this very moment: nobody knows whether it will be read back. Nothing more is stored
  // until the node starts again and reads what is there, so that a repetition is not stored twice.
  // One look decides: a second one could see a folder that went only then, refuse, and forget it.
  FileContent after = content();
  is_lost_ = !(identityOf(path_) == lock_.file()) || !(after == watch_.expected());
  if (is_lost_) {
    throwLost(path_, failure);
  }
  content_ = std::move(after);
}

void SessionConnection::requireFilesBeside(const std::string& failure) const {
  // Links are followed to where SQLite has its journal.
  sac::requireFilesBeside(path_, sqlite3_db_filename(database_.getHandle(), "main"), failure);
}

void SessionConnection::requireInPlace(const std::string& failure) const {
  if (is_lost_ || (content_ && !(identityOf(path_) == lock_.file()))) {
    throwLost(path_, failure);
  }
}

void SessionConnection::requireContent(const std::string& failure) const {
  if (content_ && !(content() == *content_)) {
    throwLost(path_, failure);
  }
}

void SessionConnection::fail(const std::string& failure, const SQLite::Exception& error) const {
  constexpr int kPrimaryCode = 0xff;
  const int code = error.getErrorCode() & kPrimaryCode;
  // As SQLite tells a content that is not its own. After other errors a journal may have to be
  // undone first.
  if (code == SQLITE_CORRUPT && content_) {  // it was whole, and may be so again by now
    throwLost(path_, failure);
  }
  if (code == SQLITE_ERROR || code == SQLITE_NOTADB) {
    requireContent(failure);
  }
  throwStorageError(path_, failure, error);
}

}  // namespace sac
