// Tables of runs of the relative-entropy filter (`bench filter`). Such a record has problem kFilterProblem,
// as cost the mean of -H over the windows, and these measures:
//   rows, windows, iterations_mean, iterations_max, evaluations_mean, windows_per_second
//   hamiltonian_mean, hamiltonian_min, hamiltonian_max
//   gain_mean, gain_max            H - H without increments, the control
//   gap_exact_mean, gap_exact_max, at_optimum     H_exact - H and the share of windows where it is 0 (see
//   below)
//   gap_relaxed_mean, gap_relaxed_max             H_relaxed - H
//   noise.CHANNEL.MEASURE.STAGE    CHANNEL encoder_component | encoder | ax | ay | theta, MEASURE rms | ratio
//                                  | max, STAGE before | after | zero (after the filter without increments);
//                                  of CHANNEL, in its unit
//   track.end.STAGE, track.max.STAGE   m, distance of the dead-reckoned from the true position
//   cpu.STAGE                      us per sample; STAGE after | kalman | smoother; where compared
// and these series (see also kSignals and gap_bin_name):
//   signal.width                          rows per bucket
//   signal.SIGNAL.STAGE.min, .max         of every bucket; STAGE before | after | truth
//   detail.SIGNAL.STAGE                   the first rows as they are
//   gap_counts                            windows per bin of H_exact - H
// What was not measured is absent. Errors e are against the truth; ratio = mean |e| / mean |truth|.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "reports/records/record.hpp"
#include "reports/render/table.hpp"

namespace odobench {

inline constexpr const char* kFilterProblem = "entropy_filter";

struct NoiseChannel {
  const char* id;
  const char* name;
  const char* unit;
};
inline constexpr std::array<NoiseChannel, 5> kNoiseChannels{{{"encoder_component", "encoders, x and y", "m"},
                                                             {"encoder", "encoders, magnitude", "m"},
                                                             {"ax", "ax", "m/s^2"},
                                                             {"ay", "ay", "m/s^2"},
                                                             {"theta", "rotation", "deg"}}};
inline constexpr std::array<const char*, 3> kNoiseMeasures{"rms", "ratio", "max"};
inline constexpr std::array<const char*, 3> kNoiseStages{"before", "after", "zero"};
// With --compare=kalman two more: the linear filter, which is not late, and the linear smoother, as late as
// the relative-entropy filter.
inline constexpr std::array<const char*, 2> kComparedStages{"kalman", "smoother"};

// Signals of the figures: mean displacement of the wheels per sample, accelerations, rotation per sample.
inline constexpr std::array<NoiseChannel, 4> kSignals{
    {{"encoder", "wheels", "m"}, {"ax", "ax", "m/s^2"}, {"ay", "ay", "m/s^2"}, {"theta", "rotation", "deg"}}};
inline constexpr std::array<const char*, 3> kSignalStages{"before", "after", "truth"};

// A window counts as solved to the optimum when H_exact - H <= this * |H_exact|: what is above it is another
// t, not rounding.
inline constexpr double kSameOptimum = 1e-9;

// Bin 0: at the optimum. Bin k: from kGapLowest * 10^((k-1)/2) on, half a decade each.
inline constexpr std::size_t kGapBins = 22;
inline constexpr double kGapLowest = 1e-6;
// Of a gap H_exact - H.
std::size_t gap_bin(double gap, double hamiltonian_exact);
std::string gap_bin_name(std::size_t bin);  // "0", "1e-06 .. 3.2e-06"

//   filter         a row per record: windows, iterations, H, gain, gaps, speed
//   noise.LABEL    a row per channel and measure
//   tracks.LABEL   deviation at the end and at most
std::vector<Table> filter_tables(const std::vector<RunRecord>& records);

}  // namespace odobench
