// `bench report`: what people look at, from stored records alone.
//
// The tables on standard output; with `out` one HTML page, with `figures` an SVG file per figure instead.
#pragma once

#include "bench/verbs/verb.hpp"

namespace odobench {

VerbAction add_report(CLI::App& app);

}  // namespace odobench
