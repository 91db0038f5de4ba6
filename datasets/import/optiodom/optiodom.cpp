#include "datasets/import/optiodom/optiodom.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <map>
#include <set>
#include <stdexcept>

#include "base/angle.hpp"
#include "base/sha256.hpp"
#include "base/text.hpp"
#include "datasets/import/optiodom/optiodom_files.hpp"

namespace odobench {
namespace fs = std::filesystem;
namespace {

constexpr std::string_view kMetadataEnd = "_metadata.csv";
constexpr double kTurning = kPi / 2;  // rad; less has no sense
constexpr int kLicenceLevels = 4;     // folders above a set in which a LICENSE may lie

// One folder of the data.
struct DriveFolder {
  fs::path folder;  // normal and absolute
  std::string stamp;
  std::string source;  // "diff/square/230620202042"
  std::string path;    // "square"
  optiodom::Metadata metadata;
  std::map<int, std::string> runs;  // file names by number
};

std::vector<std::string> files_in(const fs::path& folder) {
  std::error_code error;
  std::vector<std::string> names;
  for (fs::directory_iterator at(folder, error), end; !error && at != end; at.increment(error))
    names.push_back(at->path().filename().string());
  if (error)
    throw DataError(fmt::format("{}: found no folder that can be read ({}), expected one of OptiOdom's data",
                                shown_path(folder), error.message()));
  std::sort(names.begin(), names.end());
  return names;
}

std::string metadata_in(const fs::path& folder, const std::vector<std::string>& names) {
  std::vector<std::string> found;
  for (const std::string& name : names)
    if (name.size() > kMetadataEnd.size() && name.ends_with(kMetadataEnd)) found.push_back(name);
  if (found.size() != 1)
    throw DataError(fmt::format("{}: found {} files *{}, expected one in a folder TYPE/PATH/STAMP",
                                shown_path(folder), found.size(), kMetadataEnd));
  return found[0];
}

// "STAMP_run-07.csv": 7; 0 for other names.
int run_number(const std::string& name, const std::string& stamp) {
  const std::string begin = stamp + "_run-", end = ".csv";
  if (!name.starts_with(begin) || !name.ends_with(end) || name.size() <= begin.size() + end.size()) return 0;
  const std::string digits = name.substr(begin.size(), name.size() - begin.size() - end.size());
  int number = 0;
  const auto [last, error] = std::from_chars(digits.data(), digits.data() + digits.size(), number);
  return error == std::errc() && last == digits.data() + digits.size() && number > 0 ? number : 0;
}

DriveFolder open_folder(const fs::path& given, Provenance& provenance) {
  if (given.empty()) throw std::invalid_argument("found an empty name, expected a folder of OptiOdom's data");
  DriveFolder f;
  f.folder = fs::absolute(given).lexically_normal();
  if (f.folder.filename().empty()) f.folder = f.folder.parent_path();
  const std::vector<std::string> names = files_in(f.folder);
  const std::string metadata = metadata_in(f.folder, names);
  f.stamp = metadata.substr(0, metadata.size() - kMetadataEnd.size());
  f.path = f.folder.parent_path().filename().string();
  if (f.path.empty()) f.path = "drive";
  f.source = fmt::format("{}/{}/{}", f.folder.parent_path().parent_path().filename().string(), f.path,
                         f.folder.filename().string());
  for (const std::string& name : names) {
    const int number = run_number(name, f.stamp);
    if (number == 0) continue;
    if (!f.runs.emplace(number, name).second)
      throw DataError(fmt::format("{}: found {} and {}, expected one file of run {}", shown_path(f.folder),
                                  f.runs[number], name, number));
  }
  if (f.runs.empty())
    throw DataError(fmt::format("{}: found no {}_run-*.csv, expected at least one", shown_path(f.folder),
                                shown(f.stamp)));
  const std::string text = read_file(f.folder / metadata);
  f.metadata = optiodom::parse_metadata(text, (f.folder / metadata).string());
  provenance.files.push_back({fmt::format("{}/{}", f.source, metadata), sha256(text)});
  return f;
}

// Name of the trajectory, and what it is.
std::pair<std::string, std::string> trajectory_of(const std::string& path, double turned) {
  const char* sense = turned > kTurning ? "counter-clockwise" : turned < -kTurning ? "clockwise" : "";
  const std::string end = turned > kTurning ? "_ccw" : turned < -kTurning ? "_cw" : "";
  if (path == "free" || path == "joystick") return {path, "driven by joystick"};
  if (path == "ivanjko") {
    if (end.empty()) return {"line", "straight line"};
    return {"turn" + end, fmt::format("half a turn on the spot, {}", sense)};
  }
  return {path + end, end.empty() ? path : fmt::format("{}, {}", path, sense)};
}

class OptiodomImporter {
 public:
  OptiodomImporter(const std::vector<fs::path>& folders, const OptiodomOptions& options) : options_(options) {
    std::set<fs::path> given;
    for (const fs::path& folder : folders) {
      folders_.push_back(open_folder(folder, d_.provenance));
      if (!given.insert(folders_.back().folder).second)
        throw std::invalid_argument(fmt::format("folder {} is given twice", shown_path(folder)));
    }
    check_types();
    check_excluded();
  }

  Dataset import() {
    describe();
    for (const DriveFolder& folder : folders_)
      for (const auto& [number, file] : folder.runs) {
        if (std::find(options_.exclude.begin(), options_.exclude.end(), number) == options_.exclude.end())
          add(folder, number, file);
        else
          d_.notes.push_back(fmt::format("run {} of {} left out, as asked for", number, folder.source));
      }
    if (d_.recordings.empty()) throw std::invalid_argument("all runs are excluded, expected one at least");
    note_first_rows();
    return std::move(d_);
  }

