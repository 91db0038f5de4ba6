// Runs a program as a user would and looks at what it did: output, exit code, effect of signals. And a folder
// that disappears with the test.
#pragma once

#include <sys/types.h>

#include <filesystem>
#include <string>
#include <vector>

namespace odobench::testing {

class TemporaryFolder {
 public:
  TemporaryFolder();
  ~TemporaryFolder();
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  std::filesystem::path operator/(const std::string& name) const { return path_ / name; }
  const std::filesystem::path& path() const { return path_; }
  // Writes a file and returns its path.
  std::string file(const std::string& name, const std::string& content) const;

 private:
  std::filesystem::path path_;
};

// The program under test: that of this build, or the file that the environment variable ODOBENCH_BENCH names.
// With ODOBENCH_BENCH_SANITIZED=1 that one has sanitizers: what they change (memory, handlers of signals) is
// not tested then.
std::string bench_program();
bool bench_is_sanitized();

struct ProcessResult {
  int exit_code = -1;  // -1 when a signal ended the process
  int signal = 0;      // that signal
  std::string out, err;
};

class Process {
 public:
  // Starts words[0] with standard input empty, standard output and error captured, and these variables
  // ("NAME=VALUE") in its environment besides.
  explicit Process(const std::vector<std::string>& words, const std::vector<std::string>& environment = {});
  ~Process();  // kills what still runs
  Process(const Process&) = delete;
  Process& operator=(const Process&) = delete;
  void send(int signal) const;
  // Waits for the end; after `timeout_s` seconds the process is killed and std::runtime_error thrown.
  ProcessResult wait(double timeout_s = 120);

 private:
  pid_t pid_ = -1;
  TemporaryFolder folder_;
};

// The bench of this build with these arguments.
ProcessResult run_bench(const std::vector<std::string>& arguments, double timeout_s = 120);
// The same through a shell: "BENCH ARGUMENTS SUFFIX", e.g. with a suffix ">&-". Arguments must not hold
// quotes.
ProcessResult run_bench_in_shell(const std::vector<std::string>& arguments, const std::string& suffix,
                                 double timeout_s = 120);
std::vector<std::string> bench_words(const std::vector<std::string>& arguments);

std::string content(const std::filesystem::path& file);
std::vector<std::string> lines(const std::string& text);

// Names of all files and folders below a folder, relative to it, sorted.
std::vector<std::string> files_below(const std::filesystem::path& folder);

// Waits until the file has at least `count` complete lines; false after `timeout_s`.
bool wait_for_lines(const std::filesystem::path& file, std::size_t count, double timeout_s = 60);

}  // namespace odobench::testing
