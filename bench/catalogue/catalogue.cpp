#include "bench/catalogue/catalogue.hpp"

#include <fmt/format.h>
#include <fnmatch.h>

#include <algorithm>
#include <stdexcept>
#include <utility>

#include "base/names.hpp"
#include "bench/catalogue/option_values.hpp"

namespace odobench {
namespace {

ProblemEntry calibration_entry() {
  ProblemEntry entry;
  entry.about.name = entry.about.family = "calibration";
  entry.about.dimension = kCalibrationParameters;
  entry.about.dimensions = DimensionRule::exactly(kCalibrationParameters);
  entry.takes_data = true;
  entry.derivatives = "residuals, Jacobian, normal equations";
  entry.make = [](const ProblemRequest& request) {
    if (request.dimension != 0)
      throw std::invalid_argument("--dimension: the calibration problem has the dimension of its robot");
    return load_calibration(request.data, request.kernel, request.calibration);
  };
  return entry;
}

bool takes(const ProblemEntry& entry, int dimension) {
  return dimension == 0 || (!entry.takes_data && entry.about.dimensions.allows(dimension));
}

}  // namespace

ProblemEntry problem_entry(ClassicEntry about, std::function<Problem(int dimension)> make) {
  ProblemEntry entry;
  entry.make = [usual = about.dimension, make = std::move(make)](const ProblemRequest& request) {
    const bool same = request.dimension == 0 || request.dimension == usual;
    return LoadedProblem{make(request.dimension),
                         nullptr,
                         std::nullopt,
                         "",
                         "",
                         same ? "" : fmt::format("[n={}]", request.dimension)};
  };
  entry.about = std::move(about);
  return entry;
}

void Catalogue::add(SolverEntry entry) {
  solvers_.add(std::move(entry));
}

void Catalogue::Problems::add(ProblemEntry entry) {
  if (!places.emplace(entry.about.name, entries.size()).second)
    throw std::logic_error(fmt::format("problem '{}' is added twice", entry.about.name));
  entries.push_back(std::move(entry));
}

void Catalogue::add(ImporterEntry entry) {
  for (const ImporterEntry& other : importers_)
    if (other.name == entry.name)
      throw std::logic_error(fmt::format("importer '{}' is added twice", entry.name));
  importers_.push_back(std::move(entry));
}

Catalogue::Problems& Catalogue::complete() const {
  const std::lock_guard lock(mutex_);
  const auto later = std::exchange(problems_.later, {});
  for (const auto& entries : later)
    for (ProblemEntry& entry : entries()) problems_.add(std::move(entry));
  return problems_;
}

void Catalogue::add(ProblemEntry entry) {
  complete().add(std::move(entry));
}

void Catalogue::add_later(std::function<std::vector<ProblemEntry>()> entries) {
  problems_.later.push_back(std::move(entries));
}

const std::vector<ProblemEntry>& Catalogue::problems() const {
  return complete().entries;
}

const ProblemEntry& Catalogue::problem(const std::string& name) const {
  const Problems& all = complete();
  if (const auto place = all.places.find(name); place != all.places.end()) return all.entries[place->second];
  std::vector<std::string> names;
  for (const ProblemEntry& entry : all.entries) names.push_back(entry.about.name);
  throw std::invalid_argument(fmt::format("unknown problem '{}'{}; 'bench list problems' shows all", name,
                                          did_you_mean(name, names)));
}

const ImporterEntry& Catalogue::importer(const std::string& name) const {
  std::vector<std::string> names;
  for (const ImporterEntry& entry : importers_) {
    if (entry.name == name) return entry;
    names.push_back(entry.name);
  }
  throw std::invalid_argument(fmt::format("bench import '{}'{}: known sources: {}", name,
                                          did_you_mean(name, names), fmt::join(names, ", ")));
}

void add_known(Catalogue& catalogue) {
  add_known_solvers(catalogue.solvers_);
  for (const ImporterEntry& importer : known_importers()) catalogue.add(importer);
  catalogue.add(calibration_entry());
  catalogue.add_later([] {
    std::vector<ProblemEntry> list;
    for (const ClassicEntry& about : classic_catalogue())
      list.push_back(problem_entry(
          about, [name = about.name](int dimension) { return make_classic_problem(name, dimension); }));
    return list;
  });
}

std::vector<std::string> resolve_problems(const Catalogue& catalogue, const std::vector<std::string>& lists,
                                          int dimension, std::vector<std::string>& notes) {
  std::vector<std::string> chosen;
  const auto take = [&](const std::string& name) {
    if (std::find(chosen.begin(), chosen.end(), name) == chosen.end()) chosen.push_back(name);
  };
  for (const std::string& item : comma_items(lists)) {
    if (item.find_first_of("*?[") == std::string::npos) {
      take(catalogue.problem(item).about.name);
      continue;
    }
    int met = 0, left_out = 0;
    for (const ProblemEntry& entry : catalogue.problems()) {
      if (::fnmatch(item.c_str(), entry.about.name.c_str(), 0) != 0) continue;
      ++met;
      if (takes(entry, dimension))
        take(entry.about.name);
      else
        ++left_out;
    }
    if (met == left_out)
      throw std::invalid_argument(
          fmt::format("--problem: no problem is called '{}'{}; 'bench list problems' shows all", item,
                      met == 0 ? "" : fmt::format(" and takes dimension {}", dimension)));
    if (left_out > 0)
      notes.push_back(fmt::format("{}: {} of {} problems do not take dimension {} and are left out", item,
                                  left_out, met, dimension));
  }
  return chosen;
}

}  // namespace odobench
