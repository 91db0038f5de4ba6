// What a page is made of: records, their tracks, and what is missing.
#pragma once

#include <string>
#include <vector>

#include "reports/page/report_document.hpp"
#include "reports/records/record.hpp"

namespace odobench {

// `runs`: the folders or files that the records were read from. Throws DataError on tracks that cannot be
// read.
ReportInput report_input(const std::vector<std::string>& runs, const std::vector<RunRecord>& records,
                         const std::string& title);

}  // namespace odobench
