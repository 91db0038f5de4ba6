// Everything that has a name on the command line, behind one door: made once when the program starts and
// handed down to whoever looks a name up.
#pragma once

#include <functional>
#include <map>
#include <mutex>
#include <string>
#include <vector>

#include "bench/catalogue/importers.hpp"
#include "bench/catalogue/problem_factory.hpp"
#include "problems/classic/classic_problems.hpp"
#include "solvers/registry.hpp"

namespace odobench {

struct ProblemRequest {
  int dimension = 0;  // 0: the usual one
  std::string data;   // path of a data set; "": the problem's own
  CalibrationChoice calibration;
  InstructionSet kernel = InstructionSet::Baseline;
  int instance = 0;  // of those that have numbered ones; 0: the first
};

struct ProblemEntry {
  ClassicEntry about;       // the family is that of the table of `bench list problems`
  bool takes_data = false;  // and then no dimension
  std::string derivatives;  // in words, for lists; "": the problem is made and asked
  // Throws std::invalid_argument on a dimension that the problem does not take, DataError on a bad set.
  std::function<LoadedProblem(const ProblemRequest&)> make;
};

// Of a problem without data. `make` gets the dimension, 0 for the usual one, or the whole request with
// dimension and instance as they are in force.
ProblemEntry problem_entry(ClassicEntry about, std::function<Problem(int dimension)> make);
ProblemEntry instance_entry(ClassicEntry about, std::function<Problem(const ProblemRequest&)> make);

class Catalogue {
 public:
  Catalogue() = default;
  Catalogue(const Catalogue&) = delete;  // entries may refer to it
  Catalogue& operator=(const Catalogue&) = delete;

  // Throw std::logic_error when there is one of this name.
  void add(SolverEntry entry);
  void add(ProblemEntry entry);
  void add(ImporterEntry entry);

  // Problems that take time to list: asked for when problems are looked at first, or one is added.
  void add_later(std::function<std::vector<ProblemEntry>()> entries);

  // In the order in which they were added, which is that of lists. From any thread.
  const SolverTable& solvers() const { return solvers_; }
  const std::vector<ProblemEntry>& problems() const;
  const std::vector<ImporterEntry>& importers() const { return importers_; }

  // Throw std::invalid_argument on an unknown name, with the nearest one. A problem's name may choose:
  // "bbob:f1[n=5,instance=3]" is bbob:f1 whose `make` has them in force whatever it is asked.
  const SolverEntry& solver(const std::string& name) const { return solvers_.find(name); }
  const ProblemEntry& problem(const std::string& name) const;
  const ImporterEntry& importer(const std::string& name) const;

 private:
  friend void add_known(Catalogue& catalogue);
  struct Problems {
    std::vector<std::function<std::vector<ProblemEntry>()>> later;
    std::vector<ProblemEntry> entries;
    std::map<std::string, std::size_t> places;
    std::map<std::string, ProblemEntry> chosen;  // by name with options, made when it is first asked for
    void add(ProblemEntry entry);
  };
  Problems& complete() const;  // nothing is left for later

  SolverTable solvers_;
  std::vector<ImporterEntry> importers_;
  mutable std::mutex mutex_;
  mutable Problems problems_;
};

// What comes with the program.
void add_known(Catalogue& catalogue);

// The values of --problem as names: comma lists of names and shell patterns ("nist:*", "mgh:*[!0]",
// "bbob:*[n=5,instance=1..5]", problem_names.hpp), each name once. A pattern leaves out problems that do
// not take `dimension` (0: the usual one), with a line in `notes`. Throws std::invalid_argument on an
// empty item, an unknown name or a pattern that meets nothing.
std::vector<std::string> resolve_problems(const Catalogue& catalogue, const std::vector<std::string>& lists,
                                          int dimension, std::vector<std::string>& notes);

}  // namespace odobench
