// Whole files in and out. Every failure is a DataError "file: what was tried: the system's reason".
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "base/error.hpp"

namespace odobench {

// The bytes of a file, as they are.
std::string read_file(const std::filesystem::path& file);

// The same in pieces of at most `piece` bytes, valid during the call that gets them.
void read_pieces(const std::filesystem::path& file, std::size_t piece,
                 const std::function<void(std::string_view)>& take);

// Throws std::invalid_argument unless `target` is a regular file or does not exist: a rename over a device, a pipe or a link would
// destroy what is none of ours. A folder throws DataError.
void require_replaceable(const std::filesystem::path& target);

// Writes one file so that a reader sees the old content or the new, never a part (FileTransaction with one
// file).
void write_file(const std::filesystem::path& file, std::string_view bytes);

// Several files that belong together. add() writes to a temporary name beside the target and creates missing
// parent folders; commit() renames all of them, in the order added: add what the others refer to first.
// Whatever was not committed is removed by the destructor, folders it created included; when a rename fails,
// the files renamed before it are removed too, unless they replaced older ones. A crash of the machine may
// still lose data: nothing is synced.
//
// Targets must be what require_replaceable lets pass.
class FileTransaction {
 public:
  FileTransaction() = default;
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
  };
  void create_parents(const std::filesystem::path& folder);
  void roll_back() noexcept;

  std::vector<Entry> entries_;
  std::vector<std::filesystem::path> created_folders_;
};

}  // namespace odobench
