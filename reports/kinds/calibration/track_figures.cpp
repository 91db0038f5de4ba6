#include "reports/kinds/calibration/track_figures.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <span>
#include <utility>
#include <vector>

#include "reports/figures/decimate.hpp"
#include "reports/figures/vega.hpp"

namespace odobench {
namespace {

using vega::json;

constexpr double kSquareWidth = 440;                              // px, where both axes have one scale
constexpr double kPathResolution = 1200, kErrorResolution = 300;  // parts of a range

using Columns = std::array<std::vector<double>, 3>;  // x, y, theta

std::span<const double> part(const std::vector<double>& values, const TrackRecording& recording) {
  return std::span(values).subspan(recording.begin, recording.samples);
}

Columns pose_of(const PoseTrack& pose, const TrackRecording& r) {
  const auto copy = [&](const std::vector<double>& v) {
    const auto s = part(v, r);
    return std::vector<double>(s.begin(), s.end());
  };
  return {copy(pose.x), copy(pose.y), copy(pose.theta)};
}

// One curve of a trajectory: a method (0: the reference) over a drive.
struct Curve {
  std::size_t series = 0;
  int drive = 0;
  std::span<const double> time;
  Columns values;
};

struct Trajectory {
  std::string name;
  std::vector<int> drives;
  std::vector<int> left_out;  // of the drives
  std::vector<std::string> ids_left_out;
  std::vector<Curve> paths, errors;
};

Columns absolute_errors(const Columns& pose, const Columns& reference) {
  Columns errors;
  for (std::size_t c = 0; c < 3; ++c)
    for (std::size_t k = 0; k < pose[c].size(); ++k)
      errors[c].push_back(std::abs(pose[c][k] - reference[c][k]));
  return errors;
}

std::vector<Trajectory> trajectories_of(const TrackSet& set) {
  std::vector<Trajectory> list;
  for (const TrackRecording& r : set.recordings) {
    auto at =
        std::find_if(list.begin(), list.end(), [&](const Trajectory& t) { return t.name == r.trajectory; });
    if (at == list.end()) at = list.insert(list.end(), {r.trajectory, {}, {}, {}, {}, {}});
    at->drives.push_back(r.repetition);
    if (r.left_out) {
      at->left_out.push_back(r.repetition);
      at->ids_left_out.push_back(r.id);
    }
    const auto time = part(set.time_s, r);
    const Columns reference = pose_of(set.reference, r);
    at->paths.push_back({0, r.repetition, time, reference});
    for (std::size_t i = 0; i < set.tracks.size(); ++i) {
      Columns pose = pose_of(set.tracks[i].pose, r);
      at->errors.push_back({i + 1, r.repetition, time, absolute_errors(pose, reference)});
      at->paths.push_back({i + 1, r.repetition, time, std::move(pose)});
    }
  }
  return list;
}

std::array<double, 3> ranges(const std::vector<Curve>& curves) {
  std::array<double, 3> result{};
  for (std::size_t c = 0; c < 3; ++c) {
    double low = INFINITY, high = -INFINITY;
    for (const Curve& curve : curves)
      for (const double v : curve.values[c])
        if (std::isfinite(v)) low = std::min(low, v), high = std::max(high, v);
    result[c] = high > low ? high - low : 1;
  }
  return result;
}

// Rows t,d,s,a,b,c: time, drive, series, the three values; thinned as finely as stays within `rows`, to 1 /
// `parts` of the range.
std::string path_rows(const std::vector<Curve>& curves, std::size_t rows, double& parts) {
  const std::array<double, 3> range = ranges(curves);
  std::vector<std::vector<std::size_t>> kept(curves.size());
  for (parts = kPathResolution;; parts /= 1.3) {
    std::size_t count = 0;
    for (std::size_t i = 0; i < curves.size(); ++i) {
      std::vector<DecimatedChannel> channels;
      for (std::size_t c = 0; c < 3; ++c) channels.push_back({curves[i].values[c], range[c] / parts});
      kept[i] = decimate(curves[i].time, channels);
      count += kept[i].size();
    }
    if (count <= rows || parts < 20) break;
  }
  std::string csv = "t,d,s,a,b,c\n";
  for (std::size_t i = 0; i < curves.size(); ++i)
    for (const std::size_t k : kept[i])
      fmt::format_to(std::back_inserter(csv), "{:.6g},{},{},{:.6g},{:.6g},{:.6g}\n", curves[i].time[k],
                     curves[i].drive, curves[i].series, curves[i].values[0][k], curves[i].values[1][k],
                     curves[i].values[2][k]);
  return csv;
}

// A plot of y over x with the same scale on both axes, where that is not too flat or too high to read.
struct Frame {
  std::array<double, 2> x{}, y{};  // domains
  double aspect = 0;               // height / width; 0: each axis has a scale of its own
};

Frame frame_of(const std::vector<Curve>& paths) {
  std::array<std::array<double, 2>, 2> domain{{{INFINITY, -INFINITY}, {INFINITY, -INFINITY}}};
  for (const Curve& curve : paths)
    for (std::size_t c = 0; c < 2; ++c)
      for (const double v : curve.values[c])
        if (std::isfinite(v)) domain[c] = {std::min(domain[c][0], v), std::max(domain[c][1], v)};
  Frame frame{domain[0], domain[1], 0};
  const double width = frame.x[1] - frame.x[0], height = frame.y[1] - frame.y[0];
  if (!(width > 0) || !(height > 0) || height < 0.3 * width || height > 1.6 * width) return frame;
  const double margin = 0.03 * std::max(width, height);
  frame.x = {frame.x[0] - margin, frame.x[1] + margin};
  frame.y = {frame.y[0] - margin, frame.y[1] + margin};
  frame.aspect = (height + 2 * margin) / (width + 2 * margin);
  return frame;
}

// Rows c,t,d,s,e: variable, time, drive, series, error. The noise of the reference does not let tolerances
// save much: a curve that would need more than two rows per stretch is shown by the extremes of the
// stretches.
std::string error_rows(const std::vector<Curve>& curves, std::size_t stretches) {
  const std::array<double, 3> range = ranges(curves);
  std::string csv = "c,t,d,s,e\n";
  const auto text = std::back_inserter(csv);
  for (const Curve& curve : curves)
    for (std::size_t c = 0; c < 3; ++c) {
      std::vector<std::size_t> kept = decimate(curve.time, {{curve.values[c], range[c] / kErrorResolution}});
      if (kept.size() > 2 * stretches) kept = extremes(curve.values[c], stretches);
      for (const std::size_t k : kept)
        fmt::format_to(text, "{},{:.5g},{},{},{:.6g}\n", c, curve.time[k], curve.drive, curve.series,
                       curve.values[c][k]);
    }
  return csv;
}

class Charts {
 public:
  Charts(const TrackSet& set, const Trajectory& trajectory) : left_out_(trajectory.left_out) {
    labels_.push_back(vega::kReferenceLabel);
    for (const StoredTrack& track : set.tracks) labels_.push_back(track.label);
    methods_.assign(labels_.begin() + 1, labels_.end());
    choices_ = {vega::choice_of("method", "Method", "all methods", methods_), drive_choice(trajectory)};
  }

