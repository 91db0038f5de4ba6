// Names of problems as users type them: a name or a pattern, and what is chosen of it in brackets.
//
//   bbob:f1[n=5,instance=3]        one problem
//   bbob:*[n=5,instance=1..15]     fifteen of every one that the pattern meets
//
// A bracket with '=' holds options; any other belongs to a pattern of the shell ("mgh:*[!0]").
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "problems/classic/classic_problems.hpp"

namespace odobench {

struct ProblemName {
  std::string base;  // name or pattern
  std::optional<int> dimension;
  std::optional<int> instance, last_instance;  // first and last; the same for one

  bool plain() const { return !dimension && !instance; }
  // "[n=5,instance=3]" of the options that are set (the first instance); "" for none.
  std::string options() const;
};

// Items of comma lists; commas between brackets that hold options separate none.
std::vector<std::string> problem_items(const std::vector<std::string>& lists);

// Throws std::invalid_argument "--problem: 'bbob:f1[m=5]': unknown option 'm', expected n or instance" and
// the like.
ProblemName parse_problem_name(const std::string& text);

// The options in force for a problem, as its name carries them: those that are not the usual ones.
std::string problem_variant(const ClassicEntry& about, int dimension, int instance);

}  // namespace odobench
