// Preloaded into a program, makes one of its file operations fail or kills it there:
//   ODOBENCH_FAULT=CALL:N:EFFECT   the N-th (from 1) CALL: open (for writing), write, close, rename, mkdir,
//   ftruncate;
//                                  EFFECT: a number of errno, "short" (half of the bytes, then ENOSPC) or
//                                  "kill"
//   ODOBENCH_FAULT_MARK=FILE       made when it happens
// Descriptors 0 to 2 are left alone.
#include <dlfcn.h>
#include <fcntl.h>
#include <sys/stat.h>
#include <sys/types.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <csignal>
#include <cstdarg>
#include <cstdio>
#include <cstdlib>
#include <cstring>

namespace {

template <class Function>
Function* real(const char* name) {
  return reinterpret_cast<Function*>(dlsym(RTLD_NEXT, name));
}

struct Fault {
  char call[16] = "";
  long at = 0;
  int error = 0;
  bool shortened = false, kill = false;

  Fault() {
    const char* text = std::getenv("ODOBENCH_FAULT");
    char effect[16] = "";
    if (text == nullptr || std::sscanf(text, "%15[a-z]:%ld:%15s", call, &at, effect) != 3) return;
    shortened = std::strcmp(effect, "short") == 0;
    kill = std::strcmp(effect, "kill") == 0;
    error = shortened ? ENOSPC : std::atoi(effect);
  }
};

std::atomic<long> calls{0};
std::atomic<bool> full{false};  // after a short write

// True when this call is the one.
bool hit(const char* call) {
  static const Fault fault;
  if (std::strcmp(call, fault.call) != 0) return false;
  if (full.load()) {
    errno = ENOSPC;
    return true;
  }
  if (++calls != fault.at) return false;
  if (const char* mark = std::getenv("ODOBENCH_FAULT_MARK")) {
    const int fd = real<int(const char*, int, ...)>("open")(mark, O_CREAT | O_WRONLY, 0600);
    if (fd >= 0) real<int(int)>("close")(fd);
  }
  if (fault.kill) raise(SIGKILL);
  if (fault.shortened) full.store(true);
  errno = fault.error;
  return true;
}

bool shortens() {
  static const Fault fault;
  return fault.shortened;
}

}  // namespace

extern "C" {

int open(const char* path, int flags, ...) {
  va_list list;
  va_start(list, flags);
  const auto mode = static_cast<mode_t>((flags & O_CREAT) != 0 ? va_arg(list, int) : 0);
  va_end(list);
  if ((flags & O_CREAT) != 0 && hit("open")) return -1;
  return real<int(const char*, int, ...)>("open")(path, flags, mode);
}

ssize_t write(int fd, const void* bytes, size_t size) {
  const auto next = real<ssize_t(int, const void*, size_t)>("write");
  if (fd > 2) {
    const bool before = full.load();
    if (hit("write")) return shortens() && !before && size > 1 ? next(fd, bytes, size / 2) : -1;
  }
  return next(fd, bytes, size);
}

int close(int fd) {
  const auto next = real<int(int)>("close");
  struct stat status {};
  const bool written = fd > 2 && (fcntl(fd, F_GETFL) & O_ACCMODE) == O_WRONLY && fstat(fd, &status) == 0 &&
                       S_ISREG(status.st_mode);
  if (written && hit("close")) {
    const int error = errno;
    next(fd);
    errno = error;
    return -1;
  }
  return next(fd);
}

int rename(const char* from, const char* to) {
  return hit("rename") ? -1 : real<int(const char*, const char*)>("rename")(from, to);
}

int renameat2(int from_folder, const char* from, int to_folder, const char* to, unsigned flags) {
  if (hit("rename")) return -1;
  return real<int(int, const char*, int, const char*, unsigned)>("renameat2")(from_folder, from, to_folder,
                                                                              to, flags);
}

int mkdir(const char* path, mode_t mode) {
  return hit("mkdir") ? -1 : real<int(const char*, mode_t)>("mkdir")(path, mode);
}

int ftruncate(int fd, off_t length) noexcept {
  return hit("ftruncate") ? -1 : real<int(int, off_t)>("ftruncate")(fd, length);
}

}  // extern "C"
