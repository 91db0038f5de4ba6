// Looks at recordings before anything is fitted to them.
//
// u_i is the velocity of wheel i by the reference, m_i by the wheel itself, both through one filter (the
// slope of a local line, statistics.hpp), k_i the slope of u_i over m_i and E what is left of the squares
// (drive_view.hpp). From these: units, signs, exchanged columns, lags, frames, slip. What is recognised is
// corrected in a copy before the next check, so that one fault does not hide the next. docs/inspect.md
// describes every kind.
#pragma once

#include <span>
#include <vector>

#include "datasets/recording.hpp"
#include "datasets/robots/robot.hpp"
#include "problems/inspection/drive_set.hpp"
#include "problems/inspection/finding.hpp"

namespace odobench::inspection {

// Findings in the order of the checks: recording by recording, then of the set. `threads`: of the work on
// single recordings (0: one per core); the findings do not depend on it. What needs the reference at every
// stamp is not asked of recordings that lack it. O(samples). Throws std::invalid_argument for a robot that
// WheeledRobot refuses and a signal that a recording lacks, DataError where the wheels do not tell the twist.
// `kept_samples`: larger sets are looked at recording by recording; findings do not depend on it.
std::vector<Finding> inspect(const Robot& robot, std::span<const Recording> recordings, int threads = 1,
                             std::size_t kept_samples = kKeptSamples);

}  // namespace odobench::inspection
