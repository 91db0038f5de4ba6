// A target of libFuzzer over one format that the program reads: ODOBENCH_FUZZ=NAME chooses it
// (tests/support/formats.hpp lists them). What a user must not see ends the process with the input that shows
// it. scripts/fuzz.sh builds and runs it.
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <string>

#include "tests/support/formats.hpp"
#include "tests/support/in_process.hpp"

namespace {

using odobench::testing::Format;

const Format& chosen_format() {
  static const Format& format = [&]() -> const Format& {
    const char* name = std::getenv("ODOBENCH_FUZZ");
    return odobench::testing::format_called(name == nullptr ? "" : name);
  }();
  return format;
}

// Work that may be asked for, but takes longer than a fuzzer waits: ten thousand repetitions, a population of
// a million.
bool asks_for_much(const std::string& bytes) {
  const std::string& name = chosen_format().name;
  if (name != "configuration" && name != "options") return false;
  std::size_t digits = 0;
  for (const char c : bytes) {
    digits = c >= '0' && c <= '9' ? digits + 1 : 0;
    if (digits > 3) return true;
  }
  return bytes.find("all") != std::string::npos;
}

}  // namespace

// Prints the formats, or writes the examples of the format into a folder, the first corpus.
extern "C" int LLVMFuzzerInitialize(int* argc, char*** argv) {
  if (*argc == 2 && std::string((*argv)[1]) == "--formats") {
    for (const std::string& name : odobench::testing::format_names()) std::puts(name.c_str());
    std::exit(0);
  }
  if (*argc == 2 && std::string((*argv)[1]).rfind("--examples=", 0) == 0) {
    const std::filesystem::path folder = std::string((*argv)[1]).substr(11);
    std::filesystem::create_directories(folder);
    int number = 0;
    for (const std::string& example : chosen_format().examples())
      if (std::FILE* file = std::fopen((folder / ("example_" + std::to_string(++number))).c_str(), "wb")) {
        std::fwrite(example.data(), 1, example.size(), file);
        std::fclose(file);
      }
    std::exit(0);
  }
  (void)chosen_format().examples();  // some take seconds to make, which are none of the first input
  return 0;
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const odobench::testing::TemporaryFolder folder;
  const std::string bytes(reinterpret_cast<const char*>(data), size);
  if (asks_for_much(bytes)) return -1;
  for (const auto& words : chosen_format().commands(bytes, folder)) {
    std::filesystem::remove_all(folder / "out");
    const odobench::testing::ProcessResult result = odobench::testing::bench_in_process(words);
    const std::string complaint =
        odobench::testing::complaint_about(result, folder, bytes, chosen_format().binary);
    if (complaint.empty()) continue;
    std::fprintf(stderr, "%s\n%s\n", complaint.c_str(), result.err.c_str());
    std::abort();
  }
  return 0;
}
