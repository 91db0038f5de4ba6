#include "tests/support/run_process.hpp"

#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <thread>

namespace odobench::testing {
namespace {

namespace fs = std::filesystem;

bool poll_until(double timeout_s, const auto& condition) {
  const auto end = std::chrono::steady_clock::now() + std::chrono::duration<double>(timeout_s);
  while (!condition()) {
    if (std::chrono::steady_clock::now() > end) return false;
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }
  return true;
}

}  // namespace

TemporaryFolder::TemporaryFolder() {
  std::string name = (fs::temp_directory_path() / "odobench_test_XXXXXX").string();
  if (mkdtemp(name.data()) == nullptr) throw std::runtime_error("cannot create " + name);
  path_ = name;
}

TemporaryFolder::~TemporaryFolder() {
  std::error_code ignored;
  fs::remove_all(path_, ignored);
}

std::string TemporaryFolder::file(const std::string& name, const std::string& text) const {
  std::ofstream out(path_ / name, std::ios::binary);
  if (!(out << text).flush()) throw std::runtime_error("cannot write " + (path_ / name).string());
  return (path_ / name).string();
}

Process::Process(const std::vector<std::string>& words, const std::vector<std::string>& environment) {
  std::vector<std::string> variables = environment;
  std::vector<std::string> copy = words;
  std::vector<char*> argv;
  for (std::string& word : copy) argv.push_back(word.data());
  argv.push_back(nullptr);
  const std::string out = (folder_ / "out").string(), err = (folder_ / "err").string();
  pid_ = fork();
  if (pid_ < 0) throw std::runtime_error("cannot fork");
  if (pid_ > 0) return;
  const int in = open("/dev/null", O_RDONLY);
  const int to_out = open(out.c_str(), O_WRONLY | O_CREAT, 0600);
  const int to_err = open(err.c_str(), O_WRONLY | O_CREAT, 0600);
  dup2(in, STDIN_FILENO);
  dup2(to_out, STDOUT_FILENO);
  dup2(to_err, STDERR_FILENO);
  for (std::string& variable : variables) putenv(variable.data());
  execv(argv[0], argv.data());
  _exit(127);
}

Process::~Process() {
  if (pid_ <= 0) return;
  kill(pid_, SIGKILL);
  waitpid(pid_, nullptr, 0);
}

void Process::send(int signal) const {
  kill(pid_, signal);
}

ProcessResult Process::wait(double timeout_s) {
  int status = 0;
  if (!poll_until(timeout_s, [&] { return waitpid(pid_, &status, WNOHANG) == pid_; })) {
    throw std::runtime_error("the process did not end in time; standard error: " + content(folder_ / "err"));
  }
  pid_ = -1;
  ProcessResult result;
  if (WIFEXITED(status)) result.exit_code = WEXITSTATUS(status);
  if (WIFSIGNALED(status)) result.signal = WTERMSIG(status);
  result.out = content(folder_ / "out");
  result.err = content(folder_ / "err");
  return result;
}

std::string bench_program() {
  const char* other = std::getenv("ODOBENCH_BENCH");
  return other != nullptr ? other : ODOBENCH_BENCH;
}

bool bench_is_sanitized() {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
  return true;
#else
  return std::getenv("ODOBENCH_BENCH_SANITIZED") != nullptr;
#endif
}

std::vector<std::string> bench_words(const std::vector<std::string>& arguments) {
  std::vector<std::string> words = {bench_program()};
  words.insert(words.end(), arguments.begin(), arguments.end());
  return words;
}

ProcessResult run_bench(const std::vector<std::string>& arguments, double timeout_s) {
  return Process(bench_words(arguments)).wait(timeout_s);
}

ProcessResult run_bench_in_shell(const std::vector<std::string>& arguments, const std::string& suffix,
                                 double timeout_s) {
  std::string command = "exec";
  for (const std::string& word : bench_words(arguments)) command += " '" + word + "'";
  return Process({"/bin/sh", "-c", command + " " + suffix}).wait(timeout_s);
}

std::string content(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  std::ostringstream text;
  text << in.rdbuf();
  return text.str();
}

std::vector<std::string> lines(const std::string& text) {
  std::vector<std::string> list;
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);) list.push_back(line);
  return list;
}

std::vector<std::string> files_below(const fs::path& folder) {
  std::vector<std::string> names;
  if (fs::is_directory(folder))
    for (const auto& entry : fs::recursive_directory_iterator(folder))
      names.push_back(entry.path().lexically_relative(folder).string());
  std::sort(names.begin(), names.end());
  return names;
}

bool wait_for_lines(const fs::path& file, std::size_t count, double timeout_s) {
  return poll_until(timeout_s, [&] {
    const std::string text = content(file);
    return static_cast<std::size_t>(std::count(text.begin(), text.end(), '\n')) >= count;
  });
}

}  // namespace odobench::testing