  json path(const std::string& data, const std::string& caption, const Frame& frame) const {
    json spec =
        specification(data, caption, {{"height", 380}, {"layer", layers("a", "x [m]", "b", "y [m]", true)}});
    if (frame.aspect == 0) return spec;
    spec["width"] = kSquareWidth;
    spec["height"] = std::round(kSquareWidth * frame.aspect);
    spec["usermeta"]["odobench"]["aspect"] = "equal";
    for (json& layer : spec["layer"]) {
      layer["encoding"]["x"]["scale"] = {{"domain", frame.x}, {"nice", false}};
      layer["encoding"]["y"]["scale"] = {{"domain", frame.y}, {"nice", false}};
    }
    return spec;
  }

  // x, y, heading over time.
  json poses(const std::string& data, const std::string& caption) const {
    const std::array<const char*, 3> columns{"a", "b", "c"}, titles{"x [m]", "y [m]", "heading [rad]"};
    json views = json::array();
    for (std::size_t c = 0; c < 3; ++c)
      views.push_back({{"width", kFigureWidth},
                       {"height", 150},
                       {"layer", layers("t", time_title(c), columns[c], titles[c], true)}});
    return specification(data, caption, {{"vconcat", views}});
  }

  json errors(const std::string& data, const std::string& caption) const {
    const std::array<const char*, 3> titles{"|e_x| [m]", "|e_y| [m]", "|e_heading| [rad]"};
    json views = json::array();
    for (std::size_t c = 0; c < 3; ++c)
      views.push_back({{"width", kFigureWidth},
                       {"height", 150},
                       {"transform", {vega::filter(fmt::format("datum.c == {}", c))}},
                       {"layer", layers("t", time_title(c), "e", titles[c], false)}});
    return specification(data, caption, {{"vconcat", views}});
  }

 private:
  static const char* time_title(std::size_t panel) { return panel == 2 ? "time [s]" : ""; }

  static vega::Choice drive_choice(const Trajectory& trajectory) {
    vega::Choice choice{"drive", "Drive", {}, std::to_string(trajectory.drives.front())};
    for (const int drive : trajectory.drives) {
      const bool out = std::count(trajectory.left_out.begin(), trajectory.left_out.end(), drive) > 0;
      choice.options.emplace_back(std::to_string(drive),
                                  fmt::format("{}{}", drive, out ? " (left out)" : ""));
    }
    choice.options.emplace_back("all", fmt::format("all {}", trajectory.drives.size()));
    return choice;
  }

