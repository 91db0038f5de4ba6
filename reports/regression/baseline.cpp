#include "reports/regression/baseline.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "base/json_node.hpp"
#include "reports/regression/metrics.hpp"
#include "reports/statistics/row_groups.hpp"

namespace odobench {
namespace {

using nlohmann::json;

// Metrics that are kept run by run, and their names in the file.
constexpr std::array<std::pair<const char*, const char*>, 3> kSamples{
    {{"J", "cost"}, {"total", "total"}, {"evaluations", "evaluations"}}};

double tolerance_from(const JsonNode& node) {
  const std::optional<double> value = node.optional_number();
  if (!value || !(*value >= 0) || std::isinf(*value)) node.fail("a tolerance >= 0");
  return *value;
}

// Fields that are absent keep the values of `fallback`; the file's own must all be there.
Tolerances tolerances_from(const JsonNode& node, const Tolerances& fallback, bool complete) {
  node.allow_only({"cost_relative", "error_m", "error_rad", "total", "evaluations_factor"});
  Tolerances result = fallback;
  const auto read = [&](const char* key, double& field) {
    if (complete || node.find(key)) field = tolerance_from(node.at(key));
  };
  read("cost_relative", result.cost_relative);
  read("error_m", result.error_m);
  read("error_rad", result.error_rad);
  read("total", result.total);
  if (complete || node.find("evaluations_factor")) {
    const JsonNode factor = node.at("evaluations_factor");
    result.evaluations_factor = factor.optional_number();
    if (result.evaluations_factor && !(*result.evaluations_factor >= 1)) factor.fail("null or a factor >= 1");
  }
  return result;
}

TrajectoryErrors errors_from(const std::string& trajectory, const JsonNode& node) {
  node.allow_only({"x", "y", "theta"});
  TrajectoryErrors errors{trajectory, {}};
  for (std::size_t v = 0; v < 3; ++v) {
    const JsonNode cells = node.at(kPoseVariables[v]);
    cells.allow_only({"e_max", "e_sr", "sigma"});
    errors.variables[v] = {cells.at("e_max").stored_number(), cells.at("e_sr").stored_number(),
                           cells.at("sigma").stored_number()};
  }
  return errors;
}

BaselineEntry entry_from(const JsonNode& node, const Tolerances& defaults) {
  node.allow_only({"problem", "dataset", "box", "label", "kind", "cost", "evaluations", "totals", "errors",
                   "samples", "tolerances"});
  BaselineEntry entry;
  entry.problem = node.at("problem").text();
  entry.dataset = node.at("dataset").text();
  entry.label = node.at("label").text();
  if (const auto box = node.find("box")) entry.box = box->text();
  entry.kind = node.at("kind").text();
  if (entry.kind != "run" && entry.kind != "evaluation" && entry.kind != "skipped")
    node.at("kind").fail("\"run\", \"evaluation\" or \"skipped\"");
  entry.cost = node.at("cost").optional_number();
  if (const auto evaluations = node.find("evaluations")) entry.evaluations = evaluations->integer();
  if (const auto totals = node.find("totals")) {
    totals->allow_only({"x", "y", "theta", "total"});
    entry.totals = Totals{{totals->at("x").stored_number(), totals->at("y").stored_number(),
                           totals->at("theta").stored_number()},
                          totals->at("total").stored_number()};
  }
  if (const auto errors = node.find("errors"))
    for (const std::string& trajectory : errors->keys())
      entry.errors.push_back(errors_from(trajectory, errors->at(trajectory)));
  if (const auto samples = node.find("samples")) {
    samples->allow_only({"cost", "evaluations", "total"});
    for (const std::string& name : samples->keys()) {
      std::vector<double>& sample = entry.samples[name];
      for (const JsonNode& value : samples->at(name).elements())
        sample.push_back(value.optional_number().value_or(std::numeric_limits<double>::infinity()));
      if (sample.empty()) samples->at(name).fail("at least one number");
    }
  }
  const auto own = node.find("tolerances");
  entry.tolerances = own ? tolerances_from(*own, defaults, false) : defaults;
  return entry;
}

bool same_place(const BaselineEntry& a, const BaselineEntry& b) {
  return a.problem == b.problem && a.dataset == b.dataset && a.label == b.label;
}

Baseline baseline_from(const JsonNode& node) {
  node.allow_only({"schema_version", "tolerances", "entries"});
  const JsonNode version = node.at("schema_version");
  if (version.integer() != kBaselineSchemaVersion) version.fail(std::to_string(kBaselineSchemaVersion));
  Baseline baseline;
  baseline.tolerances = tolerances_from(node.at("tolerances"), {}, true);
  for (const JsonNode& item : node.at("entries").elements()) {
    BaselineEntry entry = entry_from(item, baseline.tolerances);
    for (const BaselineEntry& other : baseline.entries)
      if (same_place(entry, other))
        item.fail(fmt::format("a second entry with the label \"{}\"", entry.label), "one");
    baseline.entries.push_back(std::move(entry));
  }
  if (baseline.entries.empty()) node.at("entries").fail("at least one entry");
  return baseline;
}

json tolerances_json(const Tolerances& t) {
  return {{"cost_relative", t.cost_relative},
          {"error_m", t.error_m},
          {"error_rad", t.error_rad},
          {"total", t.total},
          {"evaluations_factor", finite_or_null(t.evaluations_factor)}};
}

json changed_tolerances(const Tolerances& own, const Tolerances& file) {
  json changed = json::object();
  const json all = tolerances_json(own), defaults = tolerances_json(file);
  for (const auto& field : all.items())
    if (field.value() != defaults[field.key()]) changed[field.key()] = field.value();
  return changed;
}

// One line. Bytes that are not UTF-8 can only be in labels; they are replaced as in the records.
std::string text(const json& value) {
  return value.dump(-1, ' ', false, json::error_handler_t::replace);
}

std::string cells_text(const ErrorStatistics& e) {
  return fmt::format("{{\"e_max\": {}, \"e_sr\": {}, \"sigma\": {}}}", text(finite_or_null(e.max)),
                     text(finite_or_null(e.mean)), text(finite_or_null(e.sigma)));
}

std::string errors_text(const std::vector<TrajectoryErrors>& errors) {
  std::string out;
  for (const TrajectoryErrors& trajectory : errors) {
    out += fmt::format("{}\n        {}: {{", out.empty() ? "" : ",", text(trajectory.trajectory));
    for (std::size_t v = 0; v < 3; ++v)
      out += fmt::format("{}\n          \"{}\": {}", v == 0 ? "" : ",", kPoseVariables[v],
                         cells_text(trajectory.variables[v]));
    out += "}";
  }
  return out;
}

std::string entry_text(const BaselineEntry& e, const Tolerances& defaults) {
  std::string out = fmt::format(
      "    {{\n      \"problem\": {}, \"dataset\": {},{} \"label\": {}, \"kind\": {},", text(e.problem),
      text(e.dataset), e.box.empty() ? "" : fmt::format(" \"box\": {},", text(e.box)), text(e.label),
      text(e.kind));
  out += fmt::format("\n      \"cost\": {}", text(finite_or_null(e.cost)));
  if (e.evaluations) out += fmt::format(",\n      \"evaluations\": {}", *e.evaluations);
  if (e.totals)
    out += fmt::format(",\n      \"totals\": {{\"x\": {}, \"y\": {}, \"theta\": {}, \"total\": {}}}",
                       text(finite_or_null(e.totals->sums[0])), text(finite_or_null(e.totals->sums[1])),
                       text(finite_or_null(e.totals->sums[2])), text(finite_or_null(e.totals->total)));
  if (!e.errors.empty()) out += fmt::format(",\n      \"errors\": {{{}}}", errors_text(e.errors));
  std::string samples;
  for (const auto& [name, values] : e.samples) {
    json list = json::array();
    for (const double value : values) list.push_back(finite_or_null(value));
    samples += fmt::format("{}\n        {}: {}", samples.empty() ? "" : ",", text(name), text(list));
  }
  if (!samples.empty()) out += fmt::format(",\n      \"samples\": {{{}}}", samples);
  if (const json own = changed_tolerances(e.tolerances, defaults); !own.empty())
    out += fmt::format(",\n      \"tolerances\": {}", text(own));
  return out + "\n    }";
}

void check_tolerances(const Tolerances& t) {
  const auto need = [](const char* name, double value, double lowest) {
    if (!(value >= lowest) || std::isinf(value))
      throw std::invalid_argument(
          fmt::format("tolerance {}: found {}, expected a finite number >= {}", name, value, lowest));
  };
  need("cost_relative", t.cost_relative, 0);
  need("error_m", t.error_m, 0);
  need("error_rad", t.error_rad, 0);
  need("total", t.total, 0);
  if (t.evaluations_factor) need("evaluations_factor", *t.evaluations_factor, 1);
}

}  // namespace

Baseline read_baseline(const std::string& path) {
  Baseline baseline = baseline_from(JsonNode::read(path));
  baseline.source = path;
  return baseline;
}

Baseline make_baseline(const std::vector<RunRecord>& records, const Tolerances& tolerances) {
  if (records.empty()) throw std::invalid_argument("a baseline needs at least one run record, got 0");
  check_tolerances(tolerances);
  Baseline baseline;
  baseline.tolerances = tolerances;
  const std::vector<Comparison> groups = compare(records);
  require_unique(groups);
  for (const Comparison& comparison : groups)
    for (const ComparisonRow& row : comparison.rows) {
      BaselineEntry entry;
      entry.problem = comparison.problem;
      entry.dataset = comparison.dataset;
      entry.box = comparison.box;
      entry.label = row.label;
      entry.kind = row.kind;
      entry.cost = row.shown->cost;
      if (row.kind == "run") entry.evaluations = row.shown->evaluations;
      entry.errors = row.errors;
      std::sort(
          entry.errors.begin(), entry.errors.end(),
          [](const TrajectoryErrors& a, const TrajectoryErrors& b) { return a.trajectory < b.trajectory; });
      if (!row.errors.empty()) entry.totals = error_totals(row.errors);
      if (row.kind == "run" && row.runs.size() > 1)
        for (const Metric& metric : metrics_of(row))
          for (const auto& [name, sample] : kSamples)
            if (metric.name == name) entry.samples[sample] = metric.values;
      entry.tolerances = tolerances;
      baseline.entries.push_back(std::move(entry));
    }
  return baseline;
}

std::string to_json_text(const Baseline& baseline) {
  std::string out = fmt::format("{{\n  \"schema_version\": {},\n  \"tolerances\": {},\n  \"entries\": [",
                                kBaselineSchemaVersion, text(tolerances_json(baseline.tolerances)));
  for (std::size_t k = 0; k < baseline.entries.size(); ++k)
    out += fmt::format("{}\n{}", k == 0 ? "" : ",", entry_text(baseline.entries[k], baseline.tolerances));
  return out + "\n  ]\n}\n";
}

}  // namespace odobench
