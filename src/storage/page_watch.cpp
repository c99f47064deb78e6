#include "page_watch.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <string_view>

#include <sqlite3.h>

namespace sac {

/// SQLite's own methods of the file, two of them replaced; the file refers to them.
struct PageWatch::Methods : sqlite3_io_methods {
  const sqlite3_io_methods* original = nullptr;
  std::optional<FileContent>* content = nullptr;

  static const Methods& of(const sqlite3_file* file) {
    return *static_cast<const Methods*>(file->pMethods);
  }

  static int read(sqlite3_file* file, void* bytes, int size, sqlite3_int64 place) {
    const Methods& self = of(file);
    const int result = self.original->xRead(file, bytes, size, place);
    const std::string_view page(static_cast<const char*>(bytes), static_cast<std::size_t>(size));
    const bool is_read = result == SQLITE_OK || result == SQLITE_IOERR_SHORT_READ;
    const bool is_other =
        *self.content && !(*self.content)->mayHold(static_cast<std::uint64_t>(place), page);
    return is_read && is_other ? SQLITE_CORRUPT : result;
  }

  static int write(sqlite3_file* file, const void* bytes, int size, sqlite3_int64 place) {
    const Methods& self = of(file);
    const int result = self.original->xWrite(file, bytes, size, place);
    if (result == SQLITE_OK && *self.content) {
      (*self.content)
          ->put(static_cast<std::uint64_t>(place),
                {static_cast<const char*>(bytes), static_cast<std::size_t>(size)});
    }
    return result;
  }
};

PageWatch::PageWatch() : methods_(std::make_unique<Methods>()) {}

PageWatch::~PageWatch() = default;

void PageWatch::attach(const SQLite::Database& database) {
  sqlite3_file* file = nullptr;
  sqlite3_file_control(database.getHandle(), "main", SQLITE_FCNTL_FILE_POINTER, &file);
  methods_->original = file->pMethods;
  methods_->content = &content_;
  static_cast<sqlite3_io_methods&>(*methods_) = *file->pMethods;
  methods_->xRead = &Methods::read;
  methods_->xWrite = &Methods::write;
  // Without the mapping of the file into memory, which is read behind our back.
  constexpr int kWithoutMapping = 2;
  methods_->iVersion = std::min(methods_->iVersion, kWithoutMapping);
  file->pMethods = methods_.get();
}

void PageWatch::expect(const FileContent& content) {
  content_ = content;
}

const FileContent& PageWatch::expected() const {
  return *content_;
}

}  // namespace sac
