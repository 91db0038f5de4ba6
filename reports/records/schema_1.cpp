#include "reports/records/schema_1.hpp"

#include <array>
#include <string_view>

namespace odobench {
namespace {

// Names that begin with `prefix` and end with `suffix`; what stands between them is what the measure is of
// where `of` is "*". A prefix that ends in a word, not in '.' or '_', is the whole name. The first row that
// fits says the rest.
struct Row {
  std::string_view prefix, suffix;
  const char* unit;
  Better better = Better::None;
  std::string_view of = {};
  bool timing = false;
};

// One after the other: the entropy filter and its noise channels, windows, fusion, plans, verifications.
constexpr std::array kRows{
    Row{"windows_per_second", "", "1/s", Better::Higher, {}, true},
    Row{"at_optimum", "", "", Better::Higher},
    Row{"gain_", "", "", Better::Higher},
    Row{"hamiltonian_mean", "", "", Better::Higher},
    Row{"gap_", "", "", Better::Lower},
    Row{"iterations_", "", "", Better::Lower},
    Row{"evaluations_", "", "", Better::Lower},
    Row{"noise.", ".ratio.after", "", Better::Lower, "*"},
    Row{"noise.", ".ratio.before", "", Better::None, "*"},
    Row{"noise.", ".ratio.zero", "", Better::None, "*"},
    Row{"noise.encoder_component.", ".after", "m", Better::Lower, "encoder_component"},
    Row{"noise.encoder_component.", "", "m", Better::None, "encoder_component"},
    Row{"noise.encoder.", ".after", "m", Better::Lower, "encoder"},
    Row{"noise.encoder.", "", "m", Better::None, "encoder"},
    Row{"noise.ax.", ".after", "m/s^2", Better::Lower, "ax"},
    Row{"noise.ax.", "", "m/s^2", Better::None, "ax"},
    Row{"noise.ay.", ".after", "m/s^2", Better::Lower, "ay"},
    Row{"noise.ay.", "", "m/s^2", Better::None, "ay"},
    Row{"noise.theta.", ".after", "deg", Better::Lower, "theta"},
    Row{"noise.theta.", "", "deg", Better::None, "theta"},
    Row{"track.", ".after", "m", Better::Lower},
    Row{"track.", "", "m"},
    Row{"r1", "", "m"},
    Row{"sx1", "", "m"},
    Row{"sy1", "", "m"},
    Row{"ax12", "", "m/s^2"},
    Row{"ay12", "", "m/s^2"},
    Row{"rmse_position", "", "m"},
    Row{"rmse_heading", "", "rad"},
    Row{"sensor.", ".used", "", Better::None, "*"},
    Row{"sensor.", ".rejected", "", Better::None, "*"},
    Row{"sensor.", ".late", "", Better::None, "*"},
    Row{"sensor.", ".nis", "", Better::None, "*"},
    Row{"sensor.", ".dof", "", Better::None, "*"},
    Row{"sensor.", ".lower", "", Better::None, "*"},
    Row{"sensor.", ".upper", "", Better::None, "*"},
    Row{"deviation.", "", "", Better::None, "*"},
    Row{"arrival_position.", "", "m", Better::None, "*"},
    Row{"arrival_heading.", "", "rad", Better::None, "*"},
};

bool fits(const Row& row, std::string_view name) {
  const bool whole = row.prefix.back() != '.' && row.prefix.back() != '_';
  if (whole) return name == row.prefix;
  return name.size() >= row.prefix.size() + row.suffix.size() &&
         name.substr(0, row.prefix.size()) == row.prefix &&
         name.substr(name.size() - row.suffix.size()) == row.suffix;
}

}  // namespace

Measure schema_1_measure(const std::string& name, double value) {
  for (const Row& row : kRows) {
    if (!fits(row, name)) continue;
    const std::string_view middle =
        std::string_view(name).substr(row.prefix.size(), name.size() - row.prefix.size() - row.suffix.size());
    return {name, value, row.unit, row.better, std::string(row.of == "*" ? middle : row.of), row.timing};
  }
  return {name, value, ""};
}

}  // namespace odobench
