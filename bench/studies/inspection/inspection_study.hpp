// Data sets looked at before anything is fitted to them: the study behind `bench inspect`, and what other
// verbs say of the sets that they take.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "bench/catalogue/problem_factory.hpp"
#include "bench/studies/watcher.hpp"
#include "datasets/dataset.hpp"
#include "problems/inspection/finding.hpp"
#include "reports/render/table.hpp"

namespace odobench {

struct InspectedSet {
  Dataset dataset;
  std::vector<inspection::Finding> findings;
};

// `data`: path of set.json, "" for the demo set. Throws DataError on a bad set.
InspectedSet inspect_set(const std::string& data);

// Of recordings that are not yet calibrated; nothing where the robot is none or its wheels do not tell the
// twist, which calibrations refuse. `threads` as of inspection::inspect().
std::vector<inspection::Finding> inspect_recordings(const Robot& robot, std::span<const Recording> recordings,
                                                    int threads = 0);

// "findings": severity, kind, message and remedy of each; with `all` recording, wheel and samples in columns
// of their own, and a table "figures" of finding (from 1), name and value, for programs.
std::vector<Table> findings_tables(const std::string& dataset,
                                   const std::vector<inspection::Finding>& findings, bool all);

// Kinds that --accept names; "all" is every one. Throws std::invalid_argument for an unknown one.
struct AcceptedKinds {
  bool all = false;
  std::vector<std::string> names;
  bool holds(const std::string& kind) const;
};
AcceptedKinds accepted_kinds(const std::vector<std::string>& lists);

// Warnings and errors as sentences "KIND: ...", told to the watcher, six at most. `place`: where to look for
// the others.
std::vector<std::string> told_findings(const std::vector<inspection::Finding>& findings,
                                       const std::string& place, Watcher& watcher);

// Warnings and errors about the recordings of a calibration: told to the watcher (six lines at most),
// returned as notes for records. Notes are not worth a line here, nor is the layout, about which loading
// has a remark. With `calibrates` an error that is not accepted throws DataError, which names it and the
// remedy.
std::vector<std::string> say_findings(const LoadedProblem& loaded, const AcceptedKinds& accepted,
                                      bool calibrates, int threads, Watcher& watcher);

}  // namespace odobench
