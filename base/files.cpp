#include "base/files.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <sys/sysmacros.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <system_error>
#include <thread>

#include "base/text.hpp"

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
  int release() {
    const int f = fd;
    fd = -1;
    return f;
  }
  bool close() { return ::close(release()) == 0; }
};

[[noreturn]] void fail(const fs::path& file, const char* what, const std::error_code& reason) {
  throw DataError(fmt::format("{}: {}: {}", shown_path(file), what, reason.message()));
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

ssize_t read_some(int fd, char* to, std::size_t most, const fs::path& file) {
  for (;;) {
    const ssize_t n = ::read(fd, to, most);
    if (n >= 0) return n;
    if (errno != EINTR) fail(file, "cannot be read", last_error());
  }
}

// Opens a file beside target that did not exist, and says which.
int open_temporary(const fs::path& target, fs::path& temporary) {
  for (int attempt = 0;; ++attempt) {
    temporary = target;
    temporary += fmt::format(".tmp-{}-{}", ::getpid(), attempt);
    const int fd =
        ::open(temporary.c_str(), O_CREAT | O_EXCL | O_WRONLY | O_APPEND | O_CLOEXEC | O_NOFOLLOW, 0666);
    if (fd >= 0) return fd;
    if (errno != EEXIST) fail(target, "cannot be written", last_error());
  }
}

std::string kind_of(const fs::file_status& status) {
  switch (status.type()) {
    case fs::file_type::regular:
      return "a regular file";
    case fs::file_type::directory:
      return "a folder";
    case fs::file_type::symlink:
      return "a link";
    case fs::file_type::fifo:
      return "a pipe";
    case fs::file_type::socket:
      return "a socket";
    case fs::file_type::character:
      return "a device";
    case fs::file_type::block:
      return "a block device";
    default:
      return "something that is no regular file";
  }
}

// Missing folders on the way to `folder`, the innermost last; those made are appended to `created`.
void create_folders(const fs::path& folder, std::vector<fs::path>& created) {
  std::vector<fs::path> missing;
  std::error_code e;
  for (fs::path p = folder; !p.empty() && !fs::exists(p, e); p = p.parent_path()) missing.push_back(p);
  while (!missing.empty()) {
    const bool made = fs::create_directory(missing.back(), e);
    if (e) fail(missing.back(), "folder cannot be created", e);
    if (made) created.push_back(missing.back());
    missing.pop_back();
  }
}

void remove_folders(std::vector<fs::path>& created) noexcept {
  std::error_code ignored;  // what is no longer empty stays
  for (auto folder = created.rbegin(); folder != created.rend(); ++folder) fs::remove(*folder, ignored);
  created.clear();
}

fs::path folder_of(const fs::path& file) {
  return file.has_parent_path() ? file.parent_path() : fs::path(".");
}

// Who holds a lock, as the kernel lists it: "process 123", where it can be told apart, else "another
// process".
std::string holder(int descriptor) {
  struct ::stat status {};
  if (::fstat(descriptor, &status) != 0) return "another process";
  const std::string file =
      fmt::format("{:02x}:{:02x}:{}", major(status.st_dev), minor(status.st_dev), status.st_ino);
  std::ifstream locks("/proc/locks");
  for (std::string line; std::getline(locks, line);) {
    std::istringstream words(line);
    std::string number, kind, mode, access, process, place;
    words >> number >> kind >> mode >> access >> process >> place;
    if (kind == "FLOCK" && place == file && process != "0" && process != "-1") return "process " + process;
  }
  return "another process";
}

// The two files change names at once; false where the file system cannot.
bool exchange(const fs::path& one, const fs::path& other) {
  return ::renameat2(AT_FDCWD, one.c_str(), AT_FDCWD, other.c_str(), RENAME_EXCHANGE) == 0;
}

constexpr std::chrono::milliseconds kPatience{30000};  // a commit takes milliseconds

}  // namespace

std::string shown_path(const fs::path& file) {
  return shown(file.string(), kLongestPath);
}

void open_standard_descriptors() {
  for (int fd = 0; fd <= 2; ++fd) {
    if (::fcntl(fd, F_GETFD) >= 0 || errno != EBADF) continue;
    // The lowest free number is this one. Nothing can be read from 0; writing to 1 and 2 fails.
    [[maybe_unused]] const int got = ::open("/dev/null", O_RDONLY);
  }
  struct sigaction ignore = {};
  ignore.sa_handler = SIG_IGN;
  ::sigemptyset(&ignore.sa_mask);
  ::sigaction(SIGXFSZ, &ignore, nullptr);
}

