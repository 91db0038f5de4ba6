#include "datasets/import/csv/csv_import.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>

#include "base/angle.hpp"
#include "base/names.hpp"
#include "base/sha256.hpp"
#include "base/text.hpp"
#include "datasets/import/csv/csv_drive.hpp"
#include "datasets/import/csv/csv_files.hpp"

namespace odobench {
namespace fs = std::filesystem;

namespace csv_import {
namespace {

constexpr double kShortestStep = 1e-4, kLongestStep = 10;  // s, of logs

std::string file_name(const fs::path& file) {
  return printable(file.filename().string());
}

// What a file is, of its name and of the map.
struct DriveName {
  std::string trajectory;
  int repetition = 0;  // 0: the first that is free
};

class CsvImporter {
 public:
  CsvImporter(const std::vector<std::string>& items, const fs::path& map) : files_(csv_files(items)) {
    const std::string text = read_file(map);
    map_ = parse_csv_map(text, map.string());
    set().provenance.files.push_back({file_name(map), sha256(text)});
  }

  CsvImport import() {
    Dataset& d = set();
    d.name = map_.name;
    d.description = map_.description;
    d.robot = map_.robot;
    d.provenance.source = map_.source;
    d.provenance.licence = map_.licence;
    d.provenance.made_by = "bench import csv";
    name_drives();
    for (std::size_t i = 0; i < files_.size(); ++i) add(files_[i], names_[i]);
    return std::move(result_);
  }

 private:
  Dataset& set() { return result_.dataset; }
  void note(std::string text) { set().notes.push_back(std::move(text)); }

  void name_drives() {
    std::set<std::string> used;
    std::map<std::pair<std::string, int>, fs::path> taken;
    for (const fs::path& file : files_) {
      names_.push_back(name_of_drive(file, used));
      const DriveName& name = names_.back();
      if (name.repetition == 0) continue;
      const auto [there, is_new] = taken.emplace(std::pair(name.trajectory, name.repetition), file);
      if (!is_new)
        throw DataError(
            fmt::format("{}: found repetition {} of \"{}\" a second time, after {}; say in the map "
                        "which it is: \"trajectories\": {{\"{}\": {{\"trajectory\": ..., "
                        "\"repetition\": ...}}}}",
                        shown_path(file), name.repetition, shown(name.trajectory), shown_path(there->second),
                        file_name(file)));
    }
    for (std::size_t i = 0; i < names_.size(); ++i)
      for (int number = 1; names_[i].repetition == 0; ++number)
        if (taken.emplace(std::pair(names_[i].trajectory, number), files_[i]).second)
          names_[i].repetition = number;
    refuse_unused(used);
  }

  DriveName name_of_drive(const fs::path& file, std::set<std::string>& used) const {
    const NameParts parts = name_parts(file);
    for (const std::string& key : {file.filename().string(), file.stem().string()}) {
      const auto found = map_.drives.find(key);
      if (found == map_.drives.end()) continue;
      used.insert(key);
      return {printable(found->second.trajectory), found->second.repetition.value_or(0)};
    }
    return {printable(parts.trajectory), parts.number};
  }

  void refuse_unused(const std::set<std::string>& used) const {
    std::vector<std::string> there;
    for (const fs::path& file : files_) there.push_back(file.filename().string());
    for (const auto& [key, drive] : map_.drives)
      if (!used.contains(key))
        throw DataError(
            fmt::format("{}: /trajectories: found \"{}\"{}, expected names of files that are "
                        "imported",
                        map_.file, shown(key), did_you_mean(key, there)));
  }

  void add(const fs::path& file, const DriveName& name) {
    const std::string text = read_file(file);
    CsvDrive drive = parse_drive(text, file.string(), map_);
    set().provenance.files.push_back({file_name(file), sha256(text)});
    Recording& r = drive.recording;
    r.trajectory = name.trajectory;
    r.repetition = name.repetition;
    r.id = fmt::format("{}_{}", as_id(name.trajectory), name.repetition);
    while (!ids_.insert(r.id).second) r.id += '_';
    if (trajectories_.insert(name.trajectory).second) set().trajectories.push_back({name.trajectory, ""});
    add_notes(drive, file_name(file));
    result_.report.push_back(describe_drive(r, file_name(file)));
    set().recordings.push_back(std::move(r));
  }

  void add_notes(const CsvDrive& drive, const std::string& file) {
    const auto counted = [&](std::size_t count, const char* what) {
      if (count > 0) note(fmt::format("{}: {} {}", file, count, what));
    };
    counted(drive.before_reference, "rows before the first with a reference left out");
    counted(drive.without_reference, "rows have no reference");
    counted(drive.turns_removed, "jumps of the heading by full turns removed");
    counted(
        drive.unclear_turns,
        "headings more than half a turn from the one before, with rows without a reference between: taken "
        "as they stand");
    if (drive.unfinished) note(fmt::format("{} ends without a line break: its last row may be cut", file));
    if (drive.first_increment > 0)
      note(
          fmt::format("{} begins with an increment from before the drive, of up to {:.3g} rad, which is "
                      "never used",
                      file, drive.first_increment));
    if (drive.gaps > 0)
      note(
          fmt::format("{}: {} steps longer than {} usual ones of {:.4g} s, the longest of {:.4g} s before "
                      "line {}; nothing is filled in",
                      file, drive.gaps, kGap, drive.usual_step, drive.longest_step, drive.longest_line));
    if (drive.usual_step < kShortestStep || drive.usual_step > kLongestStep)
      note(fmt::format("{}: rows are {:.4g} s apart: is the unit of \"{}\" right?", file, drive.usual_step,
                       shown(map_.time.column)));
  }

  std::vector<fs::path> files_;
  CsvMap map_;
  std::vector<DriveName> names_;
  std::set<std::string> ids_, trajectories_;
  CsvImport result_;
};

}  // namespace
}  // namespace csv_import

CsvImport import_csv(const std::vector<std::string>& items, const fs::path& map) {
  return csv_import::CsvImporter(items, map).import();
}

}  // namespace odobench
