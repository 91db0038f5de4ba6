// `bench check`: what moved in stored records, without running anything.
#pragma once

#include "bench/console/exit_code.hpp"
#include "bench/verbs/command_options.hpp"
#include "reports/records/record.hpp"

namespace odobench {

// Records of .jsonl files, or of runs.jsonl in folders, in the order given. Throws DataError when one does
// not exist or nothing is in them, std::runtime_error "file:line: ..." on a bad record.
std::vector<RunRecord> read_all_records(const std::vector<std::string>& runs);

// Prints what moved against the baseline; CheckFailed when something did. With `update` writes the baseline
// instead, keeping the tolerances of the one that is there, those of single entries included.
ExitCode check_command(const CheckOptions& options);

}  // namespace odobench
