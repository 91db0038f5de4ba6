#include "bench/options/filter_options.hpp"

#include <fmt/format.h>

#include <stdexcept>

#include "bench/catalogue/number_text.hpp"
#include "bench/options/common_options.hpp"

namespace odobench {
namespace {

constexpr const char* kFilterExamples = R"(Examples:
  bench filter --data=run.csv --out=filtered.csv
  bench filter --data=run.csv --truth=truth.csv --solver=exact --gap
  bench filter --data=drive.mcap --map=map.json --out=filtered.csv
  bench filter --data=thesis.csv --as-published --out=thesis_po.csv
  bench filter --data=other.csv --columns=time=t,enc1=w1,enc2=w2,enc3=w3,enc4=w4,yaw_rad=heading
Columns: time_s, enc1_m..enc4_m, ax_m_s2, ay_m_s2, one of yaw_step_deg, yaw_step_rad, yaw_rate_deg_s,
yaw_rate_rad_s, yaw_deg, yaw_rad, and, if you like, psi1_deg..psi4_deg or psi1_rad..psi4_rad.)";

void add_positive(CLI::App& app, const std::string& name, const char* unit, double& field, const char* help) {
  add_value(app, name, unit, fmt::format("{} [{:.9g}]", help, field),
            [&field, name](const std::string& text) { field = finite_number(name, text, true, 1e6); });
}

void add_constants(CLI::App& app, EntropyOptions& o) {
  EntropyConstants& c = o.constants;
  add_value(app, "--samples", "N", fmt::format("samples in a window [{}]", c.samples),
            [&c](const std::string& text) {
              c.samples = static_cast<int>(whole_number("--samples", text, 3, 1000));
            });
  add_value(app, "--dt", "S", "sampling period [the first step of time_s, the median where steps differ]",
            [&o](const std::string& text) { o.dt = finite_number("--dt", text, true, 3600); });
  app.add_flag("--resample", o.resample,
               "where rows are missing (steps of 2 to 11 periods) fill them in, linearly");
  add_value(app, "--time-tolerance", "X",
            "of a time step against the sampling period, relative [0.4: stamps of arrival jitter]",
            [&o](const std::string& text) {
              o.time_tolerance = finite_number("--time-tolerance", text, true, 1e3);
            });
  add_positive(app, "--sigma-encoder", "M", c.sigma_encoder, "deviation of a wheel displacement");
  add_positive(app, "--sigma-acceleration", "M/S^2", c.sigma_acceleration, "deviation of an acceleration");
  add_positive(app, "--sigma-rotation", "DEG", c.sigma_rotation, "deviation of a rotation per step");
  add_positive(app, "--length", "M", c.length, "wheel base");
  add_positive(app, "--width", "M", c.width, "track");
  add_positive(app, "--wheel-distance", "M", c.wheel_distance, "L, from the centre to a wheel");
  add_positive(app, "--step-acceleration", "M/S^2", c.step_acceleration, "size of an acceleration increment");
  add_value(
      app, "--step-rotation", "DEG/S^2",
      "size of an angular acceleration [0.490189596, which is 0.0085554224 rad/s^2]",
      [&o](const std::string& text) { o.step_rotation = finite_number("--step-rotation", text, true, 1e6); });
}

// Where the thesis' program departs from its model.
void add_meanings(CLI::App& app, EntropyOptions& o) {
  app.add_flag("--as-published", o.as_published,
               "everything as in the thesis' program; the next four options win over it");
  add_value(
      app, "--theta", "MEANING",
      "of the column theta in the thesis' layout: step-deg, step-rad, rate-deg, rate-rad, absolute-deg, "
      "absolute-rad, or raw: as it stands, in any layout [step-deg; published: raw]",
      [&o](const std::string& text) { o.theta = text; });
  add_value(app, "--accelerometer-frame", "robot|filter",
            "frame of the accelerations; those of the robot are turned [robot; published: filter]",
            [&o](const std::string& text) { o.accelerometer_frame = text; });
  add_value(app, "--omega-cross-v", "on|off",
            "take omega x v off the accelerations: the frame turns with the robot [on; published: off]",
            [&o](const std::string& text) {
              if (text != "on" && text != "off")
                throw std::invalid_argument(fmt::format("--omega-cross-v={}: expected on or off", text));
              o.omega_cross_v = text == "on";
            });
  add_value(app, "--wheel-order", "right-first|left-first",
            "wheels 1 to 4: front right, rear right, rear left, front left, or rear left, front left, front "
            "right, rear right [right-first]",
            [&o](const std::string& text) { o.wheel_order = text; });
}

}  // namespace

void add_filter_options(CLI::App& app, FilterOptions& options) {
  EntropyOptions& o = options.study;
  app.add_option("--data", o.data,
                 "measurements, a row per step; '-' is standard input. With --map logs of any format")
      ->required()
      ->type_name("RUN.CSV|LOG,...");
  app.add_option("--map", o.map,
                 "of logs: robot, wheels, gyro.z, accel.x and accel.y, as for bench import (docs/logs.md)")
      ->type_name("MAP.JSON");
  app.add_option(
         "--solver", o.solver,
         "coordinate, exact, relaxed, zero (no increments), or any solver with its options [coordinate]")
      ->type_name("NAME");
  app.add_option("--truth", o.truth,
                 "what really happened, a row for each row of the data: errors are measured")
      ->type_name("FILE.CSV");
  app.add_option("--out", o.out, "file for the filtered run, a row per window")->type_name("FILE.CSV");
  app.add_option("--columns", o.columns, "names of columns in the data where they differ: name=column,...")
      ->type_name("LIST")
      ->allow_extra_args(false);
  app.add_option("--truth-columns", o.truth_columns, "the same for the truth")
      ->type_name("LIST")
      ->allow_extra_args(false);
  app.add_flag("--gap", o.gap, "measure how far H is from the best and from the relaxation");
  add_value(app, "--compare", "kalman",
            "beside it a linear Kalman filter and smoother on the same rows; with --truth",
            [&o](const std::string& text) {
              if (text != "kalman")
                throw std::invalid_argument(fmt::format("--compare={}: expected kalman", text));
              o.compare_kalman = true;
            });
  app.add_option("--records", options.records, "folder for the run record (runs.jsonl) and tables.*")
      ->type_name("DIR");
  add_constants(app, o);
  add_meanings(app, o);
  add_seed(app, o.seed, "of a solver that draws random numbers [1]");
  add_kernel(app, o.kernel, kSpeedOnly);
  add_budget(app, o.budget);
  app.add_flag("--overwrite", o.overwrite, "replace files that are there");
  app.add_option("--format", options.format, "of the tables on standard output [console]")
      ->type_name("console|md|csv|json|latex");
  app.add_flag("--quiet", options.quiet, "no progress on standard error");
  app.footer(kFilterExamples);
}

}  // namespace odobench
