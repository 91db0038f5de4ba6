// Results -> run records, and records read back.
#pragma once

#include <string>
#include <vector>

#include "bench/catalogue/problem_factory.hpp"
#include "bench/studies/cells.hpp"
#include "bench/studies/watcher.hpp"
#include "reports/records/record.hpp"

namespace odobench {

// What a run is, before it begins; `options`: every one with the value in force. Its record_key() is that of
// the record of its result.
RunRecord planned_record(const LoadedProblem& loaded, const RunCell& cell, const OptionValues& options,
                         std::uint64_t base_seed, const Budget& budget, const RunContext& context,
                         const std::string& time_utc);

// Parameters count as on a bound within 1e-6 of the width of their box.
RunRecord run_record(const LoadedProblem& loaded, const RunCell& cell, std::uint64_t base_seed,
                     const Budget& budget, const Result& result, const RunContext& context,
                     const std::string& time_utc);

// The notes of the nominal parameters and of the lowest run of each problem and data set, for the tables.
std::vector<std::string> notes_of_best(const std::vector<RunRecord>& records);

// J and error tables of given parameters (n, parameter units). Of a calibration or of any other problem.
RunRecord evaluation_record(const LoadedProblem& loaded, const std::string& label, const Vector& parameters,
                            const RunContext& context);

// J and errors of poses that no parameters give, one track per recording of a calibration in the general
// form.
RunRecord tracks_record(const LoadedProblem& loaded, const std::string& label,
                        const std::vector<PoseTrack>& tracks, const RunContext& context);

// A row that says why there is nothing: kind "skipped".
RunRecord skipped_record(const LoadedProblem& loaded, const std::string& label, const std::string& reason,
                         const RunContext& context);

// What a study says that has no cost interface of its own: label, parameters `values` of `parameters`; the
// caller adds errors, measures and series. Kind "evaluation".
RunRecord study_record(const std::string& problem, const std::string& dataset, const std::string& label,
                       const std::vector<ParameterInfo>& parameters, const Vector& values,
                       const RunContext& context);

// The best run by J of each label of a problem and data set, of those with parameters, in order of
// appearance.
std::vector<const RunRecord*> best_of_rows(const std::vector<RunRecord>& records);

// Records of .jsonl files, of runs.jsonl in folders, or of stores of campaigns, in the order given. Throws
// DataError when one does not exist or nothing is in them, std::runtime_error "file:line: ..." on a bad
// record. One that is there twice counts once, with a note.
std::vector<RunRecord> read_all_records(const std::vector<std::string>& runs, Watcher& watcher);

}  // namespace odobench