 private:
  const optiodom::Metadata& metadata() const { return folders_.front().metadata; }

  void check_types() const {
    std::set<std::string> stamps;
    for (const DriveFolder& f : folders_) {
      if (f.metadata.type != metadata().type)
        throw DataError(fmt::format("{}: found a robot of type {}, expected {} as in {}",
                                    shown_path(f.folder), f.metadata.type->name, metadata().type->name,
                                    folders_.front().source));
      if (!stamps.insert(f.stamp).second)
        throw DataError(
            fmt::format("{}: found the stamp {} a second time, expected folders with different ones",
                        shown_path(f.folder), shown(f.stamp)));
    }
  }
  void check_excluded() const {
    for (const int number : options_.exclude)
      if (std::none_of(folders_.begin(), folders_.end(),
                       [&](const DriveFolder& f) { return f.runs.contains(number); }))
        throw std::invalid_argument(fmt::format("run {} is to be excluded, but no folder has it", number));
  }

  void describe() {
    const optiodom::RobotType& type = *metadata().type;
    d_.name = fmt::format("optiodom-{}", type.name);
    d_.description = fmt::format("drives of a {} under motion capture, in the layout of OptiOdom's data: {}",
                                 type.description, fmt::join(sources(), ", "));
    d_.robot = robot_of(metadata());
    d_.provenance.made_by = "bench import optiodom";
    d_.provenance.source =
        "in the layout of R. B. Sousa, M. R. Petry, P. G. Costa, A. P. Moreira, OptiOdom, J. Intell. Robot. "
        "Syst. 105:39, 2022, https://github.com/sousarbarb/odometry-calibration";
    d_.provenance.licence = "not stated beside the files; MIT where they are the published ones";
    find_licence();
    d_.notes.push_back(
        fmt::format("nominal values are those of {}/{}{}; the authors' workbook has others for some sets",
                    folders_.front().source, folders_.front().stamp, kMetadataEnd));
    for (const DriveFolder& f : folders_) {
      if (!f.metadata.same_robot(metadata()))
        d_.notes.push_back(
            fmt::format("metadata of {} state other nominal values, which are not used: "
                        "distances {} m, diameters {} m, steering zero {} rad",
                        f.source, fmt::join(f.metadata.distances, ", "),
                        fmt::join(f.metadata.diameters, ", "), f.metadata.steering_zero));
      if (f.metadata.runs != f.runs.size())
        d_.notes.push_back(fmt::format("metadata of {} state {} runs, the folder has {}", f.source,
                                       f.metadata.runs, f.runs.size()));
    }
  }
  std::vector<std::string> sources() const {
    std::vector<std::string> list;
    for (const DriveFolder& f : folders_) list.push_back(f.source);
    return list;
  }
  // The MIT licence is claimed where its text lies above the data.
  void find_licence() {
    fs::path place = folders_.front().folder;
    std::error_code error;
    for (int level = 0; level < kLicenceLevels; ++level) {
      place = place.parent_path();
      if (!fs::is_regular_file(place / "LICENSE", error)) continue;
      const std::string text = read_file(place / "LICENSE");
      if (!text.starts_with("MIT License")) return;
      d_.provenance.licence = "MIT";
      d_.provenance.files.push_back({"LICENSE", sha256(text)});
      return;
    }
  }

  void add(const DriveFolder& folder, int number, const std::string& file) {
    const std::string text = read_file(folder.folder / file);
    optiodom::Run run = optiodom::parse_run(text, (folder.folder / file).string(), folder.metadata);
    d_.provenance.files.push_back({fmt::format("{}/{}", folder.source, file), sha256(text)});
    Recording& r = run.recording;
    auto [name, what] = trajectory_of(folder.path, r.reference.theta.back() - r.reference.theta.front());
    if (folder.metadata.side) what += fmt::format(", side {} m", *folder.metadata.side);
    const bool shared_path = std::count_if(folders_.begin(), folders_.end(),
                                           [&](const DriveFolder& f) { return f.path == folder.path; }) > 1;
    if (shared_path) {
      name += "_" + folder.stamp;
      what += ", " + folder.stamp;
    }
    if (std::none_of(d_.trajectories.begin(), d_.trajectories.end(),
                     [&, &wanted = name](const Trajectory& t) { return t.name == wanted; }))
      d_.trajectories.push_back({name, what});
    r.trajectory = name;
    r.repetition = number;
    r.id = fmt::format("{}_run-{:02}", folder.stamp, number);
    if (run.unfinished)
      d_.notes.push_back(
          fmt::format("{}/{} ends without a line break: its last row may be cut", folder.source, file));
    if (run.before > 0) {
      ++first_rows_;
      before_ = std::max(before_, run.before);
    }
    d_.recordings.push_back(std::move(r));
  }
  void note_first_rows() {
    if (first_rows_ > 0)
      d_.notes.push_back(
          fmt::format("{} recordings begin with an increment from before the drive, of up to "
                      "{:.3g} rad, which is never used",
                      first_rows_, before_));
  }

  OptiodomOptions options_;
  std::vector<DriveFolder> folders_;
  Dataset d_;
  int first_rows_ = 0;
  double before_ = 0;
};

}  // namespace

Dataset import_optiodom(const std::vector<fs::path>& folders, const OptiodomOptions& options) {
  if (folders.empty()) throw std::invalid_argument("no folder to import, expected one at least");
  return OptiodomImporter(folders, options).import();
}

}  // namespace odobench
