// The folder that keeps what a study found: runs.jsonl, tracks/, parameters/, tables.txt, .md, .csv, .json
// and .tex.
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "base/files.hpp"
#include "bench/studies/watcher.hpp"
#include "reports/records/record.hpp"
#include "reports/records/tracks.hpp"
#include "reports/render/table.hpp"

namespace odobench {

// A process that is killed leaves every record it appended; no other process writes to the folder from open()
// until the object's end.
class RunFolder {
 public:
  // Touches nothing yet. `folder` "": nothing is kept, every member below does nothing. `option`: whose value
  // the folder is, for messages.
  RunFolder(std::filesystem::path folder, bool overwrite, const char* option = "--out");

  bool keeps() const { return !folder_.empty(); }
  const std::filesystem::path& path() const { return folder_; }

  // Throws std::invalid_argument when the folder holds runs, their tables or tracks already and they may not
  // be replaced, or something in their place that is no regular file: before long work.
  void require_free() const;

  // Creates the folder and its runs.jsonl; tables and tracks of earlier records are removed. Throws
  // std::invalid_argument when that is not possible, or when the file exists and may not be replaced.
  void open();
  // For runs that go on, in a folder that may be overwritten: the records that are there, without a last
  // line that a kill cut (a note says so); and open() with these as the records so far, which a kill does
  // not lose. Both throw std::invalid_argument while another process writes there.
  std::vector<RunRecord> stored(Watcher& watcher) const;
  void resume(const std::vector<RunRecord>& records);
  // After open(). Throws DataError when the disc is full or the like; a part of a line is taken back then.
  void append(const RunRecord& record);
  // Puts these in the place of all records so far.
  void replace(const std::vector<RunRecord>& records);
  // All files of it, or none. Throw DataError.
  void save(const TrackSet& tracks);
  // Tracks of calibrations and parameters/*.json together.
  using Files = std::vector<std::pair<std::filesystem::path, std::string>>;
  void save(const std::vector<TrackSet>& tracks, const Files& parameters);
  void save(const std::vector<Table>& tables);

  // Everything of a study that is through: opens, and tells the watcher before that results begin. `tracks`
  // null: none.
  void keep(const std::vector<RunRecord>& records, const std::vector<Table>& tables, Watcher& watcher,
            const TrackSet* tracks = nullptr);

 private:
  const std::filesystem::path folder_;
  const bool overwrite_;
  const char* option_;
  std::unique_ptr<LineFile> file_;
};

}  // namespace odobench
