// Campaign files: what is compared on what, as JSON (docs/campaigns.md has the schema).
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "bench/catalogue/catalogue.hpp"
#include "bench/catalogue/problem_factory.hpp"
#include "solvers/options.hpp"

namespace odobench {

struct CampaignProblem {
  std::string name;  // of the catalogue
  ProblemRequest request;
  std::optional<double> target;  // cost at which a run may end
  std::string where;             // "file:line: /problems/2: ", for messages
};

struct CampaignBudget {
  std::int64_t evaluations = 0;    // 0: no limit
  std::int64_t per_parameter = 0;  // times the number of parameters; 0: as above
  double seconds = 0;              // 0: no limit
  std::string text() const;        // "1000 evaluations, 2 s"
};

struct Campaign {
  std::string name;
  std::vector<SolverSpec> solvers;   // grids are written out
  std::vector<SolverSpec> polishes;  // the name "": without
  std::vector<CampaignProblem> problems;
  std::vector<CampaignBudget> budgets;
  // How far above the lowest known cost a run counts as there, each times max(1, |that cost|), largest first.
  std::vector<double> targets;
  int repeat = 1;
  std::uint64_t seed = 1;
  bool random_start = false;
  std::vector<std::string> accept;  // kinds of findings that do not stop a calibration
  std::string definition;           // the file's text
};

// Data sets are looked for beside the file. Notes: problems that a pattern left out, solvers listed twice.
// Throws DataError "FILE:LINE: /place: found ..., expected ..." on unknown keys, solvers, options and
// problems (with the nearest name), on lists without an entry and numbers out of range.
Campaign read_campaign(const std::filesystem::path& file, const Catalogue& catalogue, InstructionSet kernel,
                       std::vector<std::string>& notes);

}  // namespace odobench
