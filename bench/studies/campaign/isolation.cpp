#include "bench/studies/campaign/isolation.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <stdexcept>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

#include "base/error.hpp"
#include "base/text.hpp"
#include "bench/catalogue/number_text.hpp"
#include "bench/catalogue/option_values.hpp"

namespace odobench {
namespace {

using Clock = std::chrono::steady_clock;

constexpr int kLook_ms = 50;  // between two looks at the stop
enum class Answer : char { Result = 'R', Stopped = 'S', Failed = 'F' };

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr bool kLimitsMemory = false;  // sanitizers map terabytes
#else
constexpr bool kLimitsMemory = true;
#endif

bool send_all(int descriptor, std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t n = ::write(descriptor, bytes.data(), bytes.size());
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) return false;
    bytes.remove_prefix(static_cast<std::size_t>(n));
  }
  return true;
}

// Blocking; false at the end of the stream.
bool receive_all(int descriptor, char* bytes, std::size_t size) {
  for (std::size_t got = 0; got < size;) {
    const ssize_t n = ::read(descriptor, bytes + got, size - got);
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) return false;
    got += static_cast<std::size_t>(n);
  }
  return true;
}

std::string message_of(Answer answer, std::string_view bytes) {
  const std::uint64_t size = bytes.size();
  std::string message(1 + sizeof size, static_cast<char>(answer));
  std::memcpy(message.data() + 1, &size, sizeof size);
  return message.append(bytes);
}

struct Child {
  pid_t process = -1;
  int ask = -1, tell = -1;  // pipes: numbers of pieces to it, messages from it
  bool busy = false;
  std::size_t piece = 0;
  Clock::time_point begin;
  std::string received;
};

std::string answer_to(IsolatedWork& work, std::size_t piece) {
  try {
    const std::optional<std::string> bytes = work.run(piece);
    return bytes ? message_of(Answer::Result, *bytes) : message_of(Answer::Stopped, "");
  } catch (const std::bad_alloc&) {
    return message_of(Answer::Failed, "no memory is left");
  } catch (const std::exception& e) {
    return message_of(Answer::Failed, e.what());
  }
}

// The life of a child; never returns, and nothing of the caller's process is put away.
[[noreturn]] void live(int ask, int tell, pid_t parent, const IsolationLimits& limits, IsolatedWork& work) {
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (::getppid() != parent) ::_exit(0);
  for (const int signal : {SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT}) {  // the caller tells, in one line
    struct sigaction usual = {};
    usual.sa_handler = SIG_DFL;
    ::sigemptyset(&usual.sa_mask);
    ::sigaction(signal, &usual, nullptr);
  }
  std::set_terminate([] { std::abort(); });
  const rlimit no_core{0, 0};
  ::setrlimit(RLIMIT_CORE, &no_core);
  // Files and locks of the caller are not the child's.
  const int low = std::min(ask, tell), high = std::max(ask, tell);
  ::close_range(3, static_cast<unsigned>(low) - 1, 0);
  ::close_range(static_cast<unsigned>(low) + 1, static_cast<unsigned>(high) - 1, 0);
  ::close_range(static_cast<unsigned>(high) + 1, ~0U, 0);
  if (kLimitsMemory && limits.memory > 0) {
    const rlimit memory{limits.memory, limits.memory};
    ::setrlimit(RLIMIT_AS, &memory);
  }
  std::uint64_t piece = 0;
  while (receive_all(ask, reinterpret_cast<char*>(&piece), sizeof piece))
    if (!send_all(tell, answer_to(work, piece))) break;
  ::_exit(0);
}

class Nursery {
 public:
  Nursery(std::size_t count, int processes, const IsolationLimits& limits, IsolatedWork& work)
      : count_(count), limits_(limits), work_(work) {
    children_.resize(std::min(count, static_cast<std::size_t>(std::max(processes, 1))));
  }
  ~Nursery() {
    for (Child& child : children_) bury(child, SIGKILL);
  }
  Nursery(const Nursery&) = delete;
  Nursery& operator=(const Nursery&) = delete;

  void run(const Stop& stop) {
    while (!stop.requested()) {
      for (Child& child : children_)
        if (!child.busy && next_ < count_) give(child);
      if (next_ >= count_ && idle()) return;
      listen();
      for (Child& child : children_)
        if (child.busy && limits_.seconds > 0 && seconds_of(child) > limits_.seconds) {
          bury(child, SIGKILL);
          fail(child, fmt::format("took longer than {:g} s and was ended", limits_.seconds));
        }
      for (Child& child : children_)  // they work while the results are kept
        if (!child.busy && next_ < count_ && !stop.requested()) give(child);
      if (std::exchange(settled_, false)) work_.settled();
    }
  }

 private:
  bool idle() const {
    for (const Child& child : children_)
      if (child.busy) return false;
    return true;
  }
  static double seconds_of(const Child& child) {
    return std::chrono::duration<double>(Clock::now() - child.begin).count();
  }

  void bear(Child& child) {
    std::array<int, 2> ask{-1, -1}, tell{-1, -1};
    const bool piped = ::pipe2(ask.data(), O_CLOEXEC) == 0 && ::pipe2(tell.data(), O_CLOEXEC) == 0;
    const pid_t parent = ::getpid();
    const pid_t process = piped ? ::fork() : -1;
    if (process == 0) live(ask[0], tell[1], parent, limits_, work_);
    const int reason = errno;
    for (const int descriptor : {ask[0], tell[1]})
      if (descriptor >= 0) ::close(descriptor);
    child = {process, ask[1], tell[0], false, 0, {}, {}};
    if (process < 0) {
      bury(child, 0);
      throw DataError(fmt::format("--isolate: no child process can be made: {}",
                                  std::error_code(reason, std::generic_category()).message()));
    }
  }

