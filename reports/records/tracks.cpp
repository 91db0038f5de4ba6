#include "reports/records/tracks.hpp"

#include <fmt/format.h>

#include <array>
#include <bit>
#include <cstdint>
#include <cstring>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "base/files.hpp"
#include "base/json_node.hpp"

namespace odobench {
namespace {

using nlohmann::json;
namespace fs = std::filesystem;

constexpr const char* kFolder = "tracks";
constexpr std::string_view kMagic("\x93NUMPY\x01\x00", 8);

void put_little_endian(std::string& out, double value) {
  auto bits = std::bit_cast<std::uint64_t>(value);
  for (int byte = 0; byte < 8; ++byte, bits >>= 8) out += static_cast<char>(bits & 0xff);
}

double little_endian(const char* bytes) {
  std::uint64_t bits = 0;
  for (int byte = 7; byte >= 0; --byte) bits = bits << 8 | static_cast<unsigned char>(bytes[byte]);
  return std::bit_cast<double>(bits);
}

std::string npy_header(const std::string& shape) {
  std::string text = "{'descr': '<f8', 'fortran_order': False, 'shape': (" + shape + "), }";
  const std::size_t before = kMagic.size() + 2;
  text.resize((before + text.size() + 1 + 63) / 64 * 64 - before - 1, ' ');  // data begin at a multiple of 64
  text += '\n';
  std::string header(kMagic);
  header += static_cast<char>(text.size() & 0xff);
  header += static_cast<char>(text.size() >> 8);
  return header + text;
}

std::string npy(const std::vector<double>& values) {
  std::string out = npy_header(fmt::format("{},", values.size()));
  out.reserve(out.size() + 8 * values.size());
  for (const double value : values) put_little_endian(out, value);
  return out;
}

std::string npy(const PoseTrack& pose) {
  std::string out = npy_header(fmt::format("{}, 3", pose.x.size()));
  out.reserve(out.size() + 24 * pose.x.size());
  for (std::size_t k = 0; k < pose.x.size(); ++k)
    for (const double value : {pose.x[k], pose.y[k], pose.theta[k]}) put_little_endian(out, value);
  return out;
}

void require_length(const PoseTrack& pose, std::size_t n, const std::string& what) {
  if (pose.x.size() != n || pose.y.size() != n || pose.theta.size() != n)
    throw std::invalid_argument(fmt::format("tracks: {} has {}, {}, {} samples, expected {}", what,
                                            pose.x.size(), pose.y.size(), pose.theta.size(), n));
}

// The numbers of a file that must hold `count` of them, in the shape given.
std::vector<double> read_npy(const fs::path& file, const std::string& shape, std::size_t count) {
  const std::string bytes = read_file(file);
  const std::string header = npy_header(shape);
  if (bytes.compare(0, header.size(), header) != 0)
    throw DataError(
        fmt::format("{}: expected a NumPy array of float64 with shape ({})", file.string(), shape));
  if (bytes.size() != header.size() + 8 * count)
    throw DataError(fmt::format("{}: {} bytes of data, expected {}", file.string(),
                                bytes.size() - header.size(), 8 * count));
  std::vector<double> values(count);
  for (std::size_t i = 0; i < count; ++i) values[i] = little_endian(bytes.data() + header.size() + 8 * i);
  return values;
}

PoseTrack read_pose(const fs::path& file, std::size_t n) {
  const std::vector<double> values = read_npy(file, fmt::format("{}, 3", n), 3 * n);
  PoseTrack pose{std::vector<double>(n), std::vector<double>(n), std::vector<double>(n)};
  for (std::size_t k = 0; k < n; ++k) {
    pose.x[k] = values[3 * k];
    pose.y[k] = values[3 * k + 1];
    pose.theta[k] = values[3 * k + 2];
  }
  return pose;
}

// A file of the folder itself: an index from elsewhere must not read other places.
fs::path file_in(const fs::path& folder, const JsonNode& name) {
  const fs::path path = name.text();
  if (path.empty() || path != path.filename()) name.fail("the name of a file in the same folder");
  return folder / path;
}

TrackSet read_index(const JsonNode& root, const fs::path& folder) {
  if (root.at("schema_version").integer() != kTracksSchemaVersion)
    root.at("schema_version").fail(fmt::format("{}", kTracksSchemaVersion));
  TrackSet set;
  set.problem = root.at("problem").text();
  set.dataset = root.at("dataset").text();
  set.dataset_sha256 = root.at("dataset_sha256").text();
  std::size_t n = 0;
  for (const JsonNode& item : root.at("recordings").elements()) {
    const std::int64_t samples = item.at("samples").integer();
    if (samples < 1 || samples > 1'000'000'000) item.at("samples").fail("a number of samples");
    set.recordings.push_back({item.at("id").text(), item.at("trajectory").text(),
                              item.at("repetition").small_integer(), n, static_cast<std::size_t>(samples),
                              false});
    if (const auto left_out = item.find("left_out")) set.recordings.back().left_out = left_out->boolean();
    n += static_cast<std::size_t>(samples);
  }
  set.time_s = read_npy(file_in(folder, root.at("time")), fmt::format("{},", n), n);
  set.reference = read_pose(file_in(folder, root.at("reference")), n);
  for (const JsonNode& item : root.at("tracks").elements()) {
    set.tracks.push_back({item.at("label").text(), item.at("repetition").small_integer(),
                          read_pose(file_in(folder, item.at("file")), n)});
  }
  return set;
}

}  // namespace

std::vector<std::pair<fs::path, std::string>> track_files(const TrackSet& set) {
  const std::size_t n = set.time_s.size();
  std::size_t samples = 0;
  json index{
      {"schema_version", kTracksSchemaVersion}, {"problem", set.problem},      {"dataset", set.dataset},
      {"dataset_sha256", set.dataset_sha256},   {"recordings", json::array()}, {"time", "time.npy"},
      {"reference", "reference.npy"},           {"tracks", json::array()}};
  for (const TrackRecording& r : set.recordings) {
    samples += r.samples;
    index["recordings"].push_back(
        {{"id", r.id}, {"trajectory", r.trajectory}, {"repetition", r.repetition}, {"samples", r.samples}});
    if (r.left_out) index["recordings"].back()["left_out"] = true;
  }
  if (samples != n)
    throw std::invalid_argument(
        fmt::format("tracks: the recordings have {} samples, the times {}", samples, n));
  require_length(set.reference, n, "the reference");
  const fs::path folder = kFolder;
  std::vector<std::pair<fs::path, std::string>> files{{folder / "time.npy", npy(set.time_s)},
                                                      {folder / "reference.npy", npy(set.reference)}};
  for (std::size_t i = 0; i < set.tracks.size(); ++i) {
    const StoredTrack& track = set.tracks[i];
    require_length(track.pose, n, track.label);
    const std::string name = fmt::format("{}.npy", i + 1);
    index["tracks"].push_back({{"label", track.label}, {"repetition", track.repetition}, {"file", name}});
    files.emplace_back(folder / name, npy(track.pose));
  }
  files.emplace_back(folder / "tracks.json",
                     index.dump(1, ' ', false, json::error_handler_t::replace) + "\n");
  return files;
}

std::optional<TrackSet> read_tracks(const fs::path& run_directory) {
  const fs::path folder = run_directory / kFolder;
  const fs::path file = folder / "tracks.json";
  if (!fs::exists(file)) return std::nullopt;
  return read_index(JsonNode::read(file), folder);
}

}  // namespace odobench
