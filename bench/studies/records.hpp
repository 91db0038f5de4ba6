// Results -> run records, and the file that keeps them.
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "base/files.hpp"
#include "bench/catalogue/problem_factory.hpp"
#include "bench/studies/cells.hpp"
#include "reports/records/record.hpp"
#include "reports/render/table.hpp"

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

// What a study says that has no cost interface of its own: label, parameters `values` of `parameters`; the
// caller adds errors, measures and series. Kind "evaluation".
RunRecord study_record(const std::string& problem, const std::string& dataset, const std::string& label,
                       const std::vector<ParameterInfo>& parameters, const Vector& values,
                       const RunContext& context);

// Throws std::invalid_argument when the folder holds runs, their tables or tracks already and they may not be
// replaced, or something in their place that is no regular file: before long work.
void require_no_records(const std::filesystem::path& folder, bool overwrite, const char* option = "--out");

// DIR/runs.jsonl (LineFile): a process that is killed leaves every record it completed, and no other process
// writes to the folder as long as the object lives.
class RecordFile {
 public:
  // Creates the folder and the file; tables and tracks of earlier records are removed. Throws
  // std::invalid_argument when that is not possible, or when the file exists and `overwrite` is not set.
  RecordFile(const std::filesystem::path& folder, bool overwrite, const char* option = "--out");

  // Throws DataError when the disc is full or the like; a part of a line is taken back then.
  void append(const RunRecord& record);
  // Puts these in the place of all so far.
  void replace(const std::vector<RunRecord>& records);

 private:
  std::unique_ptr<LineFile> file_;
};

// Records and tables of a study that is through, in a folder of their own.
void save_study(const std::filesystem::path& folder, bool overwrite, const std::vector<RunRecord>& records,
                const std::vector<Table>& tables, const char* option = "--out");

// Records of .jsonl files, or of runs.jsonl in folders, in the order given. Throws DataError when one does
// not exist or nothing is in them, std::runtime_error "file:line: ..." on a bad record.
std::vector<RunRecord> read_all_records(const std::vector<std::string>& runs);

}  // namespace odobench
