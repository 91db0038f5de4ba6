#include "reports/records/record_key.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "base/sha256.hpp"

namespace odobench {
namespace {

using nlohmann::json;

// With its length, so that two texts side by side are not two others.
void add(std::string& all, std::string_view text) {
  fmt::format_to(std::back_inserter(all), "{}:{}\n", text.size(), text);
}

}  // namespace

std::string record_key(const RunRecord& r) {
  if (r.solver.empty()) return result_check_sum(r);
  std::string all;
  all.reserve(1024);
  for (const std::string* text :
       {&r.problem, &r.box, &r.dataset, &r.dataset_sha256, &r.label, &r.solver, &r.polish, &r.start})
    add(all, *text);
  for (const auto& [name, value] : r.options) {
    add(all, name);
    add(all, value);
  }
  add(all, "budget");
  for (const auto& [name, value] : r.budget) add(all, fmt::format("{} {}", name, value));
  add(all, fmt::format("{} {} {}", r.seed, r.base_seed, r.repetition));
  const RunContext& c = r.context;
  for (const std::string* text :
       {&c.version, &c.git_revision, &c.build_type, &c.compiler, &c.libraries, &c.kernel})
    add(all, *text);
  return sha256(all);
}

std::string result_check_sum(const RunRecord& record) {
  json all = to_json(record);
  for (const char* name : {"seconds", "time_utc", "context"}) all.erase(name);
  for (json& point : all["trace"]) point.erase("seconds");
  if (const auto measures = all.find("measures"); measures != all.end())
    for (json& measure : *measures)
      if (measure.value("timing", false)) measure.erase("value");
  return sha256(all.dump(-1, ' ', false, json::error_handler_t::replace));
}

}  // namespace odobench
