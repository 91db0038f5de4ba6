#include "datasets/import/logs/log_groups.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

#include "base/files.hpp"
#include "base/text.hpp"

namespace odobench::log_import {
namespace fs = std::filesystem;

std::optional<std::string> star_text(const std::string& pattern, const std::string& name) {
  const std::size_t star = pattern.find('*');
  if (star == std::string::npos) return name == pattern ? std::optional<std::string>("") : std::nullopt;
  const std::string head = pattern.substr(0, star), tail = pattern.substr(star + 1);
  if (name.size() < head.size() + tail.size() || !name.starts_with(head) || !name.ends_with(tail))
    return std::nullopt;
  return name.substr(head.size(), name.size() - head.size() - tail.size());
}

namespace {

// The pattern's last part against the file's name, what is before it against the end of the file's folder.
std::optional<std::string> fits(const std::string& pattern, const fs::path& file) {
  const fs::path own(pattern);
  if (own.has_parent_path() && !file.parent_path().string().ends_with(own.parent_path().string()))
    return std::nullopt;
  return star_text(own.filename().string(), file.filename().string());
}

std::string id_of(const fs::path& log) {
  const fs::path name = log.filename().empty() ? log.parent_path().filename() : log.filename();
  return fs::is_directory(log) ? name.string() : name.stem().string();
}

std::vector<LogGroup> each_alone(const LogMap& map, const std::vector<fs::path>& logs) {
  std::vector<LogGroup> groups;
  for (const fs::path& log : logs) {
    groups.push_back({id_of(log), {}});
    for (const MappedSource& source : map.sources) groups.back().file_of[source.name] = log;
  }
  return groups;
}

}  // namespace

std::vector<LogGroup> group_logs(const LogMap& map, const std::vector<fs::path>& logs) {
  if (std::all_of(map.sources.begin(), map.sources.end(),
                  [](const MappedSource& s) { return s.files.empty(); }))
    return each_alone(map, logs);
  std::map<std::string, LogGroup> groups;    // by the text of the star
  std::map<std::string, fs::path> of_every;  // source without a star -> log
  for (const fs::path& log : logs) {
    bool taken = false;
    for (const MappedSource& source : map.sources) {
      const std::optional<std::string> drive = fits(source.files, log);
      if (!drive) continue;
      taken = true;
      fs::path& place = source.files.find('*') == std::string::npos ? of_every[source.name]
                                                                    : groups[*drive].file_of[source.name];
      if (!place.empty())
        throw std::invalid_argument(fmt::format("{} and {}: both fit \"{}\" of source \"{}\", expected one",
                                                shown_path(place), shown_path(log), shown(source.files),
                                                shown(source.name)));
      place = log;
    }
    if (!taken)
      throw std::invalid_argument(
          fmt::format("{}: fits no pattern \"files\" of the sources in {}", shown_path(log), map.file));
  }
  if (groups.empty()) groups[""];
  std::vector<LogGroup> all;
  for (auto& [drive, group] : groups) {
    group.file_of.insert(of_every.begin(), of_every.end());
    for (const MappedSource& source : map.sources)
      if (!group.file_of.contains(source.name))
        throw std::invalid_argument(
            fmt::format("source \"{}\" of {}: no log{} fits \"{}\"", shown(source.name), map.file,
                        drive.empty() ? "" : " of drive " + shown(drive), shown(source.files)));
    group.id = drive.empty() ? id_of(group.file_of.begin()->second) : drive;
    all.push_back(std::move(group));
  }
  return all;
}

}  // namespace odobench::log_import
