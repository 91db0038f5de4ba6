#include "reports/records/record.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

#include "base/files.hpp"
#include "base/json_node.hpp"
#include "reports/records/json_view.hpp"

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

ParameterValue parameter_from(const JsonView& view) {
  ParameterValue p;
  p.name = view.at("name").string();
  p.unit = view.at("unit").string();
  p.value = view.at("value").number();
  p.nominal = view.at("nominal").number();
  p.lower = view.at("lower").number();
  p.upper = view.at("upper").number();
  p.at_bound = view.at("at_bound").string();
  if (!p.at_bound.empty() && p.at_bound != "lower" && p.at_bound != "upper")
    throw std::runtime_error(fmt::format("{}/at_bound: expected \"\", \"lower\" or \"upper\", found \"{}\"",
                                         view.path(), p.at_bound));
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

RecordingError error_from(const JsonView& view) {
  RecordingError e;
  e.recording = view.at("recording").string();
  e.trajectory = view.at("trajectory").string();
  e.repetition = view.at("repetition").small_integer();
  e.max_error = {view.at("x").number(), view.at("y").number(), view.at("theta").number()};
  return e;
}

json to_json(const TracePoint& point) {
  return {{"evaluations", point.evaluations},
          {"seconds", finite_or_null(point.seconds)},
          {"cost", finite_or_null(point.cost)}};
}

TracePoint trace_point_from(const JsonView& view) {
  return {view.at("evaluations").count(), view.at("seconds").number(), view.at("cost").number()};
}

json to_json(const OptimalityRecord& c) {
  return {{"test", c.test},
          {"value", finite_or_null(c.value)},
          {"limit", finite_or_null(c.limit)},
          {"evaluations", c.evaluations}};
}

OptimalityRecord check_from(const JsonView& view) {
  return {view.at("test").string(), view.at("value").number(), view.at("limit").number(),
          view.at("evaluations").count()};
}

json to_json(const KnownAnswer& k) {
  return {{"cost", finite_or_null(k.cost)},
          {"digits", finite_or_null(k.digits)},
          {"solved", k.solved},
          {"promise_by_differences", finite_or_null(k.promise)}};
}

KnownAnswer known_from(const JsonView& view) {
  return {view.at("cost").number(), view.at("digits").optional_number(), view.at("solved").boolean(),
          view.at("promise_by_differences").optional_number()};
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

RunContext context_from(const JsonView& view) {
  RunContext c;
  c.cpu = view.at("cpu").string();
  c.compiler = view.at("compiler").string();
  c.build_type = view.at("build_type").string();
  c.git_revision = view.at("git_revision").string();
  c.version = view.at("version").string();
  c.threads = view.at("threads").small_integer();
  if (const auto command = view.find("command")) c.command = command->string();
  if (const auto libraries = view.find("libraries")) c.libraries = libraries->string();
  if (const auto kernel = view.find("kernel")) c.kernel = kernel->string();
  return c;
}

template <class T>
json list_of(const std::vector<T>& items) {
  json list = json::array();
  for (const T& item : items) list.push_back(to_json(item));
  return list;
}

void read_identity(const JsonView& view, RunRecord& r) {
  r.problem = view.at("problem").string();
  r.dataset = view.at("dataset").string();
  r.dataset_sha256 = view.at("dataset_sha256").string();
  r.label = view.at("label").string();
  r.kind = view.at("kind").string();
  if (r.kind != "run" && r.kind != "evaluation" && r.kind != "skipped")
    throw std::runtime_error(
        fmt::format("/kind: expected \"run\", \"evaluation\" or \"skipped\", found \"{}\"", r.kind));
  r.solver = view.at("solver").string();
  view.at("options").each_field(
      [&](const std::string& key, const JsonView& value) { r.options[key] = value.string(); });
  r.polish = view.at("polish").string();
  r.seed = view.at("seed").unsigned_integer();
  r.base_seed = view.at("base_seed").unsigned_integer();
  r.repetition = view.at("repetition").small_integer();
  r.start = view.at("start").string();
  if (const auto box = view.find("box")) r.box = box->string();
  if (const auto random = view.find("random")) r.random = random->boolean();
  if (const auto budget = view.find("budget"))
    budget->each_field(
        [&](const std::string& key, const JsonView& value) { r.budget[key] = value.number(); });
}

void read_outcome(const JsonView& view, RunRecord& r) {
  r.termination = view.at("termination").string();
  r.message = view.at("message").string();
  if (const auto check = view.find("check")) r.check = check_from(*check);
  if (const auto known = view.find("known")) r.known = known_from(*known);
  r.cost = view.at("cost").optional_number();
  r.cost_before_polish = view.at("cost_before_polish").optional_number();
  view.at("parameters").each_item([&](const JsonView& item) {
    r.parameters.push_back(parameter_from(item));
  });
  view.at("errors").each_item([&](const JsonView& item) { r.errors.push_back(error_from(item)); });
  r.evaluations = view.at("evaluations").count();
  r.cost_evaluations = view.at("cost_evaluations").count();
  r.derivative_evaluations = view.at("derivative_evaluations").count();
  r.non_finite = view.at("non_finite").count();
  r.iterations = view.at("iterations").count();
  r.seconds = view.at("seconds").number();
  view.at("trace").each_item([&](const JsonView& item) { r.trace.push_back(trace_point_from(item)); });
  if (const auto notes = view.find("notes"))  // absent in records of other makers: none
    notes->each_item([&](const JsonView& item) { r.notes.push_back(item.string()); });
  if (const auto group = view.find("group")) r.group = group->string();
  if (const auto statistics = view.find("statistics"))
    statistics->each_field(
        [&](const std::string& key, const JsonView& value) { r.statistics[key] = value.number(); });
  if (const auto series = view.find("series"))
    series->each_field([&](const std::string& key, const JsonView& list) {
      list.each_item([&](const JsonView& value) { r.series[key].push_back(value.number()); });
    });
  r.context = context_from(view.at("context"));
  r.time_utc = view.at("time_utc").string();
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
  for (const auto& [key, value] : r.statistics) out["statistics"][key] = finite_or_null(value);
  for (const auto& [key, values] : r.series) {
    json list = json::array();
    for (const double value : values) list.push_back(finite_or_null(value));
    out["series"][key] = std::move(list);
  }
  return out;
}

RunRecord record_from_json(const json& document) {
  const JsonView view(document);
  const JsonView version = view.at("schema_version");
  if (version.integer() != kRecordSchemaVersion)
    throw std::runtime_error(
        fmt::format("/schema_version: expected {}, found {}: written by another version of this program",
                    kRecordSchemaVersion, version.integer()));
  RunRecord record;
  read_identity(view, record);
  read_outcome(view, record);
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
  const std::string text = read_file(path, kLargestRecords);
  std::vector<RunRecord> records;
  std::size_t begin = 0;
  for (int line_number = 1; begin < text.size(); ++line_number) {
    const std::size_t newline = text.find('\n', begin);
    const bool ended = newline != std::string::npos;
    const std::size_t end = ended ? newline : text.size();
    const std::string line = text.substr(begin, end - begin);
    begin = end + 1;
    if (line.find_first_not_of(" \t\r") == std::string::npos) continue;
    try {
      records.push_back(record_from_json(json::parse(line)));
    } catch (const json::parse_error& error) {
      if (!ended && error.byte > line.size())
        throw std::runtime_error(
            fmt::format("{}:{}: truncated record: the file ends after {} characters of the line, without its "
                        "closing brace",
                        path, line_number, line.size()));
      throw std::runtime_error(
          fmt::format("{}:{}: column {}: {}", path, line_number, error.byte, complaint(error)));
    } catch (const json::out_of_range&) {
      parse_json(line, path, static_cast<std::size_t>(line_number));  // says which number
      throw;
    } catch (const json::exception& error) {
      throw std::runtime_error(fmt::format("{}:{}: {}", path, line_number, complaint(error)));
    } catch (const std::runtime_error& error) {
      throw std::runtime_error(fmt::format("{}:{}: {}", path, line_number, error.what()));
    }
  }
  return records;
}

}  // namespace odobench
