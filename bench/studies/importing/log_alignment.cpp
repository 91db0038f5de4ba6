#include "bench/studies/importing/log_alignment.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <boost/math/tools/minima.hpp>
#include <cmath>
#include <memory>
#include <optional>

#include "base/angle.hpp"
#include "base/error.hpp"
#include "bench/catalogue/problem_factory.hpp"
#include "bench/studies/importing/clock_offset.hpp"
#include "problems/calibration/classical/sensor_mount.hpp"
#include "solvers/solve.hpp"

namespace odobench {
namespace {

using log_import::Adjustment;
using log_import::LoadedLogs;
using log_import::LogCurves;
using log_import::LogMap;
using log_import::MappedSource;

constexpr double kRefine = 0.02;       // s to either side
constexpr int kRefineBits = 18;        // of its width
constexpr double kWorthSaying = 0.02;  // s
constexpr double kSharp = 0.8;         // correlation

struct Fit {
  double mean_square = 0;
  log_import::Mount mount;
};

// The robot's parameters and, but of headings, the mount, fitted to all drives.
Fit fit(const Dataset& dataset) {
  CalibrationChoice choice = choice_for(dataset.reference, {});
  choice.mount = dataset.reference != ReferenceKind::Headings;
  const auto problem = std::make_shared<const CalibrationProblem>(dataset.robot, dataset.recordings,
                                                                  calibration_options(dataset.robot, choice));
  const Problem wrapped(problem);
  const Result found = solve(wrapped, parse_solver_list("lm").front(), wrapped.start(), {});
  if (!found.usable()) throw DataError(dataset.name + ": no calibration, so nothing to align clocks by");
  const Eigen::Index n = found.x.size();
  const double mean_square = found.cost / static_cast<double>(problem->residual_count());
  if (!choice.mount) return {mean_square, {}};
  return {mean_square, {found.x[n - 3], found.x[n - 2], found.x[n - 1]}};
}

// The tracked frame at `beside` in a frame that sits at `outer` in the robot's.
log_import::Mount composed(const log_import::Mount& outer, const log_import::Mount& beside) {
  const double c = std::cos(outer.yaw), s = std::sin(outer.yaw);
  return {outer.x + c * beside.x - s * beside.y, outer.y + s * beside.x + c * beside.y,
          wrapped_angle(outer.yaw + beside.yaw)};
}

// The drives of one log with this much beside the map's offset, the tracked frame about at this place.
Dataset shifted(const LoadedLogs& loaded, std::size_t log, const std::string& source, double offset,
                const log_import::Mount& about) {
  LoadedLogs one;
  one.map = loaded.map;
  one.map.names.clear();
  one.logs = {loaded.logs[log]};
  return make_dataset(one, {{{{source, offset}}}, about});
}

// The source whose clock is to be found, if any.
std::optional<std::string> wanted_source(const LogMap& map) {
  std::optional<std::string> wanted;
  const std::string& reference = map.reference.front().source;
  for (const MappedSource& source : map.sources) {
    if (source.offset_s) continue;
    if (source.name != reference)
      throw DataError(
          fmt::format("{}: /sources/{}/offset_s: \"estimate\" of a source that is not the "
                      "reference, expected it of the reference's clock alone",
                      map.file, source.name));
    wanted = source.name;
  }
  if (wanted)
    for (const log_import::MappedSignal& signal : map.signals)
      if (signal.at.source == *wanted)
        throw DataError(
            fmt::format("{}: /sources/{}/offset_s: \"estimate\" where wheels have the same clock, "
                        "expected a number",
                        map.file, *wanted));
  return wanted;
}

class Aligner {
 public:
  Aligner(const LoadedLogs& loaded, const Stop& stop) : loaded_(loaded), stop_(stop) {
    out_.adjustment = adjustment_of(loaded.map);
  }