  // The wait status of its end; -1 where there was none.
  static int bury(Child& child, int signal) {
    int status = -1;
    if (child.process > 0) {
      if (signal != 0) ::kill(child.process, signal);
      while (::waitpid(child.process, &status, 0) < 0 && errno == EINTR) {
      }
    }
    for (int* const descriptor : {&child.ask, &child.tell}) {
      if (*descriptor >= 0) ::close(*descriptor);
      *descriptor = -1;
    }
    child.process = -1;
    child.busy = false;
    child.received.clear();
    return status;
  }

  void give(Child& child) {
    if (child.process < 0) bear(child);
    const std::uint64_t piece = next_;
    if (!send_all(child.ask, {reinterpret_cast<const char*>(&piece), sizeof piece})) {
      bury(child, SIGKILL);  // it was ended while it had nothing to do: another one takes the piece
      return;
    }
    child.busy = true;
    child.piece = next_++;
    child.begin = Clock::now();
    work_.started(child.piece);
  }

  void listen() {
    std::vector<pollfd> wait;
    for (const Child& child : children_) wait.push_back({child.busy ? child.tell : -1, POLLIN, 0});
    if (::poll(wait.data(), wait.size(), kLook_ms) <= 0) return;
    for (std::size_t i = 0; i < children_.size(); ++i)
      if (children_[i].busy && wait[i].revents != 0) hear(children_[i]);
  }

  void hear(Child& child) {
    std::array<char, 1 << 16> bytes;
    const ssize_t n = ::read(child.tell, bytes.data(), bytes.size());
    if (n < 0 && errno == EINTR) return;
    if (n <= 0) {
      const int status = bury(child, 0);
      fail(child, reason_of(status));
      return;
    }
    child.received.append(bytes.data(), static_cast<std::size_t>(n));
    std::uint64_t size = 0;
    if (child.received.size() < 1 + sizeof size) return;
    std::memcpy(&size, child.received.data() + 1, sizeof size);
    if (child.received.size() < 1 + sizeof size + size) return;
    const std::string message = std::exchange(child.received, {});
    const std::string body = message.substr(1 + sizeof size);
    child.busy = false;
    if (message[0] == static_cast<char>(Answer::Failed)) fail(child, body);
    if (message[0] != static_cast<char>(Answer::Result)) return;
    work_.finished(child.piece, body);
    settled_ = true;
  }

  void fail(const Child& child, const std::string& reason) {
    work_.failed(child.piece, reason);
    settled_ = true;
  }

  static std::string reason_of(int status) {
    if (WIFSIGNALED(status))
      return fmt::format("its process was ended by signal {} ({})", WTERMSIG(status),
                         ::strsignal(WTERMSIG(status)));
    return fmt::format("its process ended with exit code {} and no result",
                       WIFEXITED(status) ? WEXITSTATUS(status) : -1);
  }

  const std::size_t count_;
  const IsolationLimits limits_;
  IsolatedWork& work_;
  std::vector<Child> children_;
  std::size_t next_ = 0;
  bool settled_ = false;
};

// A pipe to a child that has ended gives an error instead of a signal while one lives.
class NoPipeSignal {
 public:
  NoPipeSignal() {
    struct sigaction ignore = {};
    ignore.sa_handler = SIG_IGN;
    ::sigemptyset(&ignore.sa_mask);
    ::sigaction(SIGPIPE, &ignore, &before_);
  }
  ~NoPipeSignal() { ::sigaction(SIGPIPE, &before_, nullptr); }
  NoPipeSignal(const NoPipeSignal&) = delete;
  NoPipeSignal& operator=(const NoPipeSignal&) = delete;

 private:
  struct sigaction before_ = {};
};

std::uint64_t memory_size(const std::string& option, const std::string& text) {
  static constexpr std::string_view kUnits = "KMG";
  std::string number = text;
  double unit = 1;
  if (const auto at = kUnits.find(number.empty() ? '?' : number.back()); at != std::string_view::npos) {
    for (std::size_t k = 0; k <= at; ++k) unit *= 1024;
    number.pop_back();
  }
  constexpr double least = 64.0 * (1 << 20), most = 1e15;
  const double bytes = unit * finite_number(option, number, true);
  if (bytes < least || bytes > most)
    throw std::invalid_argument(fmt::format("{}={}: expected 64M or more, such as 2G", option, shown(text)));
  return static_cast<std::uint64_t>(bytes);
}

}  // namespace

IsolationLimits parse_isolation(const std::string& option, const std::string& text) {
  IsolationLimits limits;
  if (text.empty()) return limits;
  for (const std::string& item : comma_items(text)) {
    const auto equals = item.find('=');
    const std::string key = equals == std::string::npos ? "time" : item.substr(0, equals);
    const std::string value = equals == std::string::npos ? item : item.substr(equals + 1);
    if (key == "time")
      limits.seconds = finite_number(option + " time", value, true);
    else if (key == "memory")
      limits.memory = memory_size(option + " memory", value);
    else
      throw std::invalid_argument(
          fmt::format("{}: found '{}', expected time=SECONDS and memory=SIZE, such as time=60,memory=2G",
                      option, shown(item)));
  }
  return limits;
}

void run_isolated(std::size_t count, int processes, const IsolationLimits& limits, const Stop& stop,
                  IsolatedWork& work) {
  const NoPipeSignal quiet;
  Nursery(count, processes, limits, work).run(stop);
}

}  // namespace odobench
