#include "bench/studies/campaign/campaign_file.hpp"

#include <fmt/format.h>
#include <glob.h>

#include <algorithm>
#include <array>
#include <functional>
#include <stdexcept>

#include "base/files.hpp"
#include "base/json_line.hpp"
#include "base/json_node.hpp"
#include "base/names.hpp"
#include "base/text.hpp"
#include "bench/catalogue/option_values.hpp"

namespace odobench {
namespace fs = std::filesystem;
namespace {

constexpr std::uintmax_t kLargestCampaign = 1 << 20;  // bytes
constexpr std::size_t kLargestGrid = 10'000;          // solvers
constexpr int kMostRepeats = 100'000;

std::string place_of(const JsonNode& node) {
  return fmt::format("{}: {}", shown_path(node.file()), node.path().empty() ? "/" : shown(node.path()));
}

// What the catalogue refuses, with the place in the file.
template <class Call>
auto at_place(const JsonNode& node, const Call& call) {
  try {
    return call();
  } catch (const std::invalid_argument& e) {
    std::string what = e.what();
    if (what.rfind("--", 0) == 0) what.erase(0, what.find(": ") + 2);  // an option of the command line
    throw DataError(fmt::format("{}: {}", place_of(node), what));
  }
}

// A text, or a number or boolean as it would be typed.
std::string scalar(const JsonNode& node) {
  const std::array<std::function<std::string()>, 4> kinds{
      [&] { return node.text(); }, [&] { return std::to_string(node.integer()); },
      [&] { return fmt::format("{}", node.number()); },
      [&] { return std::string(node.boolean() ? "true" : "false"); }};
  for (const auto& read : kinds) try {
      return read();
    } catch (const DataError&) {  // it is another kind
    }
  node.fail("a text, a number, true or false");
}

// "FILE: /place: ..." of a JsonNode, with the line behind the file.
std::string with_line(const std::string& message, const fs::path& file, const std::string& text) {
  const std::string begin = shown_path(file) + ": ";
  const auto end = message.find(": ", begin.size());
  if (message.rfind(begin + "/", 0) != 0 || end == std::string::npos) return message;
  std::string place = message.substr(begin.size(), end - begin.size());
  if (place == "/") place.clear();
  return fmt::format("{}:{}: {}", shown_path(file), json_line(text, place), message.substr(begin.size()));
}

// One or several: a value that is no list counts as a list of it.
std::vector<JsonNode> entries_of(const JsonNode& node, const char* what) {
  if (!node.is_array()) return {node};
  std::vector<JsonNode> entries = node.elements();
  if (entries.empty()) node.fail("an empty list", fmt::format("at least one {}", what));
  return entries;
}

void allow(const JsonNode& node, const std::vector<std::string>& known) {
  for (const std::string& key : node.keys())
    if (std::find(known.begin(), known.end(), key) == known.end())
      node.at(key).fail(fmt::format("unknown key \"{}\"{}", shown(key), did_you_mean(key, known)),
                        fmt::format("one of {}", fmt::join(known, ", ")));
}

// {"name": "pso", "options": {"swarm": [20, 40], "variant": ["thesis", "modern"]}}: every combination, the
// last option changing fastest.
std::vector<SolverSpec> grid_of(const JsonNode& node) {
  allow(node, {"name", "options"});
  std::vector<SolverSpec> grid{{node.at("name").text(), {}}};
  const auto options = node.find("options");
  if (!options) return grid;
  for (const std::string& option : options->keys()) {
    std::vector<SolverSpec> wider;
    for (const SolverSpec& spec : grid)
      for (const JsonNode& value : entries_of(options->at(option), "value")) {
        wider.push_back(spec);
        wider.back().options[option] = scalar(value);
        if (wider.size() > kLargestGrid)
          options->fail("a grid of more solvers", fmt::format("at most {}", kLargestGrid));
      }
    grid = std::move(wider);
  }
  return grid;
}

class Reader {
 public:
  Reader(const JsonNode& root, const fs::path& folder, const Catalogue& catalogue, InstructionSet kernel,
         std::vector<std::string>& notes)
      : root_(root), folder_(folder), catalogue_(catalogue), kernel_(kernel), notes_(notes) {}

  Campaign read() {
    allow(root_, {"schema_version", "name", "description", "solvers", "polish", "problems", "budgets",
                  "targets", "repeat", "seed", "start", "accept"});
    if (const JsonNode version = root_.at("schema_version"); version.integer() != 1)
      version.fail("1: it was written for another version of this program");
    campaign_.name = root_.at("name").text();
    if (campaign_.name.empty()) root_.at("name").fail("a name");
    root_.text_or_empty("description");
    read_solvers();
    read_polish();
    read_problems();
    read_budgets();
    read_numbers();
    if (const auto accept = root_.find("accept"))
      for (const JsonNode& kind : entries_of(*accept, "kind")) campaign_.accept.push_back(kind.text());
    return std::move(campaign_);
  }

