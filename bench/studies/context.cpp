#include "bench/studies/context.hpp"

#include <fmt/format.h>

#include <ctime>
#include <filesystem>
#include <fstream>

#include "bench/catalogue/option_values.hpp"
#include "bench/studies/git_revision.hpp"
#include "reports/page/web_assets.hpp"
#include "solvers/libraries/library_versions.hpp"

namespace odobench {
namespace {

std::string cpu_model() {
  std::ifstream info("/proc/cpuinfo");
  for (std::string line; std::getline(info, line);) {
    const auto colon = line.find(": ");
    if (line.rfind("model name", 0) == 0 && colon != std::string::npos) return line.substr(colon + 2);
  }
  return "unknown";
}

std::string compiler() {
#if defined(__clang__)
  return fmt::format("clang {}.{}.{}", __clang_major__, __clang_minor__, __clang_patchlevel__);
#elif defined(__GNUC__)
  return fmt::format("g++ {}.{}.{}", __GNUC__, __GNUC_MINOR__, __GNUC_PATCHLEVEL__);
#else
  return "unknown";
#endif
}

// Of this process, words quoted where a shell would split them; the program without its folder.
std::string command_line() {
  std::ifstream file("/proc/self/cmdline", std::ios::binary);
  std::string line;
  for (std::string word; std::getline(file, word, '\0');) {
    if (line.empty()) word = std::filesystem::path(word).filename().string();
    const bool plain = !word.empty() && word.find_first_not_of(
                                            "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789"
                                            "-_=+.,:/@%") == std::string::npos;
    for (std::size_t at = 0; !plain && (at = word.find('\'', at)) != std::string::npos; at += 4)
      word.replace(at, 1, "'\\''");
    line += (line.empty() ? "" : " ") + (plain ? word : "'" + word + "'");
  }
  return line;
}

}  // namespace

RunContext run_context(int threads, InstructionSet kernel) {
  return {cpu_model(), compiler(),     ODOBENCH_BUILD_TYPE, kGitRevision,     ODOBENCH_VERSION,
          threads,     command_line(), library_versions(),  to_string(kernel)};
}

std::string utc_now() {
  const std::time_t now = std::time(nullptr);
  std::tm utc = {};
  gmtime_r(&now, &utc);
  char text[32];
  std::strftime(text, sizeof text, "%Y-%m-%dT%H:%M:%SZ", &utc);
  return text;
}

std::string version_line() {
  return fmt::format(
      "bench {} (revision {}, {}, {}, kernel {}){}", ODOBENCH_VERSION, kGitRevision, ODOBENCH_BUILD_TYPE,
      compiler(), to_string(kernel_in_force()),
      has_chart_library() ? "" : fmt::format("\nHTML reports without charts: {}", why_no_charts()));
}

}  // namespace odobench
