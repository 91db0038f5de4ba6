#include "tests/support/in_process.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <cstdio>
#include <stdexcept>

#include "bench/cli.hpp"

namespace odobench::testing {
namespace {

// What is written to a descriptor while one lives.
class Caught {
 public:
  explicit Caught(int descriptor) : descriptor_(descriptor), before_(dup(descriptor)), file_(std::tmpfile()) {
    if (before_ < 0 || file_ == nullptr || dup2(fileno(file_), descriptor_) < 0)
      throw std::runtime_error("cannot redirect output");
  }
  ~Caught() {
    dup2(before_, descriptor_);
    close(before_);
    std::fclose(file_);
  }
  Caught(const Caught&) = delete;
  Caught& operator=(const Caught&) = delete;

  std::string text() const {
    std::string all;
    char piece[4096];
    lseek(fileno(file_), 0, SEEK_SET);
    for (ssize_t n; (n = ::read(fileno(file_), piece, sizeof piece)) > 0;)
      all.append(piece, static_cast<std::size_t>(n));
    return all;
  }

 private:
  const int descriptor_, before_;
  std::FILE* const file_;
};

}  // namespace

ProcessResult bench_in_process(const std::vector<std::string>& arguments) {
  std::vector<std::string> words = bench_words(arguments);
  std::vector<char*> argv;
  for (std::string& word : words) argv.push_back(word.data());
  std::fflush(stdout);
  std::fflush(stderr);
  ProcessResult result;
  const Caught out(STDOUT_FILENO), err(STDERR_FILENO);
  result.exit_code = bench_main(static_cast<int>(argv.size()), argv.data());
  std::fflush(stdout);
  std::fflush(stderr);
  result.out = out.text();
  result.err = err.text();
  return result;
}

}  // namespace odobench::testing
