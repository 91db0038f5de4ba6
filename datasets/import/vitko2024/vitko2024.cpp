#include "datasets/import/vitko2024/vitko2024.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <charconv>
#include <exception>
#include <map>
#include <mutex>
#include <thread>

#include "base/files.hpp"
#include "base/sha256.hpp"
#include "base/text.hpp"
#include "datasets/import/vitko2024/synchronise.hpp"
#include "datasets/import/vitko2024/vitko2024_csv.hpp"
#include "datasets/import/vitko2024/vitko2024_join.hpp"
#include "datasets/robot_4wis4wid.hpp"

namespace odobench {
namespace fs = std::filesystem;
namespace {

constexpr int kPublishedRecordings = 30;
constexpr int kRepetitions = 5;
constexpr int kMostPairs = 100000;
// How far the wheel signals may be inter- and extrapolated: more means that the log has a hole, that a clock
// was set, or that the two files do not belong together.
constexpr std::int64_t kLongestGap_us = 1'000'000;

// Sums by file name, and the line on which each stands.
struct Sums {
  struct Entry {
    std::string sum;
    std::size_t line;
  };
  fs::path file;
  bool present = false;
  std::map<std::string, Entry> entries;
};

// Lines "sum  name" or "sum *name", as sha256sum writes them.
Sums read_sums(const fs::path& folder) {
  Sums sums{folder / "SHA256SUMS", false, {}};
  if (!fs::exists(sums.file)) return sums;
  sums.present = true;
  const std::string text = read_file(sums.file);
  std::size_t line = 0;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = std::min(text.find('\n', at), text.size());
    const std::string row = text.substr(at, end - at);
    at = end + 1;
    ++line;
    if (row.empty()) continue;
    if (row.size() < 67 || !is_sha256(row.substr(0, 64)) || row[64] != ' ' ||
        (row[65] != ' ' && row[65] != '*'))
      throw DataError(fmt::format("{}:{}: found \"{}\", expected \"<64 hexadecimal digits>  <file>\"",
                                  sums.file.string(), line, shown(row)));
    sums.entries[row.substr(66)] = {row.substr(0, 64), line};
  }
  return sums;
}

// How many pairs abs_1, odom_1, ... there are. A folder without any is taken for the published one, so that
// the first missing file is named.
int count_pairs(const fs::path& folder, const Sums& sums) {
  int last = 0;
  const auto consider = [&](const std::string& name) {
    for (const std::string_view kind : {"abs_", "odom_"}) {
      if (name.rfind(kind, 0) != 0 || name.size() < kind.size() + 5 || name.substr(name.size() - 4) != ".csv")
        continue;
      const std::string digits = name.substr(kind.size(), name.size() - kind.size() - 4);
      int number = 0;
      const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), number);
      if (error == std::errc() && end == digits.data() + digits.size() && number <= kMostPairs)
        last = std::max(last, number);
    }
  };
  std::error_code error;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, error))
    consider(entry.path().filename().string());
  for (const auto& [name, entry] : sums.entries) consider(name);
  return last > 0 ? last : kPublishedRecordings;
}

// What became of one pair of files.
struct Pair {
  Recording recording;
  SourceFile capture, wheels;
  std::size_t moved_capture = 0, moved_wheels = 0;
  std::size_t lost = 0;
  bool unfinished_capture = false, unfinished_wheels = false;
};

class Importer {
 public:
  Importer(const fs::path& folder, bool drop_lost)
      : folder_(!fs::exists(folder / "abs_1.csv") && fs::exists(folder / "dataset" / "abs_1.csv")
                    ? folder / "dataset"
                    : folder),
        sums_(read_sums(folder_)),
        count_(count_pairs(folder_, sums_)),
        drop_lost_(drop_lost),
        trajectories_(count_ == kPublishedRecordings ? trajectories_4wis4wid()
                                                     : std::vector<Trajectory>{{"drive", "drive"}}) {}

  int count() const { return count_; }
  const std::vector<Trajectory>& trajectories() const { return trajectories_; }

  Pair import(int number) const {  // 1 to count()
    Pair pair;
    const std::string capture_file = file("abs", number), wheel_file = file("odom", number);
    vitko2024::CaptureLog capture =
        vitko2024::parse_capture(load("abs", number, pair.capture), capture_file, drop_lost_);
    vitko2024::WheelLog wheels = vitko2024::parse_wheels(load("odom", number, pair.wheels), wheel_file);
    require_rows(capture.lines, vitko2024::kDroppedSamples + 2, capture_file);
    require_rows(wheels.lines, 2, wheel_file);
    pair.lost = capture.lost;
    pair.unfinished_capture = capture.lines.unfinished;
    pair.unfinished_wheels = wheels.lines.unfinished;
    pair.moved_capture = increase(capture.time_us, capture.lines, capture_file);
    pair.moved_wheels = increase(wheels.time_us, wheels.lines, wheel_file);
    require_cover(capture, wheels, wheel_file);

    Recording& r = pair.recording;
    r = vitko2024::join(std::move(capture), wheels);
    const int repetitions = trajectories_.size() == 1 ? count_ : kRepetitions;
    r.trajectory = trajectories_[static_cast<std::size_t>((number - 1) / repetitions)].name;
    r.repetition = 1 + (number - 1) % repetitions;
    r.id = fmt::format("{}_{}", r.trajectory, r.repetition);
    return pair;
  }

