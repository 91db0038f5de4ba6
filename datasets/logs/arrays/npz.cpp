#include "datasets/logs/arrays/npz.hpp"

#include <fmt/format.h>
#include <zlib.h>

#include <algorithm>

#include "base/files.hpp"
#include "base/text.hpp"
#include "datasets/logs/arrays/npy_array.hpp"

namespace odobench {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMostMembers = 65'536;
constexpr std::uint64_t kLongestEnd = 22 + 65'535;  // of a zip file: its last record with a comment

std::uint64_t zip_number(std::string_view bytes, std::size_t at, std::size_t count) {
  std::uint64_t value = 0;
  for (std::size_t i = count; i-- > 0;) value = value << 8 | static_cast<unsigned char>(bytes[at + i]);
  return value;
}

struct ZipMember {
  std::string name;
  std::uint64_t method = 0, flags = 0, crc = 0, packed = 0, size = 0, offset = 0;
};

// Counts and sums the bytes that pass.
class CheckedBytes : public ByteSource {
 public:
  explicit CheckedBytes(ByteSource& from) : from_(from) {}
  std::size_t read(char* to, std::size_t most) override {
    const std::size_t n = from_.read(to, most);
    crc_ = ::crc32_z(crc_, reinterpret_cast<const Bytef*>(to), n);
    return n;
  }
  std::uint64_t crc() const { return crc_; }

 private:
  ByteSource& from_;
  uLong crc_ = ::crc32_z(0, nullptr, 0);
};

// Walks over the members of a zip archive by its directory.
class ZipFile {
 public:
  ZipFile(const fs::path& file, std::int64_t max_bytes)
      : name_(shown_path(file)), bytes_(file), left_(static_cast<std::uint64_t>(max_bytes)) {
    find_directory();
  }

  void walk(ArrayVisitor& visitor, const Stop& stop) {
    std::uint64_t at = directory_;
    if (count_ > kMostMembers)
      throw DataError(fmt::format("{}: found {} members, expected at most {}", name_, count_, kMostMembers));
    for (std::uint64_t i = 0; i < count_; ++i) {
      const ZipMember member = read_entry(at);
      constexpr std::string_view ending = ".npy";
      const std::size_t size = member.name.size();
      if (size > ending.size() && member.name.substr(size - ending.size()) == ending)
        walk(member, visitor, stop);
    }
  }

 private:
  std::string take(std::uint64_t at, std::size_t count, const char* what) {
    std::string text(count, '\0');
    bytes_.seek(at);
    if (at > bytes_.size() || count > bytes_.size() - at || !bytes_.read_exactly(text.data(), count))
      throw DataError(
          fmt::format("{}: byte {}: {} expected, the file has {} bytes: it is cut off or no zip archive",
                      name_, at, what, bytes_.size()));
    return text;
  }

  void find_directory() {
    const std::uint64_t length = std::min(bytes_.size(), kLongestEnd);
    const std::string tail =
        take(bytes_.size() - length, static_cast<std::size_t>(length), "the directory's end");
    const std::size_t at = tail.rfind("PK\x05\x06");
    if (at == std::string::npos || tail.size() - at < 22)
      throw DataError(name_ + ": found no directory at the end of the zip archive: it is cut off");
    count_ = zip_number(tail, at + 10, 2);
    directory_ = zip_number(tail, at + 16, 4);
    if ((count_ == 0xFFFF || directory_ == 0xFFFFFFFF) && at >= 20 &&
        tail.compare(at - 20, 4, "PK\x06\x07") == 0) {
      const std::string end = take(zip_number(tail, at - 12, 8), 56, "a zip64 record");
      if (end.compare(0, 4, "PK\x06\x06") != 0)
        throw DataError(name_ + ": found no zip64 record where it should be");
      count_ = zip_number(end, 32, 8);
      directory_ = zip_number(end, 48, 8);
    }
  }

  // The entry of the directory at this byte, which moves on to the next one.
  ZipMember read_entry(std::uint64_t& at) {
    const std::string fixed = take(at, 46, "an entry of the directory");
    if (fixed.compare(0, 4, "PK\x01\x02") != 0)
      throw DataError(
          fmt::format("{}: byte {}: found no entry of the directory of the zip archive", name_, at));
    ZipMember member;
    member.flags = zip_number(fixed, 8, 2);
    member.method = zip_number(fixed, 10, 2);
    member.crc = zip_number(fixed, 16, 4);
    member.packed = zip_number(fixed, 20, 4);
    member.size = zip_number(fixed, 24, 4);
    member.offset = zip_number(fixed, 42, 4);
    const std::size_t name = zip_number(fixed, 28, 2), extra = zip_number(fixed, 30, 2);
    const std::string text = take(at + 46, name + extra, "a name");
    member.name = text.substr(0, name);
    read_zip64(std::string_view(text).substr(name), member);
    at += 46 + name + extra + zip_number(fixed, 32, 2);
    return member;
  }

