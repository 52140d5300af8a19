#include "limcycle/reports/store/store_lock.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>

#include "limcycle/reports/store/store.hpp"

namespace limcycle {
namespace {

std::string lock_file(const std::string& path) { return path + "-lock"; }

/// A lock on a whole file, as an argument of fcntl. It belongs to the open file, not to the process, so that two stores
/// of one process exclude each other too, and closing another descriptor does not release it.
struct flock whole_file() {
  struct flock lock {};
  lock.l_type = F_WRLCK;
  lock.l_whence = SEEK_SET;
  return lock;
}

long written_pid(int descriptor) {
  char text[32] = {};
  if (pread(descriptor, text, sizeof text - 1, 0) <= 0) return -1;
  const long pid = std::strtol(text, nullptr, 10);
  return pid > 0 ? pid : -1;
}

/// True if the descriptor is still the file of that name; its last owner may have removed it before it was locked.
bool is_still(int descriptor, const std::string& file) {
  struct stat ours {
  }, named{};
  return fstat(descriptor, &ours) == 0 && stat(file.c_str(), &named) == 0 && ours.st_ino == named.st_ino &&
         ours.st_dev == named.st_dev;
}

StoreError cannot_lock(const std::string& path, int reason) {
  return {StoreError::Kind::refused, path + " cannot be written: " + std::strerror(reason)};
}

}  // namespace

StoreLock::StoreLock(const std::string& path) : file_(lock_file(path)) {
  for (;;) {
    descriptor_ = open(file_.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666);
    if (descriptor_ < 0) throw cannot_lock(path, errno);
    struct flock lock = whole_file();
    if (fcntl(descriptor_, F_OFD_SETLK, &lock) != 0) {
      const int reason = errno;
      const long pid = written_pid(descriptor_);
      close(descriptor_);
      if (reason != EAGAIN && reason != EACCES) throw cannot_lock(path, reason);
      throw StoreError(StoreError::Kind::refused,
                       path + " is being written by " +
                           (pid > 0 ? "process " + std::to_string(pid) : std::string("another process")) +
                           ": wait until it ends, or stop it; 'limcycle status' shows its progress");
    }
    if (is_still(descriptor_, file_)) break;
    close(descriptor_);
  }
  // Only for messages: a disk too full for it is detected soon enough.
  const std::string pid = std::to_string(getpid()) + "\n";
  if (ftruncate(descriptor_, 0) == 0 && pwrite(descriptor_, pid.data(), pid.size(), 0) < 0) errno = 0;
}

StoreLock::~StoreLock() {
  unlink(file_.c_str());  // while it is locked, so that no other process has it
  close(descriptor_);
}

long StoreLock::holder(const std::string& path) {
  const int descriptor = open(lock_file(path).c_str(), O_RDONLY | O_CLOEXEC);
  if (descriptor < 0) return 0;
  struct flock lock = whole_file();
  const bool held = fcntl(descriptor, F_OFD_GETLK, &lock) == 0 && lock.l_type != F_UNLCK;
  const long pid = held ? written_pid(descriptor) : 0;
  close(descriptor);
  return pid;
}

}  // namespace limcycle