 private:
  static std::string name(const char* kind, int number) { return fmt::format("{}_{}.csv", kind, number); }
  std::string file(const char* kind, int number) const { return (folder_ / name(kind, number)).string(); }

  std::string load(const char* kind, int number, SourceFile& source) const {
    std::string bytes = read_file(folder_ / name(kind, number));
    source = {"dataset/" + name(kind, number), sha256(bytes)};
    if (!sums_.present) return bytes;
    const auto entry = sums_.entries.find(name(kind, number));
    if (entry == sums_.entries.end())
      throw DataError(
          fmt::format("{}: found no sum of {}, expected one", sums_.file.string(), name(kind, number)));
    if (entry->second.sum != source.sha256)
      throw DataError(fmt::format("{}: found SHA-256 {}, expected {} ({}:{})", file(kind, number),
                                  source.sha256, entry->second.sum, sums_.file.string(), entry->second.line));
    return bytes;
  }

  static void require_rows(const vitko2024::RowLines& lines, std::size_t least, const std::string& file) {
    if (lines.rows.size() < least)
      throw DataError(fmt::format("{}:{}: found the end of the file after {} rows, expected at least {}",
                                  file, lines.end(), lines.rows.size(), least));
  }

  static std::size_t increase(std::vector<std::int64_t>& stamps, const vitko2024::RowLines& lines,
                              const std::string& file) {
    const StampRepair repair = make_increasing(stamps);
    if (repair.fault < stamps.size())
      throw DataError(fmt::format(
          "{}:{}: found a stamp {} us before the one above it, expected a later one (up to {} us are mended)",
          file, lines.rows[repair.fault], stamps[repair.fault - 1] - stamps[repair.fault],
          kLargestBackstep_us));
    return repair.moved;
  }

  static void require_cover(const vitko2024::CaptureLog& capture, const vitko2024::WheelLog& wheels,
                            const std::string& file) {
    const std::int64_t late = wheels.time_us.front() - capture.time_us.front();
    const std::int64_t early = capture.time_us.back() - wheels.time_us.back();
    for (std::size_t k = 1; k < wheels.time_us.size(); ++k)
      if (wheels.time_us[k] - wheels.time_us[k - 1] > kLongestGap_us)
        throw DataError(
            fmt::format("{}:{}: found a stamp {} us after the one above it, expected at most {} us", file,
                        wheels.lines.rows[k], wheels.time_us[k] - wheels.time_us[k - 1], kLongestGap_us));
    if (late > kLongestGap_us)
      throw DataError(
          fmt::format("{}:{}: found a first stamp {} us after the motion capture's, expected at most {} us",
                      file, wheels.lines.rows.front(), late, kLongestGap_us));
    if (early > kLongestGap_us)
      throw DataError(
          fmt::format("{}:{}: found a last stamp {} us before the motion capture's, expected at most {} us",
                      file, wheels.lines.rows.back(), early, kLongestGap_us));
  }

  fs::path folder_;
  Sums sums_;
  int count_;
  bool drop_lost_;
  std::vector<Trajectory> trajectories_;
};

// Imports all pairs on several threads. Pairs are handed out in ascending order and begun ones are finished,
// so that the error reported is that of the lowest number, whatever the threads do.
std::vector<Pair> import_pairs(const Importer& importer, const ImportProgress& progress, int threads) {
  const int count = importer.count();
  std::vector<Pair> pairs(static_cast<std::size_t>(count));
  std::vector<std::exception_ptr> errors(static_cast<std::size_t>(count));
  std::exception_ptr interruption;
  std::atomic<int> next{0};
  std::atomic<bool> stop{false};
  std::mutex progress_mutex;
  int done = 0;
  const auto work = [&] {
    while (!stop) {
      const int index = next++;
      if (index >= count) return;
      try {
        pairs[static_cast<std::size_t>(index)] = importer.import(index + 1);
      } catch (...) {
        errors[static_cast<std::size_t>(index)] = std::current_exception();
        stop = true;
        continue;
      }
      if (!progress) continue;
      const std::lock_guard lock(progress_mutex);
      try {
        if (!stop) progress(++done, count);
      } catch (...) {
        interruption = std::current_exception();
        stop = true;
      }
    }
  };
  {
    const unsigned machine = std::max(1u, std::thread::hardware_concurrency());
    const int workers = std::min(threads > 0 ? threads : static_cast<int>(machine), count);
    std::vector<std::jthread> helpers;
    for (int i = 1; i < workers; ++i) helpers.emplace_back(work);
    work();
  }
  for (const std::exception_ptr& error : errors)
    if (error) std::rethrow_exception(error);
  if (interruption) std::rethrow_exception(interruption);
  return pairs;
}

