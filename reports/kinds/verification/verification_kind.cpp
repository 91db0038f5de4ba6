#include "reports/kinds/verification/verification_kind.hpp"

#include <algorithm>
#include <utility>

#include "reports/kinds/verification/verification_tables.hpp"

namespace odobench {
namespace {

// Among the errors, which the calibrations' tables show.
void add_verification_page(const KindInput& input, Section&, Document& document) {
  const auto errors = std::find_if(document.sections.begin(), document.sections.end(),
                                   [](const Section& section) { return section.id == "errors"; });
  std::vector<Table> tables = arrival_tables(input.records);
  if (errors != document.sections.end()) {
    append(std::move(tables), *errors);
    return;
  }
  Section section{"arrival", "Arrival", "Where the robot really stopped.", {}};
  append(std::move(tables), section);
  finish(std::move(section), document);
}

}  // namespace

RecordKind verification_kind() {
  return {"verification",
          "a parameter set on new drives that it steers: errors, and where the robot really stopped",
          [](std::string_view problem) { return problem == kVerificationProblem; },
          "calibration",
          [](const KindInput& input) { return arrival_tables(input.records); },
          add_verification_page,
          nullptr};
}

}  // namespace odobench
