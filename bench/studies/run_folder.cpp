#include "bench/studies/run_folder.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <cstdint>
#include <stdexcept>
#include <system_error>
#include <utility>

#include "base/json_node.hpp"
#include "base/text.hpp"
#include "bench/catalogue/option_values.hpp"
#include "bench/studies/parameter_files.hpp"

namespace odobench {
namespace fs = std::filesystem;
namespace {

constexpr int kSavedWidth = 110;
constexpr std::array kSaved{Format::Console, Format::Markdown, Format::Csv, Format::Json, Format::Latex};

fs::path table_file(const fs::path& folder, Format format) {
  return folder / ("tables." + file_extension(format));
}

constexpr const char* kCopy = "runs.before_resume.jsonl";
constexpr std::uintmax_t kLargestRecords = std::uintmax_t{1} << 33;

// The whole lines of a file that no other process writes to. Throws std::invalid_argument when one does.
std::string unlocked_text(const fs::path& file, Watcher& watcher) {
  std::error_code e;
  if (!fs::exists(file, e)) return "";
  const int descriptor = open_regular(file);
  try {
    lock_place(descriptor, file, std::chrono::milliseconds(0));
  } catch (...) {
    ::close(descriptor);
    throw;
  }
  std::string text = read_file(file, kLargestRecords);
  ::close(descriptor);
  const std::size_t whole = text.empty() ? 0 : text.rfind('\n') + 1;  // npos + 1 is 0
  if (whole < text.size())
    watcher.note(fmt::format("{}: the last record is cut off and left out", shown_path(file)));
  text.resize(whole);
  return text;
}

// What belongs to the records of a folder, runs.jsonl first.
std::vector<fs::path> result_files(const fs::path& folder) {
  std::vector<fs::path> files{folder / "runs.jsonl"};
  for (const Format format : kSaved) files.push_back(table_file(folder, format));
  files.push_back(folder / "tracks" / "tracks.json");
  for (fs::path& file : stored_parameter_files(folder)) files.push_back(std::move(file));
  return files;
}

}  // namespace

RunFolder::RunFolder(fs::path folder, bool overwrite, const char* option)
    : folder_(std::move(folder)), overwrite_(overwrite), option_(option) {}

void RunFolder::require_free() const {
  if (!keeps()) return;
  require_own_folder(folder_ / "tracks");
  require_own_folder(folder_ / kParameterFolder);
  for (const fs::path& file : result_files(folder_)) {
    require_replaceable(file);
    std::error_code error;
    if (!overwrite_ && fs::exists(file, error))
      throw std::invalid_argument(
          fmt::format("{}={}: it holds {} already; choose another folder or give --overwrite", option_,
                      shown_path(folder_), file.lexically_relative(folder_).string()));
  }
}

void RunFolder::open() {
  if (!keeps()) return;
  try {
    file_ = std::make_unique<LineFile>(folder_ / "runs.jsonl", existing_files(overwrite_));
  } catch (const std::invalid_argument& e) {
    throw std::invalid_argument(fmt::format("{}={}: {}", option_, shown_path(folder_), e.what()));
  }
  if (!overwrite_) return;
  // What was made of the records that are gone would tell of them until the new ones are complete.
  for (const fs::path& file : result_files(folder_)) {
    std::error_code error;  // what cannot be removed cannot be replaced either, which is reported then
    if (file != file_->path()) fs::remove(file, error);
  }
}

std::vector<RunRecord> RunFolder::stored(Watcher& watcher) const {
  std::vector<RunRecord> records;
  for (const fs::path& file : {folder_ / kCopy, folder_ / "runs.jsonl"}) {
    const std::string text = keeps() ? unlocked_text(file, watcher) : "";
    std::size_t number = 0;
    for (std::size_t begin = 0; begin < text.size();) {
      const std::size_t end = text.find('\n', begin);
      const std::string_view line = std::string_view(text).substr(begin, end - begin);
      begin = end + 1;
      ++number;
      if (line.find_first_not_of(" \t\r") == std::string_view::npos) continue;
      records.push_back(record_from(JsonNode::parse_line(line, file, number)));
    }
  }
  return records;
}

void RunFolder::resume(const std::vector<RunRecord>& records) {
  if (!keeps()) return;
  std::string text;
  for (const RunRecord& r : records) text += to_json_line(r) + "\n";
  const fs::path copy = folder_ / kCopy;
  write_file(copy, text);  // open() empties the file
  std::error_code ignored;
  try {
    open();
  } catch (...) {
    fs::remove(copy, ignored);
    throw;
  }
  file_->replace(text);
  fs::remove(copy, ignored);
}

void RunFolder::append(const RunRecord& record) {
  if (keeps()) file_->append(to_json_line(record));
}

void RunFolder::replace(const std::vector<RunRecord>& records) {
  if (!keeps()) return;
  std::string text;
  for (const RunRecord& r : records) text += to_json_line(r) + "\n";
  file_->replace(text);
}

void RunFolder::save(const TrackSet& tracks) {
  save({tracks}, {});
}

void RunFolder::save(const std::vector<TrackSet>& tracks, const Files& parameters) {
  if (!keeps()) return;
  FileTransaction transaction;
  for (const TrackSet& set : tracks)
    for (const auto& [file, bytes] : track_files(set)) transaction.add(folder_ / file, bytes);
  for (const auto& [file, bytes] : parameters) transaction.add(folder_ / file, bytes);
  if (!transaction.targets().empty()) transaction.commit();
}

void RunFolder::save(const std::vector<Table>& tables) {
  if (!keeps()) return;
  FileTransaction transaction;
  for (const Format format : kSaved)
    transaction.add(table_file(folder_, format), render(tables, format, {kSavedWidth, false}));
  transaction.commit();
}

void RunFolder::keep(const std::vector<RunRecord>& records, const std::vector<Table>& tables,
                     Watcher& watcher, const TrackSet* tracks) {
  if (!keeps()) return;
  watcher.results_begin();
  open();
  for (const RunRecord& record : records) append(record);
  if (tracks != nullptr) save(*tracks);
  save(tables);
}

}  // namespace odobench
