#include <algorithm>
#include <map>

#include "datasets/import/logs/log_roles.hpp"
#include "datasets/logs/formats.hpp"

namespace odobench::log_import {
namespace fs = std::filesystem;

namespace {

// What two logs of the same kind share.
std::string signature(const std::vector<LogSource>& sources) {
  std::string text;
  for (const LogSource& source : sources) {
    text += source.name + '\n' + source.type + '\n';
    for (const LogField& field : source.fields) text += field.path + '\n';
  }
  return text;
}

// "run_*.csv" of run_1.csv and run_2.csv; the name itself of one.
std::string pattern_of(const std::vector<fs::path>& files) {
  std::string head = files.front().filename().string(), tail = head;
  const std::string whole = head;
  if (files.size() == 1) return whole;
  for (const fs::path& file : files) {
    const std::string name = file.filename().string();
    const auto at = std::mismatch(head.begin(), head.end(), name.begin(), name.end()).first;
    head.erase(at, head.end());
    const auto back = std::mismatch(tail.rbegin(), tail.rend(), name.rbegin(), name.rend()).first;
    tail.erase(tail.begin(), back.base());
  }
  if (head.size() + tail.size() > whole.size()) tail = tail.substr(head.size() + tail.size() - whole.size());
  return head + "*" + tail;
}

}  // namespace

std::vector<SurveyedSource> survey_logs(const std::vector<fs::path>& logs, const LogOptions& options,
                                        const Stop& stop) {
  struct Kind {
    std::vector<fs::path> files;
    std::vector<LogSource> sources;
  };
  std::vector<Kind> kinds;
  std::map<std::string, std::size_t> known;
  for (const fs::path& log : logs) {
    std::vector<LogSource> sources = open_log(log, options)->sources(stop);
    const auto [there, is_new] = known.emplace(signature(sources), kinds.size());
    if (is_new) kinds.push_back({{}, std::move(sources)});
    kinds[there->second].files.push_back(log);
  }
  std::vector<SurveyedSource> all;
  for (Kind& kind : kinds)
    for (LogSource& source : kind.sources)
      all.push_back({kind.files.front(), kinds.size() == 1 ? "" : pattern_of(kind.files), std::move(source)});
  return all;
}

}  // namespace odobench::log_import