// Parameter vectors that the thesis prints for these recordings, in mm as printed.
std::vector<NamedParameters> published_parameters() {
  std::vector<NamedParameters> sets = {
      {"published:ip",
       "interior point (MATLAB fmincon), thesis table 8",
       {118.1, -118.1, -116.4, 112.4, 106.9, 118.1, -107.1, -106.9, 25.55, 26.67, 25.91, 25.11}},
      {"published:lm",
       "Levenberg-Marquardt, as printed in the thesis",
       {114.7, -114.7, -113.2, 113.2, 114.2, 114.2, -113.9, -107.7, 25.83, 25.86, 25.86, 25.36}},
      {"published:ga",
       "genetic algorithm, thesis table 22; suspected of a misprint: b4 = -112.6 instead of -116.2 fits far "
       "better",
       {111.4, -114.0, -112.2, 107.4, 114.4, 114.7, -116.3, -116.2, 26.04, 25.93, 25.67, 25.46}},
      {"published:pso",
       "particle swarm, as printed in the thesis",
       {107.9, -116.5, -117.5, 108.1, 114.4, 111.7, -116.7, -108.5, 26.11, 25.13, 26.61, 25.01}},
  };
  for (NamedParameters& set : sets)
    for (double& value : set.values) value /= 1000;
  return sets;
}

// SHA-256 of the sums of the 60 published files, abs_1, odom_1, abs_2, ..., one after the other
// (scripts/vitko2024.sha256 lists them).
constexpr std::string_view kPublishedSums =
    "a1f89908b5854df474fb69441909a361c0a5812ef63fcc7bdb498cd4e79436a3";

bool is_published(const std::vector<SourceFile>& files) {
  std::string sums;
  for (const SourceFile& file : files) sums += file.sha256;
  return sha256(sums) == kPublishedSums;
}

// What only the published files can claim.
void describe_published(Dataset& d) {
  d.description =
      "30 drives of a robot with four steered and driven wheels under motion capture, six trajectories, five "
      "times each";
  d.known_parameters = published_parameters();
  d.provenance.source =
      "J. Vitko, Calibration and localization of a mobile robot with four independent steering and four "
      "independent driving "
      "wheels, master's thesis, University of Zagreb, 2024; recordings: "
      "https://github.com/JakVit/4WIS4WID_parameter_calibration, commit "
      "862117d37862a74d15503cfe8810d5f61a00bbe6";
  d.provenance.licence = "none stated";
}

void describe_others(Dataset& d) {
  d.description = fmt::format(
      "{} drives in the layout of the recordings published with J. Vitko's thesis, which they are not",
      d.recordings.size());
  d.provenance.source = "unknown: files in that layout whose sums are not the published ones";
  d.provenance.licence = "unknown";
}

}  // namespace

Dataset import_vitko2024(const fs::path& folder, const ImportProgress& progress, int threads,
                         bool drop_lost) {
  std::error_code unreadable;
  if (!fs::is_directory(folder, unreadable))
    throw DataError(fmt::format("{}: found no such folder, expected one with abs_1.csv ... odom_30.csv",
                                folder.string()));
  const Importer importer(folder, drop_lost);
  std::vector<Pair> pairs = import_pairs(importer, progress, threads);

  Dataset d;
  d.name = "vitko2024";
  d.robot = robot_4wis4wid();
  d.trajectories = importer.trajectories();
  d.provenance.made_by = "bench import vitko2024";
  if (importer.count() != kPublishedRecordings)
    d.notes.push_back(fmt::format("{} pairs of files, not {}: they count as repetitions of one trajectory",
                                  importer.count(), kPublishedRecordings));
  for (Pair& pair : pairs) {
    if (pair.lost > 0)
      d.notes.push_back(fmt::format("{} samples whose tracking was lost left out of recording {} ({})",
                                    pair.lost, pair.recording.id, pair.capture.path));
    for (const auto& [unfinished, file] :
         {std::pair{pair.unfinished_capture, &pair.capture}, std::pair{pair.unfinished_wheels, &pair.wheels}})
      if (unfinished)
        d.notes.push_back(fmt::format("{} ends without a line break: its last row may be cut", file->path));
    const auto note = [&](std::size_t moved, const SourceFile& file) {
      if (moved > 0)
        d.notes.push_back(fmt::format("{} stamps moved to 1 us after their predecessor in recording {} ({})",
                                      moved, pair.recording.id, file.path));
    };
    note(pair.moved_capture, pair.capture);
    note(pair.moved_wheels, pair.wheels);
    d.provenance.files.push_back(std::move(pair.capture));
    d.provenance.files.push_back(std::move(pair.wheels));
    d.recordings.push_back(std::move(pair.recording));
  }
  if (is_published(d.provenance.files))
    describe_published(d);
  else
    describe_others(d);
  return d;
}

}  // namespace odobench
