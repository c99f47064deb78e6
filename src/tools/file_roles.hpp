#pragma once

#include <optional>
#include <string>
#include <vector>

namespace sac {

/// The files that a run reads and writes, with the options that name them. --force lets a file be
/// replaced; what the same run reads, or writes already, it must never be.
class FileRoles {
 public:
  /// `option` as people write it: "--actuator", or what stands for an operand in the help, "BAG".
  void read(const std::string& option, const std::string& path);
  void read(const std::string& option, const std::optional<std::string>& path);
  void read(const std::string& option, const std::vector<std::string>& paths);
  void write(const std::string& option, const std::string& path);
  void write(const std::string& option, const std::optional<std::string>& path);

  /// Throws ConfigError that names both options when one file has two roles, by whatever names:
  /// links are followed. An empty path is no file.
  void requireSeparate() const;

 private:
  struct Entry {
    std::string option;
    std::string path;
  };

  std::vector<Entry> read_;
  std::vector<Entry> written_;
};

}  // namespace sac
