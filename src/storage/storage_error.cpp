#include "storage_error.hpp"

#include "spherical_actuator_calibration/base/error.hpp"

#include <sqlite3.h>

namespace sac {
namespace {

constexpr char kDamaged[] =
    "the file is damaged; put a copy of it back, or move it away to start anew";

/// Why SQLite failed and what to do about it, in words.
std::string reason(const SQLite::Exception& error) {
  const std::string detail = std::string(" (") + error.what() + ")";
  constexpr int kPrimaryCode = 0xff;
  switch (error.getErrorCode() & kPrimaryCode) {
    case SQLITE_FULL:
      return "the disk is full; free some space and try again";
    case SQLITE_IOERR:
      // A disk that fills up while SQLite makes its auxiliary files shows as this, too.
      return "the disk reported an error" + detail + "; free some space or check the disk";
    case SQLITE_READONLY:
    case SQLITE_CANTOPEN:
    case SQLITE_PERM:
    case SQLITE_AUTH:
      return "the file or its folder cannot be written" + detail +
             "; check that the folder exists, its permissions, and whether the disk is mounted "
             "read-only";
    case SQLITE_BUSY:
    case SQLITE_LOCKED:
      return "another program reads or writes the file; close that program and try again";
    case SQLITE_CORRUPT:
    case SQLITE_NOTADB:
      return kDamaged;
    case SQLITE_CONSTRAINT:
      return "its values are incomplete or contradict what is stored" + detail;
    default:
      return std::string(error.what());
  }
}

}  // namespace

void throwStorageError(const std::string& path,
                       const std::string& failure,
                       const SQLite::Exception& error) {
  throw DataError(path + ": " + failure + ", because " + reason(error) + ".");
}

void throwDamaged(const std::string& path, const std::string& finding) {
  throw DataError(path + ": " + kDamaged + " (" + finding + ").");
}

}  // namespace sac
