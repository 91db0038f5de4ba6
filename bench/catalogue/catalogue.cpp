#include "bench/catalogue/catalogue.hpp"

#include <fmt/format.h>
#include <fnmatch.h>

#include <algorithm>
#include <stdexcept>
#include <utility>

#include "base/names.hpp"
#include "bench/catalogue/problem_names.hpp"
#include "problems/suites/bbob.hpp"
#include "problems/suites/more_wild.hpp"
#include "problems/suites/robot_problems.hpp"

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

// What `name` chooses of it, in force for every request.
ProblemEntry chosen_entry(const ProblemEntry& of, const ProblemName& name, const std::string& text) {
  if (of.takes_data)
    throw std::invalid_argument(
        fmt::format("--problem: '{}': the {} problem takes no options here", text, of.about.name));
  if (name.dimension && !of.about.dimensions.allows(*name.dimension))
    throw std::invalid_argument(fmt::format("problem '{}': dimension {}; expected {}", of.about.name,
                                            *name.dimension, of.about.dimensions.text()));
  if (name.instance && of.about.instances == 0)
    throw std::invalid_argument(fmt::format("--problem: '{}': the problem has no numbered instances", text));
  if (name.instance && (*name.last_instance != *name.instance || *name.instance > of.about.instances))
    throw std::invalid_argument(
        fmt::format("--problem: '{}': expected one instance in 1..{}", text, of.about.instances));
  ProblemEntry entry = of;
  entry.about.name += name.options();
  if (name.dimension) {
    entry.about.dimension = *name.dimension;
    entry.about.dimensions = DimensionRule::exactly(*name.dimension);
  }
  entry.make = [make = of.make, name](ProblemRequest request) {
    if (name.dimension) request.dimension = *name.dimension;
    if (name.instance) request.instance = *name.instance;
    return make(request);
  };
  return entry;
}

bool is_pattern(const std::string& text) {
  return text.find_first_of("*?[") != std::string::npos;
}

// The instances of a name as texts of options: one each, or "" for none chosen.
std::vector<std::string> option_texts(const ProblemName& name) {
  if (!name.instance) return {name.options()};
  std::vector<std::string> texts;
  ProblemName one = name;
  for (int k = *name.instance; k <= *name.last_instance; ++k) {
    one.instance = one.last_instance = k;
    texts.push_back(one.options());
  }
  return texts;
}

}  // namespace

ProblemEntry instance_entry(ClassicEntry about, std::function<Problem(const ProblemRequest&)> make) {
  ProblemEntry entry;
  entry.make = [about, make = std::move(make)](const ProblemRequest& request) {
    ProblemRequest asked = request;
    if (asked.dimension == 0) asked.dimension = about.dimension;
    if (!about.dimensions.allows(asked.dimension))
      throw std::invalid_argument(fmt::format("problem '{}': dimension {}; expected {}", about.name,
                                              asked.dimension, about.dimensions.text()));
    asked.instance = std::max(1, asked.instance);
    return LoadedProblem{make(asked), nullptr, std::nullopt,
                         "",          "",      problem_variant(about, asked.dimension, asked.instance)};
  };
  entry.about = std::move(about);
  return entry;
}

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
  Problems& all = complete();
  if (const auto place = all.places.find(name); place != all.places.end()) return all.entries[place->second];
  if (const ProblemName parts = parse_problem_name(name); !parts.plain()) {
    const ProblemEntry entry = chosen_entry(problem(parts.base), parts, name);
    const std::lock_guard lock(mutex_);
    return all.chosen.emplace(entry.about.name, entry).first->second;
  }
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

namespace {

// The suites of problems/suites.
std::vector<ProblemEntry> suite_entries() {
  std::vector<ProblemEntry> list;
  for (const ClassicEntry& about : bbob_entries())
    list.push_back(instance_entry(about, [name = about.name](const ProblemRequest& request) {
      return make_bbob_problem(name, request.dimension, request.instance);
    }));
  for (const ClassicEntry& about : more_wild_entries())
    list.push_back(instance_entry(
        about, [name = about.name](const ProblemRequest&) { return make_more_wild_problem(name); }));
  for (const ClassicEntry& about : robot_problem_entries()) {
    list.push_back(instance_entry(about, [name = about.name](const ProblemRequest& request) {
      return make_robot_problem(name, request.instance, request.kernel);
    }));
    list.back().derivatives = "residuals, Jacobian, normal equations";
  }
  return list;
}

}  // namespace

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
  catalogue.add_later(suite_entries);
}

std::vector<std::string> resolve_problems(const Catalogue& catalogue, const std::vector<std::string>& lists,
                                          int dimension, std::vector<std::string>& notes) {
  std::vector<std::string> chosen;
  const auto take = [&](const std::string& name) {
    if (std::find(chosen.begin(), chosen.end(), name) == chosen.end()) chosen.push_back(name);
  };
  for (const std::string& item : problem_items(lists)) {
    const ProblemName name = parse_problem_name(item);
    const std::vector<std::string> options = option_texts(name);
    if (!is_pattern(name.base)) {
      for (const std::string& text : options) take(catalogue.problem(name.base + text).about.name);
      continue;
    }
    const int wanted = name.dimension.value_or(dimension);
    int met = 0, left_out = 0;
    for (const ProblemEntry& entry : catalogue.problems()) {
      if (::fnmatch(name.base.c_str(), entry.about.name.c_str(), 0) != 0) continue;
      ++met;
      if (takes(entry, wanted) && (!name.instance || entry.about.instances > 0))
        for (const std::string& text : options) take(catalogue.problem(entry.about.name + text).about.name);
      else
        ++left_out;
    }
    if (met == left_out)
      throw std::invalid_argument(
          fmt::format("--problem: no problem is called '{}'{}; 'bench list problems' shows all", item,
                      met == 0                        ? ""
                      : wanted != 0 && !name.instance ? fmt::format(" and takes dimension {}", wanted)
                                                      : " and takes these options"));
    if (left_out > 0)
      notes.push_back(wanted != 0 && !name.instance
                          ? fmt::format("{}: {} of {} problems do not take dimension {} and are left out",
                                        item, left_out, met, wanted)
                          : fmt::format("{}: {} of {} problems do not take these options and are left out",
                                        item, left_out, met));
  }
  return chosen;
}

}  // namespace odobench
