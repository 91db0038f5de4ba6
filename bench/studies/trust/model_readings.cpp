#include "bench/studies/trust/model_readings.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "reports/kinds/trust/models_tables.hpp"

namespace odobench {
namespace {

constexpr double kLagApart = 0.02;      // s
constexpr double kTurnedStart = 0.005;  // rad

struct Reading {
  std::string word;
  std::vector<std::string> evidence;
  void only_fits(std::string why) {
    word = "only fits";
    evidence.push_back(std::move(why));
  }
};

std::string unit_text(const ParameterInfo& p, double value) {
  if (p.unit == "m") return fmt::format("{:.1f} mm", 1000 * value);
  if (p.unit == "rad") return fmt::format("{:.1f} mrad", 1000 * value);
  if (p.unit == "s") return fmt::format("{:.0f} ms", 1000 * value);
  return fmt::format("{:.4f}", value);
}

// Of parameters that are 0 where nothing is wrong.
void read_signs(const ModelFits& fits, std::size_t p, Reading& reading) {
  const ParameterInfo& info = fits.parameters[p];
  if (info.nominal != 0) return;
  double least = HUGE_VAL, most = -HUGE_VAL;
  for (const auto* list : {&fits.repetitions, &fits.trajectories})
    for (const FoldFit& fold : *list) {
      least = std::min(least, fold.z[static_cast<Eigen::Index>(p)]);
      most = std::max(most, fold.z[static_cast<Eigen::Index>(p)]);
    }
  const double enough = 0.02 * (info.upper - info.lower);
  if (least < -enough && most > enough)
    reading.only_fits(fmt::format("{} changes sign between folds, {} to {}", info.name,
                                  unit_text(info, least), unit_text(info, most)));
}

void read_extras(const ModelFits& fits, double lag, Reading& reading) {
  for (std::size_t p = fits.own; p < fits.parameters.size(); ++p) {
    const ParameterInfo& info = fits.parameters[p];
    const double value = fits.z[static_cast<Eigen::Index>(p)], width = info.upper - info.lower;
    if (width <= 0) continue;
    if (value - info.lower < kOnBound * width || info.upper - value < kOnBound * width)
      reading.only_fits(fmt::format("{} is on its bound of {}", info.name, unit_text(info, value)));
    read_signs(fits, p, reading);
    if (info.name == "time_offset" && lag != 0 && std::abs(value - lag) > kLagApart)
      reading.only_fits(
          fmt::format("the time offset of {} is not the lag of {:.0f} ms that is measured without "
                      "a model: it absorbs something else",
                      unit_text(info, value), 1000 * lag));
  }
}

struct Headings {
  std::vector<double> values;
  int sense = 0;
  double mean() const {
    double sum = 0;
    for (const double v : values) sum += v;
    return sum / static_cast<double>(values.size());
  }
  // Above three standard errors.
  bool clear() const {
    if (values.size() < 2) return false;
    double squares = 0;
    for (const double v : values) squares += (v - mean()) * (v - mean());
    const auto n = static_cast<double>(values.size());
    return std::abs(mean()) > 3 * std::sqrt(squares / (n - 1) / n);
  }
};

// Whether free headings of a trajectory to the left and of one to the right are clear and opposite.
void read_starts(const ModelFits& fits, Reading& reading) {
  if (fits.start_headings.empty()) return;
  reading.word = "nuisance";
  std::map<std::string, Headings> kinds;
  for (std::size_t n = 0; n < fits.start_headings.size(); ++n) {
    Headings& kind = kinds[fits.errors[n].trajectory];
    kind.values.push_back(fits.start_headings[n]);
    kind.sense = fits.senses[n];
  }
  const std::pair<const std::string, Headings>*left = nullptr, *right = nullptr;
  for (const auto& kind : kinds) {
    const Headings& h = kind.second;
    if (h.sense == 0 || !h.clear()) continue;
    auto& most = h.sense > 0 ? left : right;
    if (most == nullptr || std::abs(h.mean()) > std::abs(most->second.mean())) most = &kind;
  }
  if (left == nullptr || right == nullptr) return;
  const double a = left->second.mean(), b = right->second.mean();
  if (a * b < 0 && std::min(std::abs(a), std::abs(b)) > kTurnedStart)
    reading.only_fits(fmt::format(
        "free headings are {:+.0f} mrad in {} and {:+.0f} mrad in {}: they take up a turning error, or a lag",
        1000 * a, left->first, 1000 * b, right->first));
}

const ModelFits* lowest(const std::vector<ModelFits>& fits, bool (*wanted)(const ModelFits&)) {
  const ModelFits* best = nullptr;
  for (const ModelFits& f : fits)
    if (wanted(f) && (best == nullptr || f.cost < best->cost)) best = &f;
  return best;
}

bool is_plain(const ModelFits& f) {
  return !f.terms.any();
}
bool is_competitor(const ModelFits& f) {
  return !f.terms.speed_factor_of.empty();
}

void read_offset(const ModelFits& f, const std::vector<ModelFits>& all, Reading& reading) {
  if (f.terms.offsets == ModelTerms::Offsets::None || reading.word == "only fits") return;
  const ModelFits* plain = lowest(all, is_plain);
  const ModelFits* competitor = lowest(all, is_competitor);
  if (plain == nullptr || f.cost > 0.9 * plain->cost) return;
  reading.word = "explains";
  if (competitor != nullptr && plain->cost - competitor->cost > 0.9 * (plain->cost - f.cost))
    reading.evidence.push_back(
        fmt::format("not shown to be physical: one factor of {:.4f} on the drives of {} does nearly as much "
                    "(J {:.2f} against {:.2f} of {:.2f})",
                    competitor->z[competitor->z.size() - 1], competitor->terms.speed_factor_of,
                    competitor->cost, f.cost, plain->cost));
}

Reading read_one(const ModelFits& f, const std::vector<ModelFits>& all, double lag) {
  Reading reading;
  if (is_plain(f)) reading.word = "as the set says";
  if (f.terms.held_time_offset != 0) {
    reading.word = "measured lag";
    if (lag != 0 && std::abs(f.terms.held_time_offset - lag) > kLagApart)
      reading.only_fits(
          fmt::format("held at {:.0f} ms, measured {:.0f} ms", 1000 * f.terms.held_time_offset, 1000 * lag));
  }
  if (is_competitor(f)) reading.word = "competitor";
  read_extras(f, lag, reading);
  read_starts(f, reading);
  read_offset(f, all, reading);
  if (reading.word.empty()) reading.word = "fits";
  return reading;
}

struct Candidate {
  std::size_t record;
  double held, bic;
  int free;
};

void recommend(const std::vector<ModelFits>& fits, std::vector<RunRecord>& records) {
  RunRecord& nominal = records.front();
  const double reference = nominal.measures.value("total").value_or(0);
  const auto beats = [&](const RunRecord& r, const char* name) {
    const std::optional<double> value = r.measures.value(name);
    return !value || *value < reference;
  };
  const bool repetitions = !fits.front().repetitions.empty(), kinds = !fits.front().trajectories.empty();
  std::vector<Candidate> candidates;
  for (std::size_t i = 0; i < fits.size(); ++i) {
    const RunRecord& r = records[i + 1];
    const bool fits_only = std::any_of(r.notes.begin(), r.notes.end(), [](const std::string& note) {
      return note == std::string(kReadingNote) + "only fits";
    });
    if (is_competitor(fits[i]) || fits_only || !beats(r, "held_total") || !beats(r, "new_kind_total"))
      continue;
    const double held = r.measures.value(repetitions ? "held_total"
                                         : kinds     ? "new_kind_total"
                                                     : "total")
                            .value_or(HUGE_VAL);
    candidates.push_back({i + 1, held, r.measures.value("bic").value_or(0), fits[i].free});
  }
  if (!repetitions || !kinds)
    nominal.notes.push_back(fmt::format(
        "there is only one {} of drive: {} cannot be asked", repetitions ? "kind" : "repetition",
        repetitions ? "what a new kind of drive would say" : "what another repetition would say"));
  if (!repetitions && !kinds) candidates.clear();
  if (candidates.empty()) {
    nominal.notes.emplace_back(
        "no model beats the nominal parameters on recordings that it was not fitted to");
    return;
  }
  double best = HUGE_VAL;
  for (const Candidate& c : candidates) best = std::min(best, c.held);
  std::erase_if(candidates, [&](const Candidate& c) { return c.held > best + 0.01 * reference; });
  const Candidate& chosen =
      *std::min_element(candidates.begin(), candidates.end(), [](const Candidate& a, const Candidate& b) {
        return a.free != b.free ? a.free < b.free : a.bic < b.bic;
      });
  RunRecord& r = records[chosen.record];
  r.measures.put({"recommended", 1, "", Better::None});
  std::string totals;  // where there are any to leave out
  for (const auto& [name, words] :
       {std::pair{"held_total", "another repetition"}, std::pair{"new_kind_total", "a new kind of drive"}})
    if (const double total = r.measures.value(name).value_or(NAN); std::isfinite(total))
      totals += fmt::format("{}{:.3f} for {}", totals.empty() ? "" : " and ", total, words);
  nominal.notes.push_back(
      fmt::format("use {}: total {}, against {:.3f} nominal", r.label, totals, reference));
}

}  // namespace

void read_models(const std::vector<ModelFits>& fits, double lag, std::vector<RunRecord>& records) {
  if (lag != 0)
    records.front().notes.push_back(
        fmt::format("cross-correlation, without a model, finds the reference {:.0f} ms {} the wheels",
                    1000 * std::abs(lag), lag > 0 ? "behind" : "ahead of"));
  for (std::size_t i = 0; i < fits.size(); ++i) {
    RunRecord& r = records[i + 1];
    Reading reading = read_one(fits[i], fits, lag);
    r.notes.push_back(kReadingNote + reading.word);
    for (std::string& why : reading.evidence) r.notes.push_back(std::move(why));
    r.measures.put({"recommended", 0, "", Better::None});
  }
  if (!fits.empty()) recommend(fits, records);
}

}  // namespace odobench
