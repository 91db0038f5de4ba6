// What the verbs of the command line are: for each its options, added to `app`, and what it then does.
//
// Every action may throw std::invalid_argument (wrong usage), DataError (wrong data, with file:line),
// Interruption (before anything is written); nothing partial is left then.
#pragma once

#include <CLI/App.hpp>

#include "bench/verbs/verb.hpp"

namespace odobench {

// `bench run`: solvers on a problem, from options to records and tables.
//
// Tables on standard output, everything else on standard error. Throws std::invalid_argument on options that
// make no sense (nothing is run or written then), DataError on a bad set.
VerbAction add_run(CLI::App& app);

// `bench campaign FILE --out=STORE`: a matrix of runs, kept in a store, that goes on where it was ended.
//
// A table of what was kept and run on standard output. Throws std::invalid_argument on options that make no
// sense and on a store that belongs to another process or campaign, DataError on a bad campaign file.
VerbAction add_campaign(CLI::App& app);

// `bench store info|query|export|import STORE`: what is in a store, and records in and out.
VerbAction add_store(CLI::App& app);

// `bench calibrate LOG...`: from logs to parameters in one go.
//
// Short tables on standard output; what was assumed on standard error. Throws std::invalid_argument where
// the log leaves open what may not be assumed, with the options that would say it.
VerbAction add_calibrate(CLI::App& app);

// `bench filter`: the relative-entropy filter over a whole recorded run, row by row.
//
// Throws std::invalid_argument on wrong usage, DataError with file:line on bad data; no file is left then.
// Ctrl-C ends the run after the window at hand: file, record and tables hold the windows so far, Interrupted
// is returned; before the first window Interruption is thrown.
VerbAction add_filter(CLI::App& app);

// `bench windows`: the windows of a file solved by several methods, compared.
//
// Throws std::invalid_argument on wrong usage, DataError on a bad file. Ctrl-C keeps what is complete, like
// `bench run`.
VerbAction add_windows(CLI::App& app);

// `bench import`: data sets from raw files.
//
// Throws std::invalid_argument on an unknown source or a set that is there already, DataError with file:line
// on bad raw files, Interruption on Ctrl-C; nothing is written then.
VerbAction add_import(CLI::App& app);

// `bench demo`: the demo data set, made anew.
VerbAction add_demo(CLI::App& app);

// `bench evaluate`: J and error tables of given parameters.
//
// Parameters outside the box are evaluated with a warning on standard error.
VerbAction add_evaluate(CLI::App& app);

// `bench inspect SET`: findings about the recordings of a set; with --fix a mended set.
//
// CheckFailed where one of them is an error. Throws std::invalid_argument on wrong usage, DataError on a bad
// set.
VerbAction add_inspect(CLI::App& app);

// `bench list solvers|problems|data [set.json]`.
//
// Throws std::invalid_argument on anything else to list, DataError on a bad set.
VerbAction add_list(CLI::App& app);

// `bench report`: what people look at, from stored records alone.
//
// The tables on standard output; with `out` one HTML page, with `figures` an SVG file per figure instead.
VerbAction add_report(CLI::App& app);

// `bench export`: parameters and trajectories of stored runs for other programs.
//
// --to: the parameters of one row as text (docs/export.md) to a file or standard output; what the target
// cannot say is a warning. Throws std::invalid_argument on an unknown target or row and on a robot that the
// target does not know, DataError where the folder has no calibrated parameters.
//
// --csv: OUT/LABEL/RECORDING.csv, "time_s,x,y,theta". --tum: trajectories in the format of the TUM RGB-D
// benchmark: lines "time x y z qx qy qz qw", seconds and metres, z = 0, the heading as a unit quaternion
// about z; OUT/LABEL/RECORDING.tum, the motion capture as OUT/reference/RECORDING.tum.
VerbAction add_export(CLI::App& app);

// `bench check`: what moved in stored records, without running anything.
//
// Prints what moved against the baseline; CheckFailed when something did. With `update` writes the baseline
// instead, keeping the tolerances of the one that is there, those of single entries included.
VerbAction add_check(CLI::App& app);

// `bench compare OLD NEW`: two sets of stored runs side by side.
//
// CheckFailed when a limit is passed and the change is sure.
VerbAction add_compare(CLI::App& app);

// `bench discretise`: F, Psi, Gamma and Q of a linear system for a period, exact or as a series cut after an
// order.
//
// console, md, csv: a table per matrix; json: the matrices as arrays of rows with all digits; latex: bmatrix
// environments (amsmath). Throws std::invalid_argument on a bad option, DataError on a bad file.
VerbAction add_discretise(CLI::App& app);

// `bench fuse`: wheel odometry of several parameter sets with several filters and synthetic sensors,
// compared.
VerbAction add_fuse(CLI::App& app);

// `bench tune`: the noise parameters of a filter, fitted by solvers on the first drive of each trajectory and
// judged on the others.
VerbAction add_tune(CLI::App& app);

// `bench simulate`: drives that never were, with their truth.
//
// Of kind recordings: DIR/set.json with its recordings, or with --raw abs_i.csv, odom_i.csv and SHA256SUMS as
// `bench import vitko2024` reads them; truth.json and truth.csv beside them. Of kind dynamics: sensors.csv,
// truth.csv, state.csv and robot.json. Throws std::invalid_argument on options that do not fit the scenario
// or on files that are there already, DataError on a bad scenario.
VerbAction add_simulate(CLI::App& app);

// `bench models`: nuisance parameters and richer models compared, fitted and held out.
//
// Table: J, totals of largest errors, of each recording by the fit without its repetition and without its
// trajectory, what each extra is taken for and which model to use. Throws std::invalid_argument on models
// that are none or do not suit the robot, DataError on a bad set.
VerbAction add_models(CLI::App& app);

// `bench plan`: which parameters a set of drives can determine, and which drives to add.
//
// Tables: standard deviation of every parameter, singular values with their directions, combinations that
// stay undetermined in words, and with --candidates the drives proposed. Throws std::invalid_argument on
// unknown drives or scenarios, DataError on a bad scenario.
VerbAction add_plan(CLI::App& app);

// `bench verify`: parameter sets judged on drives that they were not fitted to. The robot of a scenario is
// driven anew, closed loop, by each set as what it believes about itself.
//
// Tables per trajectory (e_max, e_sr, sigma of odometry against motion capture, as the thesis' tables 9 to
// 41), totals (table 42), and where the robot really ended; means over the repeats with half the width of
// their 95 % interval. All sets meet the same noise. "nominal" is always among them, as the reference of
// differences. Throws std::invalid_argument on unknown names, scenarios without a closed loop, sets called
// the same; DataError on bad files and on sets by which the robot cannot drive.
VerbAction add_verify(CLI::App& app);

}  // namespace odobench