std::string kind_of_file(const fs::path& file) {
  std::error_code e;
  return kind_of(fs::symlink_status(file, e));
}

int open_regular(const fs::path& file) {
  // A pipe without a writer would keep an ordinary open() waiting.
  Descriptor d(::open(file.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK | O_NOCTTY));
  struct ::stat status {};
  if (d.fd < 0 && errno == ENXIO)
    throw DataError(
        fmt::format("{}: found {}, expected a regular file", shown_path(file), kind_of_file(file)));
  if (d.fd < 0 || ::fstat(d.fd, &status) != 0) fail(file, "cannot be read", last_error());
  if (S_ISDIR(status.st_mode)) fail(file, "cannot be read", std::make_error_code(std::errc::is_a_directory));
  if (!S_ISREG(status.st_mode)) {
    std::error_code e;
    throw DataError(
        fmt::format("{}: found {}, expected a regular file", shown_path(file), kind_of(fs::status(file, e))));
  }
  return d.release();
}

std::string read_file(const fs::path& file, std::uintmax_t most) {
  const Descriptor d(open_regular(file));
  struct ::stat status {};
  if (::fstat(d.fd, &status) != 0) fail(file, "cannot be read", last_error());
  const auto too_large = [&](std::uintmax_t size) {
    throw DataError(fmt::format("{}: found {} bytes{}, expected at most {}", shown_path(file), size,
                                size > most ? "" : " and more", most));
  };
  const auto stated = static_cast<std::uintmax_t>(status.st_size);
  if (stated > most) too_large(stated);
  std::string bytes(stated + 1, '\0');  // one more: the end shows without growing
  std::size_t filled = 0;
  for (;;) {  // beyond the stated size too: files under /proc state none, and files grow
    if (filled > most) too_large(filled);
    if (filled == bytes.size()) bytes.resize(2 * filled + 4096);
    const ssize_t n = read_some(d.fd, bytes.data() + filled, bytes.size() - filled, file);
    if (n == 0) break;
    filled += static_cast<std::size_t>(n);
  }
  bytes.resize(filled);
  return bytes;
}

void read_pieces(const fs::path& file, std::size_t piece, const std::function<void(std::string_view)>& take) {
  const Descriptor d(open_regular(file));
  std::string bytes(piece, '\0');
  for (;;) {
    const ssize_t n = read_some(d.fd, bytes.data(), bytes.size(), file);
    if (n == 0) return;
    take(std::string_view(bytes).substr(0, static_cast<std::size_t>(n)));
  }
}

void require_replaceable(const fs::path& target) {
  std::error_code e;
  const fs::file_status status = fs::symlink_status(target, e);
  if (!fs::exists(status) || fs::is_regular_file(status)) return;
  if (fs::is_directory(status))
    fail(target, "cannot be written", std::make_error_code(std::errc::is_a_directory));
  throw std::invalid_argument(fmt::format("{}: found {}, expected a regular file or a new name to write to",
                                          shown_path(target), kind_of(status)));
}

void require_writable(const fs::path& target, Existing existing, const std::string& option) {
  require_replaceable(target);
  std::error_code e;
  if (existing == Existing::Refuse && fs::exists(fs::symlink_status(target, e)))
    throw std::invalid_argument(fmt::format("{}{}{}: it exists; choose another name or give --overwrite",
                                            option, option.empty() ? "" : "=", shown_path(target)));
}

void require_own_folder(const fs::path& folder) {
  std::error_code e;
  const fs::file_status status = fs::symlink_status(folder, e);
  if (fs::is_symlink(status))
    throw std::invalid_argument(
        fmt::format("{}: found {}, expected a folder or none", shown_path(folder), kind_of(status)));
}

void lock_place(int descriptor, const fs::path& place, std::chrono::milliseconds patience) {
  constexpr std::chrono::milliseconds pause{10};
  for (std::chrono::milliseconds waited{0};; waited += pause) {
    if (::flock(descriptor, LOCK_EX | LOCK_NB) == 0) return;
    if (errno != EWOULDBLOCK && errno != EINTR) return;  // no locks here
    if (waited >= patience)
      throw std::invalid_argument(
          fmt::format("{}: {} is writing there", shown_path(place), holder(descriptor)));
    std::this_thread::sleep_for(pause);
  }
}

void write_file(const fs::path& file, std::string_view bytes, Existing existing) {
  FileTransaction transaction(existing);
  transaction.add(file, bytes);
  transaction.commit();
}

FileTransaction::~FileTransaction() {
  roll_back();
}

void FileTransaction::create_parents(const fs::path& folder) {
  create_folders(folder, created_folders_);
}