  json specification(const std::string& data, const std::string& caption, json body) const {
    body["transform"] = {vega::name_of("s", labels_, "label"),
                         vega::filter("drive == 'all' || toString(datum.d) == drive"),
                         vega::filter("datum.s == 0 || method == 'all' || datum.label == method")};
    if (!body.contains("vconcat")) body["width"] = kFigureWidth;
    return vega::specification(caption, vega::csv_data(data, {"t", "d", "s", "a", "b", "c", "e"}), choices_,
                               body);
  }

  // The reference below, the methods above it.
  json layers(const std::string& x, const std::string& x_title, const std::string& y,
              const std::string& y_title, bool with_reference) const {
    json encoding{{"x", vega::quantitative(x, x_title)},
                  {"y", vega::quantitative(y, y_title)},
                  {"order", {{"field", "t"}, {"type", "quantitative"}}},
                  {"detail", {{{"field", "d"}, {"type", "nominal"}}}}};
    std::vector<std::string> named = methods_;
    if (with_reference) named.emplace_back(vega::kReferenceLabel);
    encoding["color"] = vega::line_color("label", named);
    json reference{{"transform", {vega::filter("datum.s == 0")}},
                   {"mark", {{"type", "line"}, {"style", "reference"}}},
                   {"encoding", encoding}};
    json methods{
        {"transform", {vega::filter("datum.s > 0")}}, {"mark", {{"type", "line"}}}, {"encoding", encoding}};
    json all = with_reference ? json::array({reference, methods}) : json::array({methods});
    if (left_out_.empty()) return all;
    const std::string out = fmt::format("indexof([{}], datum.d) >= 0", fmt::join(left_out_, ", "));
    all.back()["transform"].push_back(vega::filter("!(" + out + ")"));
    json apart = methods;
    apart["transform"].push_back(vega::filter(out));
    apart["mark"] = {{"type", "line"}, {"strokeDash", {2, 3}}, {"opacity", 0.6}};
    all.push_back(std::move(apart));
    return all;
  }

  std::vector<int> left_out_;
  std::vector<std::string> labels_, methods_;
  std::vector<vega::Choice> choices_;
};

}  // namespace

void add_track_figures(const TrackSet& set, const std::string& prefix, Section& section, Document& document,
                       std::size_t rows) {
  const std::vector<Trajectory> list = trajectories_of(set);
  const std::size_t curves = std::max<std::size_t>(1, set.recordings.size() * set.tracks.size());
  const std::size_t stretches = std::max<std::size_t>(10, 3 * rows / (6 * curves));
  for (const Trajectory& t : list) {
    const Charts charts(set, t);
    const std::string name = vega::slug(t.name);
    const std::string path_data = prefix + "tracks." + name, error_data = prefix + "errors." + name;
    double parts = 0;
    document.datasets[path_data] = path_rows(t.paths, rows / list.size(), parts);
    document.datasets[error_data] = error_rows(t.errors, stretches);
    std::string thinned = fmt::format("Curves are thinned to within 1/{:.0f} of the range.", parts);
    std::string left_out;
    if (!t.ids_left_out.empty())
      left_out = fmt::format(" Dotted: {}, left out of the calibration.", fmt::join(t.ids_left_out, ", "));
    thinned += left_out;
    const auto add = [&](const std::string& kind, const std::string& title, const std::string& caption,
                         json spec) {
      section.blocks.push_back(
          Figure{prefix + kind + "." + name, t.name + ": " + title, caption, std::move(spec)});
    };
    const Frame frame = frame_of(t.paths);
    std::string caption =
        fmt::format("Position y over x in metres{}; dashed: motion capture. {}",
                    frame.aspect == 0 ? ", each axis with a scale of its own" : "", thinned);
    add("path", "path", caption, charts.path(path_data, caption, frame));
    caption = "Position in metres and heading in radians; dashed: motion capture. " + thinned;
    add("pose", "x, y and heading over time", caption, charts.poses(path_data, caption));
    caption = fmt::format(
        "Distance from motion capture in x, y [m] and heading [rad]. Of longer curves the smallest and the "
        "largest value of "
        "each of {} stretches is drawn: no extreme is hidden.{}",
        stretches, left_out);
    add("error", "absolute errors over time", caption, charts.errors(error_data, caption));
  }
}

void add_track_figures(const PlacedTracks& tracks, Section& section, Document& document) {
  const std::size_t before = section.blocks.size();
  add_track_figures(*tracks.set, tracks.prefix, section, document, tracks.rows);
  for (std::size_t b = before; b < section.blocks.size(); ++b)
    std::get<Figure>(section.blocks[b]).title += tracks.suffix;
}

}  // namespace odobench
