// A report with every kind of table and chart there is, with made-up data.
#pragma once

#include "reports/figures/document.hpp"

namespace odobench::testing {

// Six sections; figures with lines of repetitions and a choice of method, bands, box plots, heat map, error
// bars, histogram, views side by side.
Document sample_document();

// A table with what is hard to show: non-finite numbers, differences, marks, empty cells, markup in names.
Table sample_table();

}  // namespace odobench::testing
