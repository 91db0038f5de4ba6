#include "reports/kinds/trust/noise_record.hpp"

#include <cmath>
#include <limits>

#include "reports/records/series.hpp"

namespace odobench {
namespace {

template <class Of>
struct NoiseField {
  const char* name;
  const char* unit;
  double Of::*member;
};

constexpr std::array<NoiseField<NoiseFigures>, 5> kOverall{{{"speed", "m/s", &NoiseFigures::speed},
                                                            {"turn_rate", "rad/s", &NoiseFigures::turn_rate},
                                                            {"metres", "m", &NoiseFigures::metres},
                                                            {"radians", "rad", &NoiseFigures::radians},
                                                            {"drives", "", &NoiseFigures::drives}}};
constexpr std::array<NoiseField<NoiseFigures>, 4> kCheck{{{"checked", "", &NoiseFigures::checked},
                                                          {"nees", "", &NoiseFigures::nees},
                                                          {"nees_lower", "", &NoiseFigures::nees_lower},
                                                          {"nees_upper", "", &NoiseFigures::nees_upper}}};
constexpr std::array<NoiseField<NoiseKindFigures>, 12> kKind{
    {{"drives", "", &NoiseKindFigures::drives},
     {"repeated", "", &NoiseKindFigures::repeated},
     {"bias_x", "m", &NoiseKindFigures::bias_x},
     {"bias_y", "m", &NoiseKindFigures::bias_y},
     {"bias_heading", "rad", &NoiseKindFigures::bias_heading},
     {"scatter_x", "m", &NoiseKindFigures::scatter_x},
     {"scatter_y", "m", &NoiseKindFigures::scatter_y},
     {"scatter_heading", "rad", &NoiseKindFigures::scatter_heading},
     {"predicted_x", "m", &NoiseKindFigures::predicted_x},
     {"predicted_y", "m", &NoiseKindFigures::predicted_y},
     {"predicted_heading", "rad", &NoiseKindFigures::predicted_heading},
     {"nees", "", &NoiseKindFigures::nees}}};
constexpr std::array<NoiseField<NoiseLengthFigures>, 4> kLength{
    {{"noise.length.metres", "m", &NoiseLengthFigures::metres},
     {"noise.length.radians", "rad", &NoiseLengthFigures::radians},
     {"noise.length.segments", "", &NoiseLengthFigures::segments},
     {"noise.length.ratio", "", &NoiseLengthFigures::ratio}}};

std::string name_of_kind(const std::string& kind, const char* figure) {
  return "noise.kind." + kind + "." + figure;
}

void read_kinds(const Measures& measures, NoiseFigures& figures) {
  for (const std::string& subject : measures.subjects()) {
    if (measures.find(name_of_kind(subject, "drives")) == nullptr) continue;
    NoiseKindFigures kind;
    kind.kind = subject;
    for (const auto& field : kKind)
      kind.*field.member = measures.value(name_of_kind(subject, field.name))
                               .value_or(std::numeric_limits<double>::quiet_NaN());
    figures.kinds.push_back(std::move(kind));
  }
}

}  // namespace

const NoiseTermFigures* NoiseFigures::find(const std::string& name) const {
  for (const NoiseTermFigures& term : terms)
    if (term.name == name) return &term;
  return nullptr;
}

double NoiseFigures::value(const std::string& name) const {
  const NoiseTermFigures* term = find(name);
  return term == nullptr ? 0 : term->value;
}

void put_noise(const NoiseFigures& figures, RunRecord& record) {
  Measures& to = record.measures;
  for (const NoiseTermFigures& t : figures.terms) {
    to.put({"noise." + t.name, t.value, t.unit, Better::None, t.name});
    to.put({"noise." + t.name + ".lower", t.lower, t.unit, Better::None, t.name});
    to.put({"noise." + t.name + ".upper", t.upper, t.unit, Better::None, t.name});
    to.put({"noise." + t.name + ".total", t.total, t.unit, Better::None, t.name});
  }
  for (const auto& f : kOverall) to.put({std::string("noise.") + f.name, figures.*f.member, f.unit});
  to.put({"noise.separated", figures.separated ? 1.0 : 0.0, ""});
  if (figures.checked > 0)
    for (const auto& f : kCheck) to.put({std::string("noise.") + f.name, figures.*f.member, f.unit});
  for (const NoiseKindFigures& kind : figures.kinds)
    for (const auto& f : kKind)
      to.put({name_of_kind(kind.kind, f.name), kind.*f.member, f.unit, Better::None, kind.kind});
  for (const auto& f : kLength) {
    std::vector<double>& series = record.series[f.name];
    series.clear();
    for (const NoiseLengthFigures& length : figures.lengths) series.push_back(length.*f.member);
  }
}

std::optional<NoiseFigures> noise_figures(const RunRecord& record) {
  const Measures& measures = record.measures;
  if (measures.find("noise.drives") == nullptr) return std::nullopt;
  NoiseFigures figures;
  for (const NoiseTermName& term : kNoiseTermNames) {
    const std::string name = std::string("noise.") + term.name;
    const Measure* found = measures.find(name);
    if (found == nullptr) continue;
    figures.terms.push_back({term.name, found->unit, found->value,
                             measures.value(name + ".lower").value_or(found->value),
                             measures.value(name + ".upper").value_or(found->value),
                             measures.value(name + ".total").value_or(found->value)});
  }
  for (const auto& f : kOverall)
    figures.*f.member = measures.value(std::string("noise.") + f.name).value_or(0);
  figures.separated = measures.value("noise.separated").value_or(0) > 0;
  for (const auto& f : kCheck) figures.*f.member = measures.value(std::string("noise.") + f.name).value_or(0);
  read_kinds(measures, figures);
  const auto metres = record.series.find(kLength[0].name);
  if (metres == record.series.end()) return figures;
  figures.lengths.resize(metres->second.size());
  for (const auto& f : kLength)
    if (const std::vector<double>* series = series_of(record, f.name, figures.lengths.size()))
      for (std::size_t k = 0; k < series->size(); ++k) figures.lengths[k].*f.member = (*series)[k];
  return figures;
}

}  // namespace odobench