  // Sizes that do not fit into 32 bits stand in the extra field 1, in this order.
  static void read_zip64(std::string_view extra, ZipMember& member) {
    while (extra.size() >= 4) {
      const std::uint64_t id = zip_number(extra, 0, 2);
      const std::size_t size = zip_number(extra, 2, 2);
      extra.remove_prefix(4);
      if (size > extra.size()) return;
      std::string_view field = extra.substr(0, size);
      for (std::uint64_t* value : {&member.size, &member.packed, &member.offset}) {
        if (id != 1 || *value != 0xFFFFFFFF || field.size() < 8) continue;
        *value = zip_number(field, 0, 8);
        field.remove_prefix(8);
      }
      extra.remove_prefix(size);
    }
  }

  void walk(const ZipMember& member, ArrayVisitor& visitor, const Stop& stop) {
    const std::string place = fmt::format("{}: {}", name_, shown(member.name));
    if ((member.flags & 1) != 0) throw DataError(place + ": is encrypted");
    if (member.method != 0 && member.method != 8)
      throw DataError(
          fmt::format("{}: compressed by method {}, expected none or deflate", place, member.method));
    if (member.size > kLargestArray)
      throw DataError(fmt::format("{}: claims {} bytes, more than {}", place, member.size, kLargestArray));
    if (member.size > left_) throw DataError(name_ + ": decompresses to more than is allowed (--max-bytes)");
    left_ -= member.size;
    const std::string local = take(member.offset, 30, "a member");
    if (local.compare(0, 4, "PK\x03\x04") != 0)
      throw DataError(fmt::format("{}: found no member at byte {}", place, member.offset));
    bytes_.seek(member.offset + 30 + zip_number(local, 26, 2) + zip_number(local, 28, 2));
    LimitedBytes packed(bytes_, member.packed);
    const std::string array = member.name.substr(0, member.name.size() - 4);
    if (member.method == 0)
      walk_member(packed, array, place, member, visitor, stop);
    else {
      InflatedBytes inflated(packed, true, member.size, place);
      walk_member(inflated, array, place, member, visitor, stop);
    }
  }

  static void walk_member(ByteSource& bytes, const std::string& array, const std::string& place,
                          const ZipMember& member, ArrayVisitor& visitor, const Stop& stop) {
    CheckedBytes checked(bytes);
    if (!walk_npy(checked, array, place, visitor, stop)) return;
    char more = 0;
    if (checked.read(&more, 1) != 0) throw DataError(place + ": has more bytes than its shape says");
    if (checked.crc() != member.crc) throw DataError(place + ": is damaged: its check sum differs");
  }

  std::string name_;
  FileBytes bytes_;
  std::uint64_t left_;  // bytes that may be decompressed
  std::uint64_t directory_ = 0, count_ = 0;
};

// A zip archive that begins with an array: spreadsheets are zip archives too.
bool is_npz(const fs::path&, const std::string& head) {
  if (head.size() < 30 || head.substr(0, 4) != "PK\x03\x04") return head.substr(0, 4) == "PK\x05\x06";
  const std::string_view name = std::string_view(head).substr(30, zip_number(head, 26, 2));
  return name.size() > 4 && name.substr(name.size() - 4) == ".npy";
}

std::unique_ptr<LogFile> open_npz(const fs::path& file, const LogOptions& options) {
  return open_arrays(file, "NumPy npz", ArrayGrouping::TimePrefixes,
                     [file, most = options.max_bytes](ArrayVisitor& visitor, const Stop& stop) {
                       ZipFile(file, most).walk(visitor, stop);
                     });
}

bool is_npy(const fs::path&, const std::string& head) {
  return head.substr(0, 6) == "\x93NUMPY";
}

std::unique_ptr<LogFile> open_npy(const fs::path& file, const LogOptions&) {
  return open_arrays(file, "NumPy npy", ArrayGrouping::TimePrefixes,
                     [file](ArrayVisitor& visitor, const Stop& stop) {
                       FileBytes bytes(file);
                       walk_npy(bytes, "", shown_path(file), visitor, stop);
                     });
}

}  // namespace

LogFormat npz_log_format() {
  return {"NumPy npz", is_npz, open_npz};
}

LogFormat npy_log_format() {
  return {"NumPy npy", is_npy, open_npy};
}

}  // namespace odobench
