// Speed of the readers of logs that are tables, on one core: bytes of the file per second, all requested
// columns kept. Files of some 30 MB are made first and removed at the end.
//   bench_log_tables [Google Benchmark's flags]
#include <benchmark/benchmark.h>
#include <fmt/format.h>
#include <unistd.h>
#include <zlib.h>

#include <cmath>
#include <cstring>
#include <filesystem>
#include <functional>

#include "base/files.hpp"
#include "datasets/logs/tables/table_logs.hpp"

namespace odobench {
namespace {

namespace fs = std::filesystem;
constexpr std::size_t kRows = 300'000;

fs::path folder() {
  static const fs::path place = fs::temp_directory_path() / fmt::format("bench_log_tables_{}", ::getpid());
  return place;
}

std::string rows_of(const std::function<std::string(std::size_t)>& row) {
  std::string text;
  for (std::size_t k = 0; k < kRows; ++k) text += row(k);
  return text;
}

double wave(std::size_t row, std::size_t column) {
  return 100 * std::sin(1e-3 * static_cast<double>(row * (column + 1)));
}

std::string csv(char separator, char decimal) {
  std::string text = "t_ns,a,b,c,d,e,f,g,h\n";
  for (char& c : text) c = c == ',' ? separator : c;
  return text + rows_of([&](std::size_t k) {
           std::string row =
               fmt::format("{}", 1'760'000'000'000'000'000 + 10'000'000 * static_cast<long long>(k));
           for (std::size_t c = 0; c < 8; ++c) {
             std::string number = fmt::format("{:.6f}", wave(k, c));
             number[number.find('.')] = decimal;
             row += separator + number;
           }
           return row + "\n";
         });
}

std::string json_lines() {
  return rows_of([](std::size_t k) {
    return fmt::format(
        "{{\"topic\":\"pose\",\"t\":{},\"position\":{{\"x\":{:.6f},\"y\":{:.6f}}},\"yaw\":{:.6f},\"data\":[{}"
        ",{}]}}\n",
        1'760'000'000'000'000 + 10'000 * static_cast<long long>(k), wave(k, 0), wave(k, 1), wave(k, 2), k,
        2 * k);
  });
}

void append(std::string& bytes, std::uint64_t value, std::size_t count) {
  for (std::size_t i = 0; i < count; ++i) bytes += static_cast<char>(value >> (8 * i));
}

std::string npy(const std::string& descr, const std::string& shape, const void* data, std::size_t bytes) {
  std::string header = fmt::format("{{'descr': '{}', 'fortran_order': False, 'shape': {}, }}", descr, shape);
  header.resize((header.size() + 11 + 63) / 64 * 64 - 10, ' ');
  std::string array = std::string("\x93NUMPY\x01\x00", 8);
  append(array, header.size(), 2);
  return array + header + std::string(static_cast<const char*>(data), bytes);
}

std::string deflated(const std::string& bytes, int window) {
  z_stream z{};
  deflateInit2(&z, 6, Z_DEFLATED, window, 8, Z_DEFAULT_STRATEGY);
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

struct Numbers {
  std::vector<std::int64_t> t;
  std::vector<double> values;  // kRows x 8

  Numbers() {
    for (std::size_t k = 0; k < kRows; ++k) {
      t.push_back(1'760'000'000'000'000'000 + 10'000'000 * static_cast<std::int64_t>(k));
      for (std::size_t c = 0; c < 8; ++c) values.push_back(wave(k, c));
    }
  }
};

std::string npz(bool deflate) {
  const Numbers numbers;
  std::string file, directory;
  int members = 0;
  const auto add = [&](const std::string& name, const std::string& array) {
    const std::string packed = deflate ? deflated(array, -15) : array;
    std::string fields;
    append(fields, deflate ? 8 : 0, 2);
    append(fields, 0, 4);
    append(fields, ::crc32(0, reinterpret_cast<const Bytef*>(array.data()), static_cast<uInt>(array.size())),
           4);
    append(fields, packed.size(), 4);
    append(fields, array.size(), 4);
    append(fields, name.size(), 2);
    append(fields, 0, 2);
    directory += std::string("PK\x01\x02\x14\x00\x14\x00\x00\x00", 10) + fields + std::string(10, '\0');
    append(directory, file.size(), 4);
    directory += name;
    file += std::string("PK\x03\x04\x14\x00\x00\x00", 8) + fields + name + packed;
    ++members;
  };
  add("log_t.npy", npy("<i8", fmt::format("({},)", kRows), numbers.t.data(), kRows * 8));
  add("log_v.npy", npy("<f8", fmt::format("({}, 8)", kRows), numbers.values.data(), kRows * 64));
  const std::size_t begin = file.size();
  file += directory + std::string("PK\x05\x06\x00\x00\x00\x00", 8);
  for (int k = 0; k < 2; ++k) append(file, static_cast<std::uint64_t>(members), 2);
  append(file, directory.size(), 4);
  append(file, begin, 4);
  append(file, 0, 2);
  return file;
}

std::string mat_element(std::uint32_t type, const std::string& bytes) {
  std::string element;
  append(element, type, 4);
  append(element, bytes.size(), 4);
  return element + bytes + std::string((8 - bytes.size() % 8) % 8, '\0');
}

std::string mat_matrix(const std::string& name, std::uint32_t class_number, std::uint32_t type,
                       std::size_t columns, const void* data) {
  std::string flags, dimensions;
  append(flags, class_number, 8);
  append(dimensions, kRows, 4);
  append(dimensions, columns, 4);
  return mat_element(14,
                     mat_element(6, flags) + mat_element(5, dimensions) + mat_element(1, name) +
                         mat_element(type, std::string(static_cast<const char*>(data), kRows * columns * 8)));
}

std::string mat(bool compressed) {
  const Numbers numbers;
  std::string file(124, ' ');
  file += std::string("\x00\x01IM", 4);
  for (const std::string& variable :
       {mat_matrix("t", 14, 12, 1, numbers.t.data()), mat_matrix("v", 6, 9, 8, numbers.values.data())}) {
    if (!compressed) {
      file += variable;
      continue;
    }
    const std::string packed = deflated(variable, 15);
    append(file, 15, 4);
    append(file, packed.size(), 4);
    file += packed;
  }
  return file;
}

void read_all(benchmark::State& state, const std::string& name, const std::function<std::string()>& make,
              const LogRequest& wanted) {
  const fs::path file = folder() / name;
  write_file(file, make());
  const std::string head = read_file(file).substr(0, 4096);
  std::size_t rows = 0;
  for (auto _ : state)
    for (const LogFormat& format : table_log_formats()) {
      if (!format.recognises(file, head)) continue;
      rows = format.open(file, {})->read({wanted}, Stop())[0].time_ns.size();
      break;
    }
  if (rows != kRows) state.SkipWithError("wrong count of rows");
  state.SetBytesProcessed(state.iterations() * static_cast<std::int64_t>(fs::file_size(file)));
  fs::remove(file);
}

LogRequest some(const std::vector<std::string>& fields, const std::string& source = "") {
  LogRequest wanted;
  wanted.source = source;
  wanted.fields = fields;
  return wanted;
}

void register_all() {
  const auto add = [](const char* name, const std::string& file, const std::function<std::string()>& make,
                      const LogRequest& wanted) {
    benchmark::RegisterBenchmark(name, [=](benchmark::State& state) {
      read_all(state, file, make, wanted);
    })->Unit(benchmark::kMillisecond);
  };
  const std::vector<std::string> all{"a", "b", "c", "d", "e", "f", "g", "h"};
  const std::vector<std::string> columns{"v[0]", "v[1]", "v[2]", "v[3]", "v[4]", "v[5]", "v[6]", "v[7]"};
  add(
      "csv/two_columns", "two.csv", [] { return csv(',', '.'); }, some({"a", "c"}));
  add(
      "csv/all_columns", "all.csv", [] { return csv(',', '.'); }, some(all));
  add(
      "csv/blanks", "blanks.txt", [] { return csv(' ', '.'); }, some(all));
  add(
      "csv/decimal_comma", "comma.csv", [] { return csv(';', ','); }, some(all));
  add("json_lines", "log.jsonl", json_lines,
      some({"position.x", "position.y", "yaw", "data[0]", "data[1]"}, "pose"));
  add(
      "npz/stored", "stored.npz", [] { return npz(false); }, some(columns, "log"));
  add(
      "npz/deflated", "deflated.npz", [] { return npz(true); }, some(columns, "log"));
  add(
      "mat/v5", "v5.mat", [] { return mat(false); }, some(columns));
  add(
      "mat/v7", "v7.mat", [] { return mat(true); }, some(columns));
}

}  // namespace
}  // namespace odobench

int main(int argc, char** argv) {
  odobench::register_all();
  benchmark::Initialize(&argc, argv);
  benchmark::RunSpecifiedBenchmarks();
  std::error_code error;
  std::filesystem::remove_all(odobench::folder(), error);
}