  LogAlignment align() {
    if (loaded_.map.reference.empty()) return std::move(out_);  // end poses: nothing to align by
    const std::optional<std::string> wanted = wanted_source(loaded_.map);
    std::vector<std::optional<ClockOffset>> rough;
    for (const LogCurves& log : loaded_.logs) {
      stop_.check();
      rough.push_back(clock_offset(loaded_.map, log));
      if (wanted && !rough.back())
        throw DataError(
            fmt::format("{}: no clock offset can be estimated: no turn faster than 0.1 rad/s that "
                        "wheels and reference share; give offset_s",
                        log.id));
      if (wanted)
        out_.adjustment.offsets.push_back({{*wanted, rough.back()->seconds}});
      else if (rough.back())
        compare(log, *rough.back());
    }
    about_ = out_.adjustment.mount;
    if (loaded_.map.estimate_mount) place_roughly();
    for (std::size_t k = 0; wanted && k < loaded_.logs.size(); ++k)
      out_.adjustment.offsets[k] = {{*wanted, find(k, *wanted, *rough[k])}};
    if (loaded_.map.estimate_mount) find_mount();
    return std::move(out_);
  }

 private:
  // Fits know places of up to 0.25 m and 0.2 rad: a frame that sits elsewhere, or is turned, is brought near.
  void place_roughly() {
    Adjustment none = out_.adjustment;
    none.mount = {};
    const Dataset drives = make_dataset(loaded_, none);
    if (const auto found = classical::sensor_mount(drives.robot, drives.recordings))
      about_ = {(*found)[0], (*found)[1], (*found)[2]};
  }

  double find(std::size_t log, const std::string& source, const ClockOffset& rough) {
    const std::string& id = loaded_.logs[log].id;
    std::uintmax_t most = 60;
    // Of the difference, since an offset of years has no digits left for microseconds of it.
    const auto [beside, lowest] = boost::math::tools::brent_find_minima(
        [&](double d) {
          stop_.check();
          return fit(shifted(loaded_, log, source, rough.seconds + d, about_)).mean_square;
        },
        -kRefine, kRefine, kRefineBits, most);
    const double offset = rough.seconds + beside;
    out_.report.push_back(
        fmt::format("{}: clock of {} runs {:.5f} s ahead of the wheels: applied (by yaw rates {:.4f} s at "
                    "correlation {:.4f}, "
                    "then by the fit: rms {:.3g})",
                    id, source, offset, rough.seconds, rough.correlation, std::sqrt(lowest)));
    return offset;
  }

  // The map states the clocks; the logs may disagree.
  void compare(const LogCurves& log, const ClockOffset& rough) {
    const std::string& source = loaded_.map.reference.front().source;
    const std::string text = fmt::format(
        "{}: by yaw rates the clock of {} runs {:.3f} s ahead of the wheels (correlation {:.4f}, {:.4f} "
        "without)",
        log.id, source, rough.seconds, rough.correlation, rough.at_zero);
    if (std::abs(rough.seconds) > kWorthSaying && rough.correlation > kSharp)
      out_.warnings.push_back(text + ": not applied; \"offset_s\": \"estimate\" does");
    else
      out_.report.push_back(text);
  }

  void find_mount() {
    Adjustment near = out_.adjustment;
    near.mount = about_;
    out_.adjustment.mount = composed(fit(make_dataset(loaded_, near)).mount, about_);
    const log_import::Mount& m = out_.adjustment.mount;
    out_.report.push_back(
        fmt::format("the tracked frame sits at x = {:.2f} mm, y = {:.2f} mm, yaw = {:.3f} deg in the "
                    "robot's frame: applied",
                    1e3 * m.x, 1e3 * m.y, m.yaw / kDegree));
  }

  const LoadedLogs& loaded_;
  const Stop& stop_;
  log_import::Mount about_;  // where fits begin to look for the tracked frame
  LogAlignment out_;
};

}  // namespace

LogAlignment align_logs(const LoadedLogs& loaded, const Stop& stop) {
  return Aligner(loaded, stop).align();
}

}  // namespace odobench
