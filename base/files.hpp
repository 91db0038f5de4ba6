// Files in and out: what is read whole is a regular file of bounded size, what is written appears whole or
// not at all, and two processes do not write to one place at a time. Names in messages are quoted by
// shown_path().
#pragma once

#include <sys/types.h>

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "base/error.hpp"

namespace odobench {

// Descriptors 0, 1 and 2 that the process got closed are taken by /dev/null, opened so that reading finds the
// end and writing fails with EBADF: no file opened later gets their numbers, and with them what is meant for
// the terminal. A write beyond a limit of the file size becomes an error instead of a signal (SIGXFSZ). To be
// called before anything else is opened.
void open_standard_descriptors();

// A file's name as messages quote it: escaped (base/text.hpp), longer than other text may be.
inline constexpr std::size_t kLongestPath = 400;
std::string shown_path(const std::filesystem::path& file);

// What a file is, for messages: "a regular file", "a folder", "a pipe", "a device", ... of symlink_status (a
// link is "a link").
std::string kind_of_file(const std::filesystem::path& file);

// Files that are read whole must not be larger.
inline constexpr std::uintmax_t kLargestFile = std::uintmax_t{1} << 30;

// Opens a regular file for reading; a descriptor that the caller closes. Pipes, devices and folders are
// refused without waiting for them. Throws DataError "FILE: cannot be read: REASON" or "FILE: found a pipe,
// expected a regular file".
int open_regular(const std::filesystem::path& file);

// The bytes of a file, as they are. Throws DataError when it is no regular file, cannot be read or has more
// than `most` bytes.
std::string read_file(const std::filesystem::path& file, std::uintmax_t most = kLargestFile);

// The same in pieces of at most `piece` bytes, valid during the call that gets them, without a limit.
void read_pieces(const std::filesystem::path& file, std::size_t piece,
                 const std::function<void(std::string_view)>& take);

// Throws std::invalid_argument unless `target` is a regular file or does not exist: a rename over a device, a
// pipe or a link would destroy what is none of ours. A folder throws DataError.
void require_replaceable(const std::filesystem::path& target);

// What to do with a file that is there.
enum class Existing { Refuse, Replace };

// Throws std::invalid_argument "WHAT: it exists; choose another name or give --overwrite" when `target` is
// there and is to be refused, and what require_replaceable throws. WHAT is the name of the file, behind
// "OPTION=" where an option is given.
void require_writable(const std::filesystem::path& target, Existing existing, const std::string& option = "");

// Throws std::invalid_argument when `folder` is a link: of folders that we name inside a place that others
// may write to.
void require_own_folder(const std::filesystem::path& folder);

// Keeps `descriptor` (an open file or folder) locked for this process (flock) until it is closed. While
// another process has the lock, waits for at most `patience`; then throws std::invalid_argument "PLACE:
// process 123 is writing there". File systems without locks are left without.
void lock_place(int descriptor, const std::filesystem::path& place, std::chrono::milliseconds patience);

// Writes one file so that a reader sees the old content or the new, never a part (FileTransaction with one
// file).
void write_file(const std::filesystem::path& file, std::string_view bytes,
                Existing existing = Existing::Replace);

// Several files that belong together. add() writes to a temporary name beside the target and creates missing
// parent folders; commit() renames all of them, in the order added: add what the others refer to first.
// Whatever was not committed is removed by the destructor, folders it created included; when a rename fails,
// the files renamed before it are removed too, and older ones come back. A process that is killed between two
// renames leaves some new and some old files, and the others under their temporary names. A crash of the
// machine may still lose data: nothing is synced.
//
// Targets must be what require_writable lets pass, when they are added and when they are renamed. Of two
// processes that commit to one folder (that of the file added last) the second waits, so that files that
// belong together stay together.
class FileTransaction {
 public:
  explicit FileTransaction(Existing existing = Existing::Replace) : existing_(existing) {}
  FileTransaction(const FileTransaction&) = delete;
  FileTransaction& operator=(const FileTransaction&) = delete;
  ~FileTransaction();

  void add(const std::filesystem::path& file, std::string_view bytes);
  // More bytes for the file added last: files that are too long to be put together in memory.
  void append(std::string_view bytes);
  void commit();
  // What was added and not yet committed, in this order.
  std::vector<std::filesystem::path> targets() const;

 private:
  struct Entry {
    std::filesystem::path temporary, target;
    bool renamed = false, replaces = false;
    bool exchanged = false;  // the older file has the temporary name now
  };
  void create_parents(const std::filesystem::path& folder);
  void roll_back() noexcept;

  const Existing existing_;
  std::vector<Entry> entries_;
  std::vector<std::filesystem::path> created_folders_;
};

// A file of lines, on disc line by line: each is one write, so that a process that is killed leaves every
// line it completed. One process at a time: locked from the beginning to the end of the object.
class LineFile {
 public:
  // Creates the folder and the file. Throws std::invalid_argument when that is not possible, when another
  // process has it open, or when it exists and is not to be replaced.
  LineFile(const std::filesystem::path& file, Existing existing);
  // An empty file, and folders, that it made itself are removed.
  ~LineFile();
  LineFile(const LineFile&) = delete;
  LineFile& operator=(const LineFile&) = delete;

  const std::filesystem::path& path() const { return path_; }
  // `line` without its break. Throws DataError when the disc is full or the like; a part of a line is taken
  // back then.
  void append(std::string_view line);
  // Puts `text` in the place of all lines so far, at once.
  void replace(std::string_view text);

 private:
  bool open_locked(bool exclusive);

  std::filesystem::path path_;
  int descriptor_ = -1;
  bool made_ = false;
  std::vector<std::filesystem::path> created_folders_;
};

}  // namespace odobench
