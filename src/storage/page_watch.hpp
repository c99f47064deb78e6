#pragma once

#include <memory>
#include <optional>

#include <SQLiteCpp/Database.h>

#include "file_content.hpp"

namespace sac {

/// Stands between SQLite and the file of a database: SQLite gets no page but as it stood in a known
/// content, or as it has written it itself since; and what it writes is known afterwards.
class PageWatch {
 public:
  /// Must live longer than the database is open. Until expect() everything passes.
  PageWatch();
  ~PageWatch();
  PageWatch(const PageWatch&) = delete;
  PageWatch& operator=(const PageWatch&) = delete;

  /// Attaches itself to a database that has been opened.
  void attach(const SQLite::Database& database);
  /// Sets what is in the file now.
  void expect(const FileContent& content);
  /// What is in the file, if nobody but SQLite has written to it since. After expect().
  const FileContent& expected() const;

 private:
  struct Methods;

  std::unique_ptr<Methods> methods_;
  std::optional<FileContent> content_;
};

}  // namespace sac
