#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>

#include "base/files.hpp"
#include "base/text.hpp"
#include "datasets/logs/arrays/array_log.hpp"
#include "datasets/logs/arrays/byte_source.hpp"
#include "datasets/logs/arrays/mat.hpp"
#include "datasets/logs/arrays/mat73_child.hpp"
#include "datasets/logs/arrays/npy_array.hpp"

namespace odobench {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kHdf5 = "\x89HDF\r\n\x1a\n";
constexpr int kPollPipe_ms = 100;

// The child that reads, as the source of what it writes.
class Mat73Child : public ByteSource {
 public:
  Mat73Child(const fs::path& file, const Stop& stop) : name_(shown_path(file)), stop_(stop) {
    ::close(open_regular(file));
    int ends[2];
    if (::pipe2(ends, O_CLOEXEC) != 0) throw DataError(name_ + ": no pipe to read it through");
    child_ = ::fork();
    if (child_ == 0) {
      ::close(ends[0]);
      read_mat73_in_child(file, ends[1]);
    }
    ::close(ends[1]);
    pipe_ = ends[0];
    if (child_ < 0) {
      ::close(pipe_);
      throw DataError(name_ + ": no process to read it in");
    }
  }
  ~Mat73Child() override {
    if (child_ > 0) ::kill(child_, SIGKILL);
    wait();
    ::close(pipe_);
  }
  Mat73Child(const Mat73Child&) = delete;
  Mat73Child& operator=(const Mat73Child&) = delete;

  std::size_t read(char* to, std::size_t most) override {
    for (;;) {
      stop_.check();
      pollfd ready{pipe_, POLLIN, 0};
      if (::poll(&ready, 1, kPollPipe_ms) <= 0) continue;
      const ssize_t n = ::read(pipe_, to, most);
      if (n < 0 && errno == EINTR) continue;
      return n < 0 ? 0 : static_cast<std::size_t>(n);
    }
  }

  void walk(ArrayVisitor& visitor) {
    for (;;) {
      unsigned char kind = 0;
      take(&kind, 1);
      switch (static_cast<Mat73Message>(kind)) {
        case Mat73Message::End:
          return;
        case Mat73Message::Array:
          take_array(visitor);
          break;
        case Mat73Message::Skip: {
          const std::string name = take_text();
          visitor.skip(name, take_text());
          break;
        }
        case Mat73Message::Fault: {
          take_text();
          throw DataError(name_ + ": " + take_text());
        }
        default:
          crashed();
      }
    }
  }

 private:
  int wait() {
    int status = 0;
    if (child_ > 0)
      while (::waitpid(child_, &status, 0) < 0 && errno == EINTR) continue;
    child_ = -1;
    return status;
  }
  [[noreturn]] void crashed() {
    const int status = wait();
    if (WIFSIGNALED(status) && WTERMSIG(status) == SIGXCPU)
      throw DataError(name_ + ": the MATLAB reader needed more than 60 s of processor time for this file");
    throw DataError(name_ + ": the MATLAB reader crashed on this file");
  }
  void take(void* to, std::size_t count) {
    if (!read_exactly(static_cast<char*>(to), count)) crashed();
  }
  template <class T>
  T take_value() {
    T value{};
    take(&value, sizeof value);
    return value;
  }
  std::string take_text() {
    constexpr std::uint32_t longest = 1 << 16;
    const auto size = take_value<std::uint32_t>();
    if (size > longest)
      throw DataError(fmt::format("{}: found a name of {} bytes, expected at most {}", name_, size, longest));
    std::string text(size, '\0');
    take(text.data(), size);
    return text;
  }
  void take_array(ArrayVisitor& visitor);

  std::string name_;
  const Stop& stop_;
  pid_t child_ = -1;
  int pipe_ = -1;
};

void Mat73Child::take_array(ArrayVisitor& visitor) {
  constexpr unsigned logical = 128, most_dimensions = 32;
  ArrayHead head;
  head.name = take_text();
  const unsigned flags = take_value<unsigned char>(), number = flags % logical;
  const auto rank = take_value<std::uint32_t>();
  if (!is_number_of_matlab(number) || rank > most_dimensions) crashed();
  std::vector<std::uint64_t> dimensions;
  for (std::uint32_t k = 0; k < rank; ++k) dimensions.push_back(take_value<std::uint64_t>());
  const NumberType stored = number_type_of_matlab(number);
  head.type = flags >= logical ? NumberType::Bool : stored;
  auto left = take_value<std::uint64_t>();
  const bool fits = shape_of(dimensions, head);
  if (fits && left != std::uint64_t{head.rows} * head.columns * bytes_of(stored)) crashed();
  if (left > kLargestArray)
    throw DataError(
        fmt::format("{}: {}: claims {} bytes, more than {}", name_, shown(head.name), left, kLargestArray));
  if (!fits) visitor.skip(head.name, "its dimensions are too large");
  const bool wanted = fits && visitor.begin(head);
  ArrayBytes numbers(visitor, stored);
  std::vector<char> piece(1 << 16);
  while (left > 0) {
    const std::size_t n = std::min<std::uint64_t>(left, piece.size());
    take(piece.data(), n);
    if (wanted) numbers.take({piece.data(), n});
    left -= n;
  }
}

bool is_mat73(const fs::path&, const std::string& head) {
  if (head.substr(0, kHdf5.size()) == kHdf5) return true;
  return head.size() >= 128 && head.substr(124, 4) == std::string("\x00\x02IM", 4);
}

std::unique_ptr<LogFile> open_mat73(const fs::path& file, const LogOptions&) {
  if (!has_matio())
    throw DataError(
        fmt::format("{}: a MAT file of version 7.3 (HDF5), which this program was built without: install "
                    "libmatio-dev and build again, or save it in MATLAB with save('log.mat','-v7')",
                    shown_path(file)));
  return open_arrays(
      file, "MAT v7.3", ArrayGrouping::Structs,
      [file](ArrayVisitor& visitor, const Stop& stop) { Mat73Child(file, stop).walk(visitor); });
}

}  // namespace

LogFormat mat73_log_format() {
  return {"MAT v7.3", is_mat73, open_mat73};
}

}  // namespace odobench
