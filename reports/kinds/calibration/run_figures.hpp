// Figures of the runs of one problem and data set.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "reports/figures/document.hpp"
#include "reports/statistics/row_groups.hpp"

namespace odobench {

// Over the repeats of each label: best J so far against evaluations and against time, as median, quartiles
// and extremes on a logarithmic grid; J itself or J above the lowest J of the comparison. Between its trace
// points a run keeps its best J. Appends convergence.evaluations and convergence.seconds; nothing when no run
// has a trace.
void add_convergence_figures(const Comparison& comparison, const std::string& prefix, Section& section,
                             Document& document);

// Final J of every repeat, per label (repeats); nothing unless a label has several.
void add_repeat_figure(const Comparison& comparison, const std::string& prefix, Section& section,
                       Document& document);

// Parameters as deviation from nominal in % with the box, and their 95 % intervals as bars where the
// record has some (cut at the plot's edge). Nothing without parameters.
void add_parameter_figure(const Comparison& comparison, const std::string& prefix, Section& section,
                          Document& document);

// What deviations from nominal are measured by: |nominal|, half the box where that is 0.
double deviation_scale(const ParameterValue& p);
// Half the 95 % interval of a free parameter in that unit; none where the drives do not tell it or where the
// record says nothing.
std::optional<double> relative_half_width(const RunRecord& record, const ParameterValue& p);

// What the data determine at the best result: singular values, weak directions in words, correlations.
// Nothing without the series of a record.
void add_identifiability(const Comparison& comparison, const std::string& prefix, Section& section,
                         Document& document);

// The directions of parameter space along which the standard deviation exceeds half the box: one row each.
std::optional<Table> weak_directions(const RunRecord& record);

}  // namespace odobench
