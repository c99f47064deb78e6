#include "mapped_file.hpp"

#include <algorithm>
#include <cstdlib>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

#include <sys/mman.h>
#include <sys/resource.h>

#include <fcntl.h>
#include <unistd.h>

namespace sac {
namespace {

/// Descriptor of a file that goes with it; −1: there can be none.
int openNameless() {
  // Not /tmp: what lies there may lie in memory.
  const char* wanted = std::getenv("TMPDIR");
  std::string path = wanted != nullptr && *wanted != '\0' ? wanted : "/var/tmp";
  path += "/sac_streams_XXXXXX";
  const int descriptor = ::mkostemp(path.data(), O_CLOEXEC);
  if (descriptor < 0) {
    return descriptor;
  }
  ::unlink(path.c_str());
  // Others need descriptors, too: to read what is measured, and to save what is found.
  constexpr rlim_t kShare = 4;
  rlimit limit{};
  const bool is_scarce = ::getrlimit(RLIMIT_NOFILE, &limit) == 0 &&
                         static_cast<rlim_t>(descriptor) >= limit.rlim_cur / kShare;
  if (is_scarce) {
    ::close(descriptor);
    return -1;
  }
  return descriptor;
}

/// Whether a file may have so many bytes: one that has more than that would end the process.
bool isAllowed(std::size_t bytes) {
  rlimit limit{};
  return ::getrlimit(RLIMIT_FSIZE, &limit) != 0 || limit.rlim_cur == RLIM_INFINITY ||
         bytes <= limit.rlim_cur;
}

}  // namespace

/// The files of this process, and how much of them is in its memory.
class ResidentPages {
 public:
  static ResidentPages& ofProcess() {
    static ResidentPages pages;
    return pages;
  }

  std::mutex& mutex() { return mutex_; }
  // The mutex is held.
  void add(MappedFile& file) { files_.push_back(&file); }
  void remove(const MappedFile& file) {
    files_.erase(std::remove(files_.begin(), files_.end(), &file), files_.end());
  }
  /// One more piece is in memory.
  void count() {
    constexpr std::size_t kMost = (std::size_t{8} << 20U) / MappedFile::kPiece;
    if (++pieces_ < kMost) {
      return;
    }
    pieces_ = 0;
    for (MappedFile* file : files_) {
      file->rest();
    }
  }

 private:
  std::mutex mutex_;
  std::vector<MappedFile*> files_;
  std::size_t pieces_ = 0;
};

std::unique_ptr<MappedFile> MappedFile::make(std::size_t bytes) {
  std::unique_ptr<MappedFile> file(new MappedFile(openNameless()));
  return file->grow(bytes) ? std::move(file) : nullptr;
}

MappedFile::MappedFile(int descriptor) : descriptor_(descriptor) {
  const std::lock_guard<std::mutex> lock(ResidentPages::ofProcess().mutex());
  ResidentPages::ofProcess().add(*this);
}

MappedFile::~MappedFile() {
  const std::lock_guard<std::mutex> lock(ResidentPages::ofProcess().mutex());
  ResidentPages::ofProcess().remove(*this);
  if (data_ != nullptr) {
    ::munmap(data_, bytes_);
  }
  if (descriptor_ >= 0) {
    ::close(descriptor_);
  }
}

bool MappedFile::grow(std::size_t bytes) {
  if (descriptor_ < 0 || !isAllowed(bytes) ||
      ::posix_fallocate(descriptor_, 0, static_cast<off_t>(bytes)) != 0) {
    return false;
  }
  const std::lock_guard<std::mutex> lock(ResidentPages::ofProcess().mutex());
  auto touched = std::make_unique<std::atomic<bool>[]>(piecesOf(bytes));
  void* moved = data_ == nullptr
                    ? ::mmap(nullptr, bytes, PROT_READ | PROT_WRITE, MAP_SHARED, descriptor_, 0)
                    : ::mremap(data_, bytes_, bytes, MREMAP_MAYMOVE);
  if (moved == MAP_FAILED) {
    return false;
  }
  data_ = static_cast<char*>(moved);
  bytes_ = bytes;
  touched_ = std::move(touched);
  return true;
}

void MappedFile::touch(std::size_t piece) {
  const std::lock_guard<std::mutex> lock(ResidentPages::ofProcess().mutex());
  if (!touched_[piece].exchange(true)) {
    ResidentPages::ofProcess().count();
  }
}

/// All pages leave the process, and come back as they are used: others may use them meanwhile.
void MappedFile::rest() {
  if (data_ != nullptr) {
    ::madvise(data_, bytes_, MADV_DONTNEED);
    std::fill_n(touched_.get(), piecesOf(bytes_), false);
  }
}

}  // namespace sac
