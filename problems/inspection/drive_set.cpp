#include "problems/inspection/drive_set.hpp"

#include <algorithm>
#include <thread>

#include "base/parallel.hpp"

namespace odobench::inspection {

DriveSet::DriveSet(const RobotView& robot, std::span<const Recording> recordings,
                   std::function<void(std::size_t, Drive&)> first, int threads, std::size_t kept_samples)
    : robot_(robot), first_(std::move(first)), threads_(threads) {
  std::size_t samples = 0;
  for (const Recording& r : recordings) {
    members_.push_back(Member{&r, members_.size(), Drive()});
    samples += r.size();
  }
  keeps_ = samples <= kept_samples;
  if (!keeps_) return;
  parallel_for(members_.size(), threads_, [&](std::size_t i) { members_[i].drive = made(members_[i]); });
}

Drive DriveSet::made(const Member& member) const {
  Drive drive = drive_view(robot_, *member.recording);
  first_(member.number, drive);
  for (const auto& change : changes_) change(drive);
  return drive;
}

void DriveSet::correct(const std::function<void(Drive&)>& change) {
  if (keeps_)
    parallel_for(members_.size(), threads_, [&](std::size_t i) { change(members_[i].drive); });
  else
    changes_.push_back(change);
}

void DriveSet::visit(const std::function<void(std::size_t, const Drive&)>& look) const {
  const std::size_t hardware = std::max(1U, std::thread::hardware_concurrency());
  const std::size_t chunk = keeps_ ? 1 : threads_ > 0 ? static_cast<std::size_t>(threads_) : hardware;
  std::vector<Drive> drives(keeps_ ? 0 : chunk);
  for (std::size_t begin = 0; begin < members_.size(); begin += chunk) {
    const std::size_t count = std::min(chunk, members_.size() - begin);
    if (!keeps_) parallel_for(count, threads_, [&](std::size_t k) { drives[k] = made(members_[begin + k]); });
    for (std::size_t k = 0; k < count; ++k) look(begin + k, keeps_ ? members_[begin + k].drive : drives[k]);
  }
}

void DriveSet::visit_parallel(const std::function<void(std::size_t, const Drive&)>& look) const {
  parallel_for(members_.size(), threads_, [&](std::size_t i) {
    if (keeps_)
      look(i, members_[i].drive);
    else
      look(i, made(members_[i]));
  });
}

double DriveSet::first_step() const {
  return keeps_ ? members_.front().drive.step : made(members_.front()).step;
}

void DriveSet::only(const std::vector<char>& chosen) {
  std::vector<Member> kept;
  for (Member& member : members_)
    if (chosen[member.number] != 0) kept.push_back(std::move(member));
  members_ = std::move(kept);
}

}  // namespace odobench::inspection