 private:
  // Throws unless there is such a solver and it takes these options.
  void require(const JsonNode& node, const SolverSpec& spec) const {
    at_place(node, [&] { catalogue_.solver(spec.name).make(spec.options, nullptr); });
  }

  void take_solver(const JsonNode& node, const SolverSpec& spec) {
    require(node, spec);
    for (const SolverSpec& other : campaign_.solvers)
      if (other.text() == spec.text()) {
        notes_.push_back(fmt::format("solver '{}' is listed more than once and runs once", spec.text()));
        return;
      }
    campaign_.solvers.push_back(spec);
  }

  void read_solvers() {
    const JsonNode list = root_.at("solvers");
    for (const JsonNode& node : entries_of(list, "solver")) {
      if (node.is_object()) {
        for (const SolverSpec& spec : grid_of(node)) take_solver(node, spec);
        continue;
      }
      const std::string text = node.text();
      for (const SolverSpec& spec : at_place(node, [&] { return parse_solver_list(text); })) {
        if (spec.name == "all" && spec.options.empty())
          for (const SolverEntry& entry : catalogue_.solvers().entries()) take_solver(node, {entry.name, {}});
        else
          take_solver(node, spec);
      }
    }
  }

  // "lm", or a list in which "none" is without.
  void read_polish() {
    const auto polish = root_.find("polish");
    if (!polish) campaign_.polishes.emplace_back();
    if (!polish) return;
    for (const JsonNode& node : entries_of(*polish, "solver or \"none\"")) {
      const std::string text = node.text();
      if (text == "none") {
        campaign_.polishes.emplace_back();
        continue;
      }
      const std::vector<SolverSpec> specs = at_place(node, [&] { return parse_solver_list(text); });
      if (specs.size() != 1) node.fail("one solver");
      require(node, specs.front());
      campaign_.polishes.push_back(specs.front());
    }
  }

  void read_problems() {
    for (const JsonNode& node : entries_of(root_.at("problems"), "problem")) {
      if (!node.is_object()) {
        add_problems(node, node.text(), {}, {});
        continue;
      }
      allow(node, {"name", "dimension", "target", "data", "cost", "integration", "twist", "weights",
                   "distance", "mount"});
      std::optional<double> target;
      if (const auto value = node.find("target")) target = value->number();
      if (const auto data = node.find("data")) {
        ProblemRequest request;
        request.calibration = calibration_of(node);
        for (const std::string& set : sets_of(*data)) {
          request.data = set;
          add_problems(node, node.has("name") ? node.at("name").text() : "calibration", request, target);
        }
        continue;
      }
      add_dimensions(node, target);
    }
  }

  void add_dimensions(const JsonNode& node, std::optional<double> target) {
    ProblemRequest request;
    request.calibration = calibration_of(node);
    const std::string name = node.at("name").text();
    if (!node.has("dimension")) {
      add_problems(node, name, request, target);
      return;
    }
    for (const JsonNode& dimension : entries_of(node.at("dimension"), "dimension")) {
      request.dimension = dimension.small_integer();
      if (request.dimension < 1 || request.dimension > 1000) dimension.fail("1 to 1000");
      add_problems(node, name, request, target);
    }
  }

  void add_problems(const JsonNode& node, const std::string& names, ProblemRequest request,
                    std::optional<double> target) {
    request.kernel = kernel_;
    const auto resolve = [&] { return resolve_problems(catalogue_, {names}, request.dimension, notes_); };
    for (const std::string& name : at_place(node, resolve)) {
      if (!request.data.empty() && !catalogue_.problem(name).takes_data)
        node.at("data").fail(fmt::format("a data set of the problem '{}'", name), "none: it takes no data");
      campaign_.problems.push_back({name, request, target, place_of(node)});
    }
  }

  // A file, or the files of a pattern in the order of their names.
  std::vector<std::string> sets_of(const JsonNode& data) const {
    const fs::path named = data.text();
    const std::string path = (named.is_absolute() ? named : folder_ / named).string();
    if (path.find_first_of("*?[") == std::string::npos) return {path};
    ::glob_t found = {};
    std::vector<std::string> sets;
    if (::glob(path.c_str(), 0, nullptr, &found) == 0)
      for (std::size_t i = 0; i < found.gl_pathc; ++i) sets.emplace_back(found.gl_pathv[i]);
    ::globfree(&found);
    if (sets.empty()) data.fail("a pattern that some file has");
    return sets;
  }

