#include "reports/records/record.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <string_view>

#include "base/files.hpp"
#include "base/json_node.hpp"
#include "reports/records/schema_1.hpp"

namespace odobench {
namespace {

using nlohmann::json;

json to_json(const ParameterValue& p) {
  return {{"name", p.name},
          {"unit", p.unit},
          {"value", finite_or_null(p.value)},
          {"nominal", finite_or_null(p.nominal)},
          {"lower", finite_or_null(p.lower)},
          {"upper", finite_or_null(p.upper)},
          {"at_bound", p.at_bound}};
}

ParameterValue parameter_from(const JsonNode& node) {
  ParameterValue p;
  p.name = node.at("name").text();
  p.unit = node.at("unit").text();
  p.value = node.at("value").stored_number();
  p.nominal = node.at("nominal").stored_number();
  p.lower = node.at("lower").stored_number();
  p.upper = node.at("upper").stored_number();
  p.at_bound = node.at("at_bound").text();
  if (!p.at_bound.empty() && p.at_bound != "lower" && p.at_bound != "upper")
    node.at("at_bound").fail("\"\", \"lower\" or \"upper\"");
  return p;
}

json to_json(const RecordingError& e) {
  return {{"recording", e.recording},
          {"trajectory", e.trajectory},
          {"repetition", e.repetition},
          {"x", finite_or_null(e.max_error[0])},
          {"y", finite_or_null(e.max_error[1])},
          {"theta", finite_or_null(e.max_error[2])}};
}

RecordingError error_from(const JsonNode& node) {
  RecordingError e;
  e.recording = node.at("recording").text();
  e.trajectory = node.at("trajectory").text();
  e.repetition = node.at("repetition").small_integer();
  e.max_error = {node.at("x").stored_number(), node.at("y").stored_number(),
                 node.at("theta").stored_number()};
  return e;
}

json to_json(const TracePoint& point) {
  return {{"evaluations", point.evaluations},
          {"seconds", finite_or_null(point.seconds)},
          {"cost", finite_or_null(point.cost)}};
}

TracePoint trace_point_from(const JsonNode& node) {
  return {node.at("evaluations").count(), node.at("seconds").stored_number(),
          node.at("cost").stored_number()};
}

json to_json(const OptimalityRecord& c) {
  return {{"test", c.test},
          {"value", finite_or_null(c.value)},
          {"limit", finite_or_null(c.limit)},
          {"evaluations", c.evaluations}};
}

OptimalityRecord check_from(const JsonNode& node) {
  return {node.at("test").text(), node.at("value").stored_number(), node.at("limit").stored_number(),
          node.at("evaluations").count()};
}

json to_json(const KnownAnswer& k) {
  return {{"cost", finite_or_null(k.cost)},
          {"digits", finite_or_null(k.digits)},
          {"solved", k.solved},
          {"promise_by_differences", finite_or_null(k.promise)}};
}

KnownAnswer known_from(const JsonNode& node) {
  return {node.at("cost").stored_number(), node.at("digits").optional_number(), node.at("solved").boolean(),
          node.at("promise_by_differences").optional_number()};
}

json to_json(const RunContext& c) {
  return {{"cpu", c.cpu},
          {"compiler", c.compiler},
          {"build_type", c.build_type},
          {"git_revision", c.git_revision},
          {"version", c.version},
          {"threads", c.threads},
          {"command", c.command},
          {"libraries", c.libraries},
          {"kernel", c.kernel}};
}

RunContext context_from(const JsonNode& node) {
  RunContext c;
  c.cpu = node.at("cpu").text();
  c.compiler = node.at("compiler").text();
  c.build_type = node.at("build_type").text();
  c.git_revision = node.at("git_revision").text();
  c.version = node.at("version").text();
  c.threads = node.at("threads").small_integer();
  if (const auto command = node.find("command")) c.command = command->text();
  if (const auto libraries = node.find("libraries")) c.libraries = libraries->text();
  if (const auto kernel = node.find("kernel")) c.kernel = kernel->text();
  return c;
}

template <class T>
json list_of(const std::vector<T>& items) {
  json list = json::array();
  for (const T& item : items) list.push_back(to_json(item));
  return list;
}

void read_identity(const JsonNode& node, RunRecord& r) {
  r.problem = node.at("problem").text();
  r.dataset = node.at("dataset").text();
  r.dataset_sha256 = node.at("dataset_sha256").text();
  r.label = node.at("label").text();
  r.kind = node.at("kind").text();
  if (r.kind != "run" && r.kind != "evaluation" && r.kind != "skipped")
    node.at("kind").fail("\"run\", \"evaluation\" or \"skipped\"");
  r.solver = node.at("solver").text();
  const JsonNode options = node.at("options");
  for (const std::string& key : options.keys()) r.options[key] = options.at(key).text();
  r.polish = node.at("polish").text();
  r.seed = node.at("seed").unsigned_integer();
  r.base_seed = node.at("base_seed").unsigned_integer();
  r.repetition = node.at("repetition").small_integer();
  r.start = node.at("start").text();
  if (const auto box = node.find("box")) r.box = box->text();
  if (const auto random = node.find("random")) r.random = random->boolean();
  if (const auto budget = node.find("budget"))
    for (const std::string& key : budget->keys()) r.budget[key] = budget->at(key).stored_number();
}

void read_measures(const JsonNode& node, Measures& measures) {
  if (node.at("schema_version").integer() > 1) {
    if (const auto list = node.find("measures")) measures = measures_from(*list);
  } else if (const auto statistics = node.find("statistics")) {
    for (const std::string& name : statistics->keys())
      measures.put(schema_1_measure(name, statistics->at(name).stored_number()));
  }
}

// Of a calibration; a plan has standard deviations that are some.
void rename_old_series(RunRecord& r) {
  const auto old = r.series.find("standard_deviations");
  if (old == r.series.end() || r.series.count("residual_deviation") == 0) return;
  r.series.emplace("sd_if_samples_were_independent", std::move(old->second));
  r.series.erase(old);
}

void read_outcome(const JsonNode& node, RunRecord& r) {
  r.termination = node.at("termination").text();
  r.message = node.at("message").text();
  if (const auto check = node.find("check")) r.check = check_from(*check);
  if (const auto known = node.find("known")) r.known = known_from(*known);
  r.cost = node.at("cost").optional_number();
  r.cost_before_polish = node.at("cost_before_polish").optional_number();
  for (const JsonNode& item : node.at("parameters").elements()) r.parameters.push_back(parameter_from(item));
  for (const JsonNode& item : node.at("errors").elements()) r.errors.push_back(error_from(item));
  r.evaluations = node.at("evaluations").count();
  r.cost_evaluations = node.at("cost_evaluations").count();
  r.derivative_evaluations = node.at("derivative_evaluations").count();
  r.non_finite = node.at("non_finite").count();
  r.iterations = node.at("iterations").count();
  r.seconds = node.at("seconds").stored_number();
  for (const JsonNode& item : node.at("trace").elements()) r.trace.push_back(trace_point_from(item));
  if (const auto notes = node.find("notes"))  // absent in records of other makers: none
    for (const JsonNode& item : notes->elements()) r.notes.push_back(item.text());
  if (const auto group = node.find("group")) r.group = group->text();
  read_measures(node, r.measures);
  if (const auto series = node.find("series"))
    for (const std::string& key : series->keys()) r.series[key] = series->at(key).stored_numbers();
  rename_old_series(r);
  if (const auto trust = node.find("trust")) r.trust = trust_from(*trust);
  r.context = context_from(node.at("context"));
  r.time_utc = node.at("time_utc").text();
}

}  // namespace

json to_json(const RunRecord& r) {
  json out{{"schema_version", kRecordSchemaVersion},
           {"problem", r.problem},
           {"dataset", r.dataset},
           {"dataset_sha256", r.dataset_sha256},
           {"label", r.label},
           {"kind", r.kind},
           {"solver", r.solver},
           {"options", json::object()},
           {"polish", r.polish},
           {"seed", r.seed},
           {"base_seed", r.base_seed},
           {"repetition", r.repetition},
           {"start", r.start},
           {"termination", r.termination},
           {"message", r.message},
           {"cost", finite_or_null(r.cost)},
           {"cost_before_polish", finite_or_null(r.cost_before_polish)},
           {"parameters", list_of(r.parameters)},
           {"errors", list_of(r.errors)},
           {"evaluations", r.evaluations},
           {"cost_evaluations", r.cost_evaluations},
           {"derivative_evaluations", r.derivative_evaluations},
           {"non_finite", r.non_finite},
           {"iterations", r.iterations},
           {"seconds", finite_or_null(r.seconds)},
           {"trace", list_of(r.trace)},
           {"notes", r.notes},
           {"context", to_json(r.context)},
           {"time_utc", r.time_utc}};
  for (const auto& [key, value] : r.options) out["options"][key] = value;
  if (!r.box.empty()) out["box"] = r.box;
  if (r.random) out["random"] = *r.random;
  if (r.known) out["known"] = to_json(*r.known);
  if (r.check) out["check"] = to_json(*r.check);
  if (!r.group.empty()) out["group"] = r.group;
  for (const auto& [key, value] : r.budget) out["budget"][key] = finite_or_null(value);
  if (r.trust) out["trust"] = to_json(*r.trust);
  if (!r.measures.empty()) out["measures"] = to_json(r.measures);
  for (const auto& [key, values] : r.series) {
    json list = json::array();
    for (const double value : values) list.push_back(finite_or_null(value));
    out["series"][key] = std::move(list);
  }
  return out;
}

RunRecord record_from(const JsonNode& node) {
  const JsonNode version = node.at("schema_version");
  if (version.integer() < 1 || version.integer() > kRecordSchemaVersion)
    version.fail(
        fmt::format("1 to {}: it was written by another version of this program", kRecordSchemaVersion));
  RunRecord record;
  read_identity(node, record);
  read_outcome(node, record);
  return record;
}

bool false_verdict(const RunRecord& r) {
  if (r.termination != "converged" || !r.known || !r.known->promise) return false;
  return *r.known->promise > std::max(1e-6, r.check ? 10 * r.check->limit : 0.0);
}

std::string to_json_line(const RunRecord& record) {
  // Bytes that are not UTF-8 (a file name on the command line) must not cost the user a finished run.
  return to_json(record).dump(-1, ' ', false, json::error_handler_t::replace);
}

// Lines of a few kB to MB each, read whole.
constexpr std::uintmax_t kLargestRecords = std::uintmax_t{1} << 33;

std::vector<RunRecord> read_records(const std::string& path) {
  const std::string content = read_file(path, kLargestRecords);
  const std::string_view text = content;
  std::vector<RunRecord> records;
  std::size_t begin = 0;
  for (std::size_t line_number = 1; begin < text.size(); ++line_number) {
    const std::size_t newline = text.find('\n', begin);
    const bool ended = newline != std::string_view::npos;
    const std::string_view line = text.substr(begin, ended ? newline - begin : newline);
    begin += line.size() + 1;
    if (line.find_first_not_of(" \t\r") == std::string_view::npos) continue;
    try {
      records.push_back(record_from(JsonNode::parse_line(line, path, line_number)));
    } catch (const JsonEndsEarly&) {
      if (ended) throw;
      throw DataError(
          fmt::format("{}:{}: truncated record: the file ends after {} characters of the line, without its "
                      "closing brace",
                      path, line_number, line.size()));
    }
  }
  return records;
}

}  // namespace odobench