void FileTransaction::add(const fs::path& file, std::string_view bytes) {
  require_writable(file, existing_);
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
  Descriptor d(::open(entry.temporary.c_str(), O_WRONLY | O_APPEND | O_CLOEXEC | O_NOFOLLOW));
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
  if (entries_.empty()) return;
  const fs::path place = folder_of(entries_.back().target);
  const Descriptor folder(::open(place.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
  if (folder.fd >= 0) lock_place(folder.fd, place, kPatience);
  std::error_code e;
  for (Entry& entry : entries_) {
    require_writable(entry.target, existing_);
    entry.replaces = fs::exists(entry.target, e);
  }
  for (Entry& entry : entries_) {
    entry.exchanged = entry.replaces && exchange(entry.temporary, entry.target);
    if (!entry.exchanged) fs::rename(entry.temporary, entry.target, e);
    if (e) fail(entry.target, "cannot be written", e);
    entry.renamed = true;
  }
  for (const Entry& entry : entries_)
    if (entry.exchanged) fs::remove(entry.temporary, e);
  entries_.clear();
  created_folders_.clear();
}

void FileTransaction::roll_back() noexcept {
  std::error_code ignored;
  for (const Entry& entry : entries_) {
    if (entry.exchanged) exchange(entry.temporary, entry.target);
    if (!entry.renamed || entry.exchanged) fs::remove(entry.temporary, ignored);
    if (entry.renamed && !entry.replaces) fs::remove(entry.target, ignored);
  }
  remove_folders(created_folders_);
}

// False when the file was replaced between opening and locking it.
bool LineFile::open_locked(bool exclusive) {
  Descriptor d(::open(
      path_.c_str(),
      O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK | (exclusive ? O_EXCL : 0), 0666));
  if (d.fd < 0) {
    const std::error_code reason = last_error();
    if (reason.value() == EEXIST) require_writable(path_, Existing::Refuse);
    throw std::invalid_argument(
        fmt::format("{}: cannot be written: {}", shown_path(path_), reason.message()));
  }
  lock_place(d.fd, path_, std::chrono::milliseconds(0));
  struct ::stat opened {
  }, named{};
  if (::fstat(d.fd, &opened) != 0 || ::stat(path_.c_str(), &named) != 0 || opened.st_ino != named.st_ino ||
      opened.st_dev != named.st_dev)
    return false;
  descriptor_ = d.release();
  return true;
}

LineFile::LineFile(const fs::path& file, Existing existing) : path_(file) {
  try {
    create_folders(path_.parent_path(), created_folders_);
  } catch (const DataError& e) {
    remove_folders(created_folders_);
    throw std::invalid_argument(e.what());
  }
  try {
    require_writable(path_, existing);
    std::error_code e;
    made_ = !fs::exists(path_, e);
    while (!open_locked(existing == Existing::Refuse)) {
    }
    if (::ftruncate(descriptor_, 0) != 0) fail(path_, "cannot be written", last_error());
  } catch (...) {
    if (descriptor_ >= 0 && made_) ::unlink(path_.c_str());
    if (descriptor_ >= 0) ::close(descriptor_);
    remove_folders(created_folders_);
    throw;
  }
}

LineFile::~LineFile() {
  struct ::stat status {};
  if (made_ && ::fstat(descriptor_, &status) == 0 && status.st_size == 0) {
    ::unlink(path_.c_str());
    remove_folders(created_folders_);
  }
  ::close(descriptor_);
}

void LineFile::append(std::string_view line) {
  const std::string whole = std::string(line) + "\n";
  const off_t before = ::lseek(descriptor_, 0, SEEK_END);
  ssize_t written = -1;
  do {
    written = ::write(descriptor_, whole.data(), whole.size());
  } while (written < 0 && errno == EINTR);
  if (written == static_cast<ssize_t>(whole.size())) return;
  const std::string reason = written < 0 ? last_error().message() : "the disc is full";
  const bool part = written > 0 && ::ftruncate(descriptor_, before) != 0;
  throw DataError(fmt::format("{}: cannot append a record: {}{}", shown_path(path_), reason,
                              part ? "; the last line is incomplete" : ""));
}

void LineFile::replace(std::string_view text) {
  fs::path temporary;
  Descriptor d(open_temporary(path_, temporary));
  try {
    write_all(d.fd, text, path_);
    lock_place(d.fd, path_, kPatience);  // the lock goes over to the new file before it has the name
    std::error_code e;
    fs::rename(temporary, path_, e);
    if (e) fail(path_, "cannot be written", e);
  } catch (...) {
    ::unlink(temporary.c_str());
    throw;
  }
  std::swap(descriptor_, d.fd);
}

}  // namespace odobench
