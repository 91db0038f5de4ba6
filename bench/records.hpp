// Results -> run records, and the file that keeps them.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "bench/cells.hpp"
#include "bench/problem_factory.hpp"
#include "reports/record.hpp"

namespace odobench {

// Parameters count as on a bound within 1e-6 of the width of their box.
RunRecord run_record(const LoadedProblem& loaded, const RunCell& cell, std::uint64_t base_seed,
                     const Budget& budget, const Result& result, const RunContext& context,
                     const std::string& time_utc);

// The notes of the lowest run of each problem and data set, for the tables.
std::vector<std::string> notes_of_best(const std::vector<RunRecord>& records);

// J and error tables of given parameters (n, parameter units). Of a calibration or of any other problem.
RunRecord evaluation_record(const LoadedProblem& loaded, const std::string& label, const Vector& parameters,
                            const RunContext& context);

// Throws std::invalid_argument when the folder holds runs already and they may not be replaced: before long work.
void require_no_records(const std::filesystem::path& folder, bool overwrite);

// DIR/runs.jsonl, appended to record by record: each is one write of a whole line, so that a process that is
// killed leaves every record it completed.
class RecordFile {
 public:
  // Creates the folder and the file. Throws std::invalid_argument when that is not possible, or when the file
  // exists and `overwrite` is not set.
  RecordFile(const std::filesystem::path& folder, bool overwrite);
  ~RecordFile();
  RecordFile(const RecordFile&) = delete;
  RecordFile& operator=(const RecordFile&) = delete;

  const std::filesystem::path& path() const { return path_; }
  // Throws std::runtime_error when the disc is full or the like; a part of a line is taken back then.
  void append(const RunRecord& record);

 private:
  std::filesystem::path path_;
  int file_ = -1;
};

}  // namespace odobench
