// Small files of NumPy and MATLAB, made byte by byte.
#pragma once

#include <fmt/format.h>
#include <zlib.h>

#include <cstdint>
#include <cstring>
#include <string>
#include <utility>
#include <vector>

namespace odobench::testing {

inline std::string little_endian_bytes(std::uint64_t value, std::size_t count) {
  std::string bytes;
  for (std::size_t i = 0; i < count; ++i) bytes += static_cast<char>(value >> (8 * i));
  return bytes;
}

template <class T>
std::string bytes_of_numbers(const std::vector<T>& numbers) {
  return {reinterpret_cast<const char*>(numbers.data()), numbers.size() * sizeof(T)};
}

inline std::string npy_file(const std::string& descr, const std::string& shape, const std::string& data,
                            bool fortran = false, int version = 1) {
  std::string header =
      fmt::format("{{'descr': {}, 'fortran_order': {}, 'shape': {}, }}",
                  descr.front() == '[' ? descr : "'" + descr + "'", fortran ? "True" : "False", shape);
  header.resize((header.size() + 13 + 63) / 64 * 64 - 12, ' ');
  header += '\n';
  return "\x93NUMPY" + std::string(1, static_cast<char>(version)) + std::string(1, '\0') +
         little_endian_bytes(header.size(), version == 1 ? 2 : 4) + header + data;
}

// `window`: 15 with zlib's header, -15 without.
inline std::string deflated(const std::string& bytes, int window) {
  z_stream z{};
  deflateInit2(&z, 9, Z_DEFLATED, window, 8, Z_DEFAULT_STRATEGY);
  std::string packed(deflateBound(&z, bytes.size()), '\0');
  z.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(bytes.data()));
  z.avail_in = static_cast<uInt>(bytes.size());
  z.next_out = reinterpret_cast<Bytef*>(packed.data());
  z.avail_out = static_cast<uInt>(packed.size());
  deflate(&z, Z_FINISH);
  packed.resize(z.total_out);
  deflateEnd(&z);
  return packed;
}

struct ZipOptions {
  bool deflate = false, zip64 = false;
  std::uint64_t claimed = 0;  // size that the members claim; 0: the right one
};

inline std::string zip_file(const std::vector<std::pair<std::string, std::string>>& members,
                            ZipOptions options = {}) {
  std::string file, directory;
  for (const auto& [name, content] : members) {
    const std::string packed = options.deflate ? deflated(content, -15) : content;
    const std::uint64_t size = options.claimed != 0 ? options.claimed : content.size();
    const std::string extra = options.zip64
                                  ? little_endian_bytes(1, 2) + little_endian_bytes(24, 2) +
                                        little_endian_bytes(size, 8) + little_endian_bytes(packed.size(), 8) +
                                        little_endian_bytes(file.size(), 8)
                                  : "";
    const auto narrow = [&](std::uint64_t value) {
      return little_endian_bytes(options.zip64 ? 0xFFFFFFFF : value, 4);
    };
    const uLong crc =
        ::crc32(0, reinterpret_cast<const Bytef*>(content.data()), static_cast<uInt>(content.size()));
    const std::string fields = little_endian_bytes(options.deflate ? 8 : 0, 2) + std::string(4, '\0') +
                               little_endian_bytes(crc, 4) + narrow(packed.size()) + narrow(size) +
                               little_endian_bytes(name.size(), 2);
    directory += std::string("PK\x01\x02\x2d\0\x2d\0\0\0", 10) + fields +
                 little_endian_bytes(extra.size(), 2) + std::string(10, '\0') + narrow(file.size()) + name +
                 extra;
    file += std::string("PK\x03\x04\x2d\0\0\0", 8) + fields + little_endian_bytes(0, 2) + name + packed;
  }
  const std::uint64_t begin = file.size();
  file += directory;
  if (options.zip64) {
    const std::uint64_t end = file.size();
    file += "PK\x06\x06" + little_endian_bytes(44, 8) + std::string("\x2d\0\x2d\0", 4) +
            std::string(8, '\0') + little_endian_bytes(members.size(), 8) +
            little_endian_bytes(members.size(), 8) + little_endian_bytes(directory.size(), 8) +
            little_endian_bytes(begin, 8);
    file += "PK\x06\x07" + std::string(4, '\0') + little_endian_bytes(end, 8) + little_endian_bytes(1, 4);
  }
  const std::uint64_t count = options.zip64 ? 0xFFFF : members.size();
  return file + "PK\x05\x06" + std::string(4, '\0') + little_endian_bytes(count, 2) +
         little_endian_bytes(count, 2) + little_endian_bytes(directory.size(), 4) +
         little_endian_bytes(options.zip64 ? 0xFFFFFFFF : begin, 4) + std::string(2, '\0');
}

// Elements of MAT files, version 5.
inline std::string mat_element(std::uint32_t type, const std::string& bytes) {
  return little_endian_bytes(type, 4) + little_endian_bytes(bytes.size(), 4) + bytes +
         std::string((8 - bytes.size() % 8) % 8, '\0');
}

inline std::string mat_small(std::uint32_t type, const std::string& bytes) {
  std::string padded = bytes;
  padded.resize(4, '\0');
  return little_endian_bytes(type, 2) + little_endian_bytes(bytes.size(), 2) + padded;
}

inline std::string mat_dimensions(const std::vector<std::int32_t>& dimensions) {
  return mat_element(5, bytes_of_numbers(dimensions));
}

inline std::string mat_flags(std::uint32_t class_and_flags) {
  return mat_element(6, little_endian_bytes(class_and_flags, 8));
}

// `data`: an element.
inline std::string mat_array(const std::string& name, std::uint32_t class_number,
                             const std::vector<std::int32_t>& dimensions, const std::string& data) {
  return mat_element(14, mat_flags(class_number) + mat_dimensions(dimensions) + mat_element(1, name) + data);
}

inline std::string mat_struct(const std::string& name,
                              const std::vector<std::pair<std::string, std::string>>& fields,
                              std::int32_t count = 1) {
  std::string names, values;
  for (const auto& [field, value] : fields) {
    std::string padded = field;
    padded.resize(32, '\0');
    names += padded;
    values += value;
  }
  std::string all;
  for (std::int32_t k = 0; k < count; ++k) all += values;
  return mat_element(14, mat_flags(2) + mat_dimensions({1, count}) + mat_element(1, name) +
                             mat_small(5, little_endian_bytes(32, 4)) + mat_element(1, names) + all);
}

inline std::string mat_file(const std::vector<std::string>& variables, bool compressed = false) {
  std::string file = "MATLAB 5.0 MAT-file, written by a test";
  file.resize(124, ' ');
  file += std::string("\x00\x01IM", 4);
  for (const std::string& variable : variables) {
    const std::string packed = compressed ? deflated(variable, 15) : "";
    file +=
        compressed ? little_endian_bytes(15, 4) + little_endian_bytes(packed.size(), 4) + packed : variable;
  }
  return file;
}

}  // namespace odobench::testing
