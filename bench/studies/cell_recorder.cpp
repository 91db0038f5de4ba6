#include "bench/studies/cell_recorder.hpp"

#include <utility>

namespace odobench {

CellRecorder::CellRecorder(const CellList& cells, MakeRecord make, RunFolder& folder, Watcher& watcher,
                           std::size_t first)
    : cells_(cells),
      make_(std::move(make)),
      folder_(folder),
      watcher_(watcher),
      first_(first),
      records_(cells.size()) {}

void CellRecorder::started(std::size_t cell) {
  watcher_.started(first_ + cell);
}

void CellRecorder::progressed(std::size_t cell, const Progress& progress) {
  watcher_.progressed(first_ + cell, progress);
}

void CellRecorder::finished(std::size_t cell, const Result& result, const std::string& time_utc) {
  auto record = std::make_unique<RunRecord>(make_(cells_[cell], result, time_utc));
  {
    const std::lock_guard lock(mutex_);
    folder_.append(*record);
    in_order_ = in_order_ && cell == finished_;
    ++finished_;
    records_[cell] = std::move(record);
  }
  watcher_.finished(first_ + cell);
}

void CellRecorder::keep(std::size_t cell, RunRecord record) {
  const std::lock_guard lock(mutex_);
  records_[cell] = std::make_unique<RunRecord>(std::move(record));
  ++finished_;
  in_order_ = false;
}

void CellRecorder::move_to(std::vector<RunRecord>& list) {
  list.reserve(list.size() + finished_);
  for (std::unique_ptr<RunRecord>& record : records_) {
    if (record) list.push_back(std::move(*record));
    record.reset();
  }
}

}  // namespace odobench
