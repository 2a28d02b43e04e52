// POSIX calls rather than streams, because only they tell a full disk from success and can flush to it. The temporary
// file lies in the same folder, so that the rename is within one file system. Links are followed first: a rename would
// replace the link itself.
#include "io/output_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>

namespace curvetet {

OutputFile::OutputFile(const std::string& path) : path_(path) {
  std::error_code ignored;
  if (std::filesystem::is_symlink(path_, ignored)) {
    const auto target = std::filesystem::weakly_canonical(path_, ignored);
    if (!ignored) path_ = target.string();
  }
  struct stat status {};
  if (::stat(path_.c_str(), &status) == 0 && !S_ISREG(status.st_mode)) {
    descriptor_ = ::open(path_.c_str(), O_WRONLY | O_CLOEXEC);
    if (descriptor_ < 0) fail("opened");
  } else {
    open_beside();
  }
  buffer_.reserve(kBufferSize + 4096);
}

OutputFile::~OutputFile() { discard(); }

void OutputFile::open_beside() {
  const std::filesystem::path folder = std::filesystem::path(path_).parent_path();
  for (int attempt = 0; attempt < 100; ++attempt) {
    temporary_ = (folder / fmt::format(".curvetet-{}-{}.tmp", ::getpid(), attempt)).string();
    descriptor_ = ::open(temporary_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    if (descriptor_ >= 0) return;
    if (errno != EEXIST) break;
  }
  temporary_.clear();
  fail("created");
}

void OutputFile::fail(const char* doing) {
  if (failure_.empty()) failure_ = fmt::format("{} cannot be {}: {}", path_, doing, std::strerror(errno));
}

void OutputFile::flush() {
  const char* begin = buffer_.data();
  std::size_t left = failure_.empty() ? buffer_.size() : 0;
  while (left > 0) {
    const ssize_t written = ::write(descriptor_, begin, left);
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) {
      fail("written");
      break;
    }
    begin += written;
    left -= static_cast<std::size_t>(written);
  }
  buffer_.clear();
}

void OutputFile::discard() {
  if (descriptor_ >= 0) ::close(descriptor_);
  descriptor_ = -1;
  if (!temporary_.empty()) ::unlink(temporary_.c_str());
  temporary_.clear();
}

Status OutputFile::commit() {
  flush();
  if (failure_.empty() && !temporary_.empty() && ::fsync(descriptor_) != 0) fail("flushed to the disk");
  if (failure_.empty()) {
    if (::close(descriptor_) != 0) fail("closed");
    descriptor_ = -1;
  }
  if (failure_.empty() && !temporary_.empty()) {
    if (std::rename(temporary_.c_str(), path_.c_str()) == 0) {
      temporary_.clear();
    } else {
      fail("put in place");
    }
  }
  if (failure_.empty()) return Done{};
  discard();
  return Error{ErrorCode::output_unwritable, failure_, {}, {}, "check the folder, its permissions and the free space"};
}

}  // namespace curvetet
