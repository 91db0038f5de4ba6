#include "bench/console/progress.hpp"

#include <fmt/format.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <cmath>
#include <cstdio>

namespace odobench {

int terminal_width(int descriptor, int otherwise) {
  winsize size = {};
  if (::isatty(descriptor) != 1 || ::ioctl(descriptor, TIOCGWINSZ, &size) != 0 || size.ws_col == 0)
    return otherwise;
  return size.ws_col;
}

ProgressLine::ProgressLine(bool wanted, std::size_t cells, std::function<std::string(std::size_t)> label)
    : active_(wanted && ::isatty(STDERR_FILENO) == 1), cells_(cells), label_(std::move(label)) {}

ProgressLine::~ProgressLine() {
  clear();
}

void ProgressLine::started(std::size_t cell) {
  const std::lock_guard lock(mutex_);
  running_[cell] = {};
  draw(false);
}

void ProgressLine::progressed(std::size_t cell, const Progress& progress) {
  const std::lock_guard lock(mutex_);
  running_[cell] = progress;
  draw(false);
}

void ProgressLine::finished(std::size_t cell) {
  const std::lock_guard lock(mutex_);
  running_.erase(cell);
  ++done_;
  draw(true);
}

void ProgressLine::clear() {
  if (active_ && last_ >= 0) std::fputs("\r\x1b[K", stderr);
  last_ = -1;
}

void ProgressLine::draw(bool now) {
  if (!active_) return;
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin_).count();
  if (!now && last_ >= 0 && seconds - last_ < 0.1) return;
  last_ = seconds;
  const int width = terminal_width(STDERR_FILENO, 80);
  const std::string text = "\r\x1b[K" + line(static_cast<std::size_t>(std::max(width - 1, 20)));
  std::fwrite(text.data(), 1, text.size(), stderr);
  std::fflush(stderr);
}

std::string ProgressLine::line(std::size_t width) const {
  std::string text = fmt::format("[{}/{}] {:.1f} s", done_, cells_, last_);
  constexpr double worth_an_estimate_s = 5;
  if (done_ > 0 && done_ < cells_ && last_ > worth_an_estimate_s)
    text += fmt::format(", about {:.0f} s left",
                        last_ / static_cast<double>(done_) * static_cast<double>(cells_ - done_));
  for (const auto& [cell, progress] : running_) {
    std::string part = "  " + label_(cell);
    if (std::isfinite(progress.best_cost))
      part += fmt::format(" J {:.8g}, {} evaluations", progress.best_cost, progress.evaluations);
    if (text.size() + part.size() > width) break;
    text += part;
  }
  return text;
}

CountLine::CountLine(bool wanted, std::string unit, std::int64_t total)
    : active_(wanted && ::isatty(STDERR_FILENO) == 1), unit_(std::move(unit)), total_(total) {}

CountLine::~CountLine() {
  if (last_ >= 0) std::fputs("\r\x1b[K", stderr);
}

void CountLine::set(std::int64_t count) {
  if (!active_) return;
  const std::lock_guard lock(mutex_);
  count_ = count;
  draw();
}

void CountLine::add_one() {
  if (!active_) return;
  const std::lock_guard lock(mutex_);
  ++count_;
  draw();
}

void CountLine::draw() {
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin_).count();
  if (seconds - last_ < 0.1) return;
  last_ = seconds;
  const std::string of = total_ > 0 ? fmt::format(" of {}", total_) : "";
  std::fputs(fmt::format("\r\x1b[K{}{} {}, {:.1f} s", count_, of, unit_, seconds).c_str(), stderr);
}

}  // namespace odobench
