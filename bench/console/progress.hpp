// One status line on a terminal: cells done, best costs of the running solvers, evaluations, time.
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <map>
#include <mutex>
#include <string>
#include <vector>

#include "solvers/run.hpp"

namespace odobench {

class ProgressLine {
 public:
  // Draws on standard error when that is a terminal and `wanted`; else every member does nothing.
  ProgressLine(bool wanted, std::size_t cells, std::function<std::string(std::size_t)> label);
  ~ProgressLine();
  ProgressLine(const ProgressLine&) = delete;
  ProgressLine& operator=(const ProgressLine&) = delete;

  // From any thread.
  void started(std::size_t cell);
  void progressed(std::size_t cell, const Progress& progress);
  void finished(std::size_t cell);
  void clear();

 private:
  void draw(bool now);
  std::string line(std::size_t width) const;

  const bool active_;
  const std::size_t cells_;
  const std::function<std::string(std::size_t)> label_;
  const std::chrono::steady_clock::time_point begin_ = std::chrono::steady_clock::now();
  std::mutex mutex_;
  double last_ = -1;
  std::size_t done_ = 0;
  std::map<std::size_t, Progress> running_;
};

// One status line of a count, on a terminal only: "12 of 30 drives, 1.2 s".
class CountLine {
 public:
  // `total` 0: not known.
  CountLine(bool wanted, std::string unit, std::int64_t total = 0);
  ~CountLine();
  CountLine(const CountLine&) = delete;
  CountLine& operator=(const CountLine&) = delete;

  // From any thread.
  void set(std::int64_t count);
  void add_one();

 private:
  void draw();

  const bool active_;
  const std::string unit_;
  const std::int64_t total_;
  const std::chrono::steady_clock::time_point begin_ = std::chrono::steady_clock::now();
  std::mutex mutex_;
  std::int64_t count_ = 0;
  double last_ = -1;
};

// Columns of the terminal behind a file descriptor, `otherwise` when it is none.
int terminal_width(int descriptor, int otherwise);

}  // namespace odobench
