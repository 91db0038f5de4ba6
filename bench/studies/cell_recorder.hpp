// Finished runs become records: on disc at once, in memory in the order of the cells.
#pragma once

#include <functional>
#include <memory>
#include <mutex>
#include <vector>

#include "bench/studies/cells.hpp"
#include "bench/studies/run_folder.hpp"
#include "bench/studies/watcher.hpp"

namespace odobench {

class CellRecorder final : public CellWatcher {
 public:
  // The record of a cell; called from several threads at a time.
  using MakeRecord =
      std::function<RunRecord(const RunCell& cell, const Result& result, const std::string& time_utc)>;

  // `folder`: open; records go there, too. `first`: number of the first cell among the runs that the watcher
  // is told of. All but `make` outlive the recorder.
  CellRecorder(const CellList& cells, MakeRecord make, RunFolder& folder, Watcher& watcher,
               std::size_t first = 0);

  void started(std::size_t cell) override;
  void progressed(std::size_t cell, const Progress& progress) override;
  // Throws what RunFolder::append() does.
  void finished(std::size_t cell, const Result& result, const std::string& time_utc) override;

  // The record of a cell that does not run, since an earlier call did; it is in the folder.
  void keep(std::size_t cell, RunRecord record);
  // Of the cells that ran or were kept, in their order, moved behind `list`.
  void move_to(std::vector<RunRecord>& list);
  // Whether the cells ended in their order, so that the file has the records as the memory has.
  bool in_order() const { return in_order_; }

 private:
  const CellList& cells_;
  const MakeRecord make_;
  RunFolder& folder_;
  Watcher& watcher_;
  const std::size_t first_;
  std::mutex mutex_;
  std::vector<std::unique_ptr<RunRecord>> records_;
  std::size_t finished_ = 0;
  bool in_order_ = true;
};

}  // namespace odobench