  CalibrationChoice calibration_of(const JsonNode& node) const {
    CalibrationChoice choice;
    const auto word = [&](const char* key, const std::function<void(const std::string&)>& set) {
      if (const auto value = node.find(key)) at_place(*value, [&] { set(value->text()); });
    };
    const auto above_zero = [](const JsonNode& value) {
      if (!(value.number() > 0)) value.fail("a number above 0");
      return value.number();
    };
    word("cost", [&](const std::string& text) { choice.cost = cost_kind(text); });
    word("integration", [&](const std::string& text) { choice.rule = robots::integration_rule(text); });
    word("twist", [&](const std::string& text) { choice.twist = twist_rule(text); });
    if (const auto weights = node.find("weights")) {
      const std::vector<JsonNode> both = weights->elements();
      if (both.size() != 2) weights->fail("two numbers above 0, position and heading");
      choice.position_weight = above_zero(both[0]);
      choice.heading_weight = above_zero(both[1]);
    }
    if (const auto distance = node.find("distance")) choice.distance = above_zero(*distance);
    if (const auto mount = node.find("mount")) choice.mount = mount->boolean();
    return choice;
  }

  void read_budgets() {
    const auto budgets = root_.find("budgets");
    if (!budgets) campaign_.budgets.push_back({kDefaultMaxEvaluations, 0, 0});
    if (!budgets) return;
    for (const JsonNode& node : entries_of(*budgets, "budget")) {
      allow(node, {"evaluations", "evaluations_per_parameter", "seconds"});
      CampaignBudget budget;
      const auto whole = [&node](const char* key, std::int64_t& value) {
        const auto found = node.find(key);
        if (!found) return;
        value = found->integer();
        if (value < 1 || value > 1'000'000'000'000) found->fail("1 to 1e12");
      };
      whole("evaluations", budget.evaluations);
      whole("evaluations_per_parameter", budget.per_parameter);
      if (budget.evaluations > 0 && budget.per_parameter > 0)
        node.fail("evaluations and evaluations_per_parameter", "one of them");
      if (const auto seconds = node.find("seconds")) {
        budget.seconds = seconds->number();
        if (!(budget.seconds > 0)) seconds->fail("a number above 0");
      }
      if (budget.evaluations == 0 && budget.per_parameter == 0) budget.evaluations = kDefaultMaxEvaluations;
      campaign_.budgets.push_back(budget);
    }
  }

  void read_numbers() {
    if (const auto repeat = root_.find("repeat")) {
      campaign_.repeat = repeat->small_integer();
      if (campaign_.repeat < 1 || campaign_.repeat > kMostRepeats)
        repeat->fail(fmt::format("1 to {}", kMostRepeats));
    }
    if (const auto seed = root_.find("seed")) campaign_.seed = seed->unsigned_integer();
    if (const auto start = root_.find("start")) {
      if (start->text() != "nominal" && start->text() != "random") start->fail("\"nominal\" or \"random\"");
      campaign_.random_start = start->text() == "random";
    }
    if (const auto targets = root_.find("targets"))
      for (const JsonNode& node : entries_of(*targets, "number above 0")) {
        campaign_.targets.push_back(node.number());
        if (!(campaign_.targets.back() > 0)) node.fail("a number above 0");
      }
    std::sort(campaign_.targets.begin(), campaign_.targets.end(), std::greater<>());
  }

  const JsonNode& root_;
  const fs::path folder_;
  const Catalogue& catalogue_;
  const InstructionSet kernel_;
  std::vector<std::string>& notes_;
  Campaign campaign_;
};

}  // namespace

std::string CampaignBudget::text() const {
  std::string text = per_parameter > 0 ? fmt::format("{} evaluations per parameter", per_parameter)
                                       : fmt::format("{} evaluations", evaluations);
  return seconds > 0 ? fmt::format("{}, {} s", text, seconds) : text;
}

Campaign read_campaign(const fs::path& file, const Catalogue& catalogue, InstructionSet kernel,
                       std::vector<std::string>& notes) {
  const std::string text = read_file(file, kLargestCampaign);
  const JsonNode root = JsonNode::parse(text, file);
  try {
    Campaign campaign = Reader(root, file.parent_path(), catalogue, kernel, notes).read();
    campaign.definition = text;
    for (CampaignProblem& problem : campaign.problems)
      problem.where = with_line(problem.where + ": ", file, text);
    return campaign;
  } catch (const DataError& e) {
    throw DataError(with_line(e.what(), file, text));
  }
}

}  // namespace odobench
