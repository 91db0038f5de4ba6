#include "base/files.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <stdexcept>
#include <system_error>

namespace odobench {
namespace fs = std::filesystem;
namespace {

// Closes on every way out.
struct Descriptor {
  int fd = -1;
  explicit Descriptor(int f) : fd(f) {}
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  ~Descriptor() {
    if (fd >= 0) ::close(fd);
  }
  bool close() {
    const int f = fd;
    fd = -1;
    return ::close(f) == 0;
  }
};

[[noreturn]] void fail(const fs::path& file, const char* what, const std::error_code& reason) {
  throw DataError(fmt::format("{}: {}: {}", file.string(), what, reason.message()));
}
std::error_code last_error() {
  return {errno, std::generic_category()};
}

void write_all(int fd, std::string_view bytes, const fs::path& target) {
  while (!bytes.empty()) {
    const ssize_t n = ::write(fd, bytes.data(), bytes.size());
    if (n < 0 && errno == EINTR) continue;
    if (n < 0) fail(target, "cannot be written", last_error());
    bytes.remove_prefix(static_cast<std::size_t>(n));
  }
}

// Opens a file beside target that did not exist, and says which.
int open_temporary(const fs::path& target, fs::path& temporary) {
  for (int attempt = 0;; ++attempt) {
    temporary = target;
    temporary += fmt::format(".tmp-{}-{}", ::getpid(), attempt);
    const int fd = ::open(temporary.c_str(), O_CREAT | O_EXCL | O_WRONLY | O_CLOEXEC, 0666);
    if (fd >= 0) return fd;
    if (errno != EEXIST) fail(target, "cannot be written", last_error());
  }
}

}  // namespace

void require_replaceable(const fs::path& target) {
  std::error_code e;
  const fs::file_status status = fs::symlink_status(target, e);
  if (!fs::exists(status) || fs::is_regular_file(status)) return;
  if (fs::is_directory(status))
    fail(target, "cannot be written", std::make_error_code(std::errc::is_a_directory));
  const char* what = fs::is_symlink(status)          ? "a link"
                     : fs::is_fifo(status)           ? "a pipe"
                     : fs::is_socket(status)         ? "a socket"
                     : fs::is_character_file(status) ? "a device"
                     : fs::is_block_file(status)     ? "a block device"
                                                     : "something else";
  throw std::invalid_argument(
      fmt::format("{}: found {}, expected a regular file or a new name to write to", target.string(), what));
}

std::string read_file(const fs::path& file) {
  const Descriptor d(::open(file.c_str(), O_RDONLY | O_CLOEXEC));
  struct ::stat status {};
  if (d.fd < 0 || ::fstat(d.fd, &status) != 0) fail(file, "cannot be read", last_error());
  std::string bytes(static_cast<std::size_t>(status.st_size) + 1,
                    '\0');  // one more: the end shows without growing
  std::size_t filled = 0;
  for (;;) {  // beyond the stated size too: pipes and files under /proc state none
    if (filled == bytes.size()) bytes.resize(2 * filled + 4096);
    const ssize_t n = ::read(d.fd, bytes.data() + filled, bytes.size() - filled);
    if (n < 0 && errno == EINTR) continue;
    if (n < 0) fail(file, "cannot be read", last_error());
    if (n == 0) break;
    filled += static_cast<std::size_t>(n);
  }
  bytes.resize(filled);
  return bytes;
}

void read_pieces(const fs::path& file, std::size_t piece, const std::function<void(std::string_view)>& take) {
  const Descriptor d(::open(file.c_str(), O_RDONLY | O_CLOEXEC));
  if (d.fd < 0) fail(file, "cannot be read", last_error());
  std::string bytes(piece, '\0');
  for (;;) {
    const ssize_t n = ::read(d.fd, bytes.data(), bytes.size());
    if (n < 0 && errno == EINTR) continue;
    if (n < 0) fail(file, "cannot be read", last_error());
    if (n == 0) return;
    take(std::string_view(bytes).substr(0, static_cast<std::size_t>(n)));
  }
}

void write_file(const fs::path& file, std::string_view bytes) {
  FileTransaction transaction;
  transaction.add(file, bytes);
  transaction.commit();
}

FileTransaction::~FileTransaction() {
  roll_back();
}

void FileTransaction::create_parents(const fs::path& folder) {
  std::vector<fs::path> missing;
  std::error_code e;
  for (fs::path p = folder; !p.empty() && !fs::exists(p, e); p = p.parent_path()) missing.push_back(p);
  while (!missing.empty()) {
    const bool made = fs::create_directory(missing.back(), e);
    if (e) fail(missing.back(), "folder cannot be created", e);
    if (made) created_folders_.push_back(missing.back());
    missing.pop_back();
  }
}

void FileTransaction::add(const fs::path& file, std::string_view bytes) {
  require_replaceable(file);
  create_parents(file.parent_path());
  Entry entry;
  entry.target = file;
  Descriptor d(open_temporary(file, entry.temporary));
  entries_.push_back(entry);
  write_all(d.fd, bytes, file);
  if (!d.close()) fail(file, "cannot be written", last_error());
}

void FileTransaction::append(std::string_view bytes) {
  const Entry& entry = entries_.back();
  Descriptor d(::open(entry.temporary.c_str(), O_WRONLY | O_APPEND | O_CLOEXEC));
  if (d.fd < 0) fail(entry.target, "cannot be written", last_error());
  write_all(d.fd, bytes, entry.target);
  if (!d.close()) fail(entry.target, "cannot be written", last_error());
}

std::vector<fs::path> FileTransaction::targets() const {
  std::vector<fs::path> list;
  for (const Entry& entry : entries_) list.push_back(entry.target);
  return list;
}

void FileTransaction::commit() {
  std::error_code e;
  for (Entry& entry : entries_) {
    require_replaceable(entry.target);
    entry.replaces = fs::exists(entry.target, e);
  }
  for (Entry& entry : entries_) {
    fs::rename(entry.temporary, entry.target, e);
    if (e) fail(entry.target, "cannot be written", e);
    entry.renamed = true;
  }
  entries_.clear();
  created_folders_.clear();
}

void FileTransaction::roll_back() noexcept {
  std::error_code ignored;
  for (const Entry& entry : entries_) {
    if (!entry.renamed) fs::remove(entry.temporary, ignored);
    if (entry.renamed && !entry.replaces) fs::remove(entry.target, ignored);
  }
  for (auto folder = created_folders_.rbegin(); folder != created_folders_.rend(); ++folder)
    fs::remove(*folder, ignored);
}

}  // namespace odobench
