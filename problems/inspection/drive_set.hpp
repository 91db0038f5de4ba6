// The drives of a set while they are looked at. Small sets are kept in memory; of larger ones a drive is made
// from its recording when it is its turn, with all corrections so far, and dropped again: the same numbers to
// the bit, in memory that does not depend on how many there are.
#pragma once

#include <functional>
#include <span>
#include <vector>

#include "problems/inspection/drive_view.hpp"

namespace odobench::inspection {

inline constexpr double kInches = 1 / 0.0254;  // of a metre

// Samples of a set that is kept: some 300 bytes each.
inline constexpr std::size_t kKeptSamples = 1'000'000;

class DriveSet {
 public:
  // `first` makes a drive what it is before any correction; those with `dense` false are left out later, by
  // only(). `threads` as of inspect().
  DriveSet(const RobotView& robot, std::span<const Recording> recordings,
           std::function<void(std::size_t, Drive&)> first, int threads,
           std::size_t kept_samples = kKeptSamples);

  std::size_t size() const { return members_.size(); }
  const Recording& recording(std::size_t i) const { return *members_[i].recording; }
  bool keeps() const { return keeps_; }

  // Changes every drive, now or whenever it is made: of its own drive only, and nothing else.
  void correct(const std::function<void(Drive&)>& change);
  // In their order, one after the other. What `look` changes in its drive is forgotten.
  void visit(const std::function<void(std::size_t, const Drive&)>& look) const;
  // The same on all threads.
  void visit_parallel(const std::function<void(std::size_t, const Drive&)>& look) const;
  double first_step() const;  // T of the first drive
  // Those for which `chosen` holds, by their number.
  void only(const std::vector<char>& chosen);

 private:
  struct Member {
    const Recording* recording;
    std::size_t number;  // in the span
    Drive drive;         // where kept
  };
  Drive made(const Member& member) const;

  const RobotView& robot_;
  std::function<void(std::size_t, Drive&)> first_;
  const int threads_;
  bool keeps_;
  std::vector<Member> members_;
  std::vector<std::function<void(Drive&)>> changes_;
};

}  // namespace odobench::inspection
