#include "reports/kinds/trust/next_steps_tables.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "base/range.hpp"
#include "reports/kinds/trust/trust_tables.hpp"

namespace odobench {
namespace {

constexpr double kWorthSaying = 0.1;   // of J
constexpr double kBoxMatters = 0.01;   // of J
constexpr double kNearlyAsMuch = 0.9;  // of what the best explains
constexpr double kPoorly = 2;          // % of a single parameter

OpenClause nothing() {
  return {"", kNotANumber, kNotANumber, ""};
}

// "b1", "b1 and b2", "a1, a2 and b1"; many are counted.
std::string some_of(const std::vector<std::string>& names) {
  constexpr std::size_t kNamed = 6;
  if (names.size() > kNamed)
    return fmt::format("{}, {}, {} and {} more", names[0], names[1], names[2], names.size() - 3);
  std::string text;
  for (std::size_t i = 0; i < names.size(); ++i)
    text += (i == 0 ? "" : i + 1 == names.size() ? " and " : ", ") + names[i];
  return text;
}

std::string capital(std::string text) {
  if (!text.empty() && text[0] >= 'a' && text[0] <= 'z') text[0] = static_cast<char>(text[0] - 'a' + 'A');
  return text;
}

std::string times(int n) {
  return n == 1 ? "once" : n == 2 ? "twice" : fmt::format("{} times", n);
}

std::string drive_words(const NextDriveRecord& d) {
  return d.recorded ? fmt::format("{} again", d.drive) : fmt::format("{} ({})", d.drive, d.description);
}

// A drive and its mirror image are one thing to say: "circle_0.2m_cw" and "circle_0.2m_ccw".
bool mirrored(const std::string& a, const std::string& b) {
  const auto stem = [](const std::string& s) {
    const std::size_t at = s.rfind('_');
    const std::string tail = at == std::string::npos ? "" : s.substr(at);
    return tail == "_cw" || tail == "_ccw" || tail == "_left" || tail == "_right" ? s.substr(0, at) : s;
  };
  return a != b && stem(a) == stem(b);
}

const ExplanationRecord* best_of(const TrustRecord& trust, bool robot) {
  const ExplanationRecord* best = nullptr;
  for (const ExplanationRecord& e : trust.explanations)
    if (e.robot == robot && !e.on_bound && e.explained >= kWorthSaying &&
        (best == nullptr || e.explained > best->explained))
      best = &e;
  return best;
}

std::string decide_sentence(const NextStepsRecord& next) {
  const NextDriveRecord& d = next.drives.front();
  const std::string between = fmt::format("{} and {}", next.first_words, next.second_words);
  if (d.repetitions == 0)
    return fmt::format("Next: no drive known here decides between {}; {} comes nearest.", between,
                       drive_words(d));
  std::string also;
  for (std::size_t i = 1; i < next.drives.size() && also.empty(); ++i)
    if (next.drives[i].repetitions > 0 && !mirrored(d.drive, next.drives[i].drive))
      also = fmt::format(", or {} {},", drive_words(next.drives[i]), times(next.drives[i].repetitions));
  return fmt::format("Next: {} {}{} decides between {} ('bench plan --data=SET.JSON --between={},{}').",
                     drive_words(d), times(d.repetitions), also, between, d.first, d.second);
}

std::string settle_sentence(const NextStepsRecord& next) {
  const std::string open = some_of(next.open);
  const std::string width = fmt::format("+-{:.0f} % of the box", 100 * next.largest_after);
  if (next.settled.empty())
    return fmt::format(
        "No drive known here settles {} (12 more leave {}): measure {}, or hold {} fixed (lower = upper).",
        open, width, next.open.size() == 1 ? "it" : "them", next.open.size() == 1 ? "it" : "some");
  constexpr std::size_t kNamed = 3;
  std::vector<std::string> list;
  for (const NextDriveRecord& d : next.drives) {
    if (list.size() < kNamed || next.drives.size() == kNamed + 1)
      list.push_back(fmt::format("{} {}", drive_words(d), times(d.repetitions)));
  }
  if (list.size() < next.drives.size())
    list.push_back(fmt::format("{} more (table next_drives)", next.drives.size() - list.size()));
  std::string drives;
  for (std::size_t i = 0; i < list.size(); ++i)
    drives += (i == 0 ? "" : i + 1 == list.size() ? " and " : ", ") + list[i];
  return fmt::format(
      "Next: {} {} {}{}.", drives, next.drives.size() == 1 ? "settles" : "settle", some_of(next.settled),
      next.settled.size() == next.open.size()
          ? ""
          : fmt::format("; {} of {} stay open", next.open.size() - next.settled.size(), next.open.size()));
}

Table explanations_table(const std::string& prefix, const std::string& suffix, const RunRecord& record) {
  Table t{prefix + "explanations",
          "What richer models explain of what is left" + suffix,
          {text_column("model"), text_column("words", "what it is"), number_column("cost", "J"),
           number_column("explained", "", "%"), text_column("parameter"), number_column("value"),
           text_column("unit"), text_column("remark")},
          {},
          {}};
  for (const ExplanationRecord& e : record.trust->explanations) {
    const ReadUnit unit = read_unit(e.unit);
    t.rows.push_back({text_cell(e.model), text_cell(e.words), significant_cell(e.cost, 6),
                      fixed_cell(100 * e.explained, 1), text_cell(e.parameter),
                      e.parameter.empty() ? Cell{} : significant_cell(unit.factor * e.value, 4),
                      text_cell(unit.name),
                      text_cell(e.on_bound ? "on its bound: only fits"
                                : e.robot  ? ""
                                           : "a factor without a meaning, a competitor")});
  }
  t.notes.push_back(fmt::format(
      "Fitted to all recordings, J {:.6g} without; 'bench models' judges them by recordings left out.",
      record.cost.value_or(0)));
  return t;
}

Table drives_table(const std::string& prefix, const std::string& suffix, const NextStepsRecord& next) {
  Table t{prefix + "next_drives",
          "What to drive next" + suffix,
          {text_column("drive"), text_column("purpose"), number_column("repetitions"),
           number_column("separation"), number_column("probability", "right choice", "%"),
           number_column("seconds", "", "s"), text_column("description")},
          {},
          {}};
  for (const NextDriveRecord& d : next.drives) {
    const bool decides = d.purpose == "decide";
    t.rows.push_back({text_cell(d.drive), text_cell(d.purpose),
                      d.repetitions > 0 ? count_cell(d.repetitions) : text_cell("never"),
                      decides ? significant_cell(d.separation, 3) : Cell{},
                      decides ? fixed_cell(100 * d.probability, 1) : Cell{}, fixed_cell(d.seconds, 0),
                      text_cell(d.description)});
  }
  if (next.open.empty())
    t.notes.push_back(
        fmt::format("Each alone decides between {} and {}. Separation: of one drive, in standard deviations; "
                    "right choice: "
                    "after so many.",
                    next.first_words, next.second_words));
  else
    t.notes.push_back(fmt::format(
        "Together. Open: {}; 95 % half width at most {:.0f} % of the box's now, {:.0f} % with these.",
        fmt::join(next.open, ", "), 100 * next.largest_before, 100 * next.largest_after));
  return t;
}

}  // namespace

OpenClause single_parameters_clause(const RunRecord& record) {
  if (!record.trust) return nothing();
  double best = HUGE_VAL, worst = 0;
  std::string best_name, worst_name;
  for (const ParameterIntervalRecord& p : record.trust->parameters) {
    const auto of = std::find_if(record.parameters.begin(), record.parameters.end(),
                                 [&](const ParameterValue& v) { return v.name == p.name; });
    if (of == record.parameters.end() || of->nominal == 0) continue;
    const double width = 100 * p.interval.half_width / std::abs(of->nominal);
    if (!std::isfinite(width)) return nothing();
    if (width < best) best = width, best_name = p.name;
    if (width > worst) worst = width, worst_name = p.name;
  }
  if (best_name.empty()) return nothing();
  if (best_name == worst_name)
    return {fmt::format("{} is known to {:.2g} %.", best_name, best), best, worst, "%"};
  if (best >= kPoorly)
    return {fmt::format("No single parameter is known better than {:.2g} % ({}).", best, best_name), best,
            worst, "%"};
  return {fmt::format("Single parameters are known to between {:.2g} % ({}) and {:.2g} % ({}).", best,
                      best_name, worst, worst_name),
          best, worst, "%"};
}

OpenClause twice_box_clause(const RunRecord& record) {
  if (!record.trust || !record.trust->twice_box || !record.cost || !(*record.cost > 0)) return nothing();
  const double twice = *record.trust->twice_box, fall = 1 - twice / *record.cost;
  if (!std::isfinite(fall)) return nothing();
  const std::string sentence =
      fall > kBoxMatters
          ? fmt::format(
                "Twice the box lowers J by {:.1f} %: the model bends its parameters to fit something it "
                "does not contain.",
                100 * fall)
          : fmt::format("Twice the box lowers J by {:.1g} % only: the box is not what keeps the errors up.",
                        100 * fall);
  return {sentence, 100 * fall, twice, "%"};
}

OpenClause explanation_clause(const RunRecord& record) {
  if (!record.trust) return nothing();
  const ExplanationRecord *best = best_of(*record.trust, true), *other = best_of(*record.trust, false);
  if (best == nullptr && other == nullptr) return nothing();
  const ExplanationRecord& e = best != nullptr ? *best : *other;
  std::string text = fmt::format("{} explains {:.0f} % of what is left", capital(e.words), 100 * e.explained);
  if (best != nullptr && other != nullptr && other->explained > kNearlyAsMuch * best->explained)
    text +=
        fmt::format("; {} {:.0f} %, so neither is shown to be true", other->words, 100 * other->explained);
  return {text + " ('bench models' compares more).", 100 * e.explained,
          best != nullptr && other != nullptr ? 100 * other->explained : kNotANumber, "%"};
}

OpenClause next_drives_clause(const RunRecord& record) {
  if (!record.trust || !record.trust->next) return nothing();
  const NextStepsRecord& next = *record.trust->next;
  if (!next.skipped.empty())
    return {fmt::format("What to drive next was not looked for: {}.", next.skipped), kNotANumber, kNotANumber,
            ""};
  if (!next.open.empty())
    return {settle_sentence(next), static_cast<double>(next.settled.size()),
            static_cast<double>(next.open.size()), ""};
  if (next.drives.empty()) return nothing();
  return {decide_sentence(next), static_cast<double>(next.drives.front().repetitions),
          100 * next.drives.front().probability, ""};
}

std::vector<Table> next_steps_tables(const Comparison& comparison) {
  const RunRecord* best = nullptr;
  for (const ComparisonRow& row : comparison.rows)
    for (const RunRecord* run : row.runs)
      if (run->trust && run->cost && (best == nullptr || *run->cost < *best->cost)) best = run;
  std::vector<Table> tables;
  if (best == nullptr) return tables;
  if (!best->trust->explanations.empty())
    tables.push_back(explanations_table(comparison.id_prefix, comparison.title_suffix, *best));
  if (best->trust->next && !best->trust->next->drives.empty())
    tables.push_back(drives_table(comparison.id_prefix, comparison.title_suffix, *best->trust->next));
  return tables;
}

}  // namespace odobench
