#include "reports/kinds/trust/validation_sentences.hpp"

#include <fmt/format.h>

namespace odobench {
namespace {

double ratio(const FoldFigures& fold) {
  return fold.held_out.total_held_out / fold.held_out.total_nominal;
}

bool is_worse(const FoldFigures& fold) {
  return against_nominal(fold.held_out) == AgainstNominal::Worse;
}

// Three decimals; three digits of what is small.
std::string total_text(double total) {
  return total < 0.1 ? fmt::format("{:#.3g}", total) : fmt::format("{:.3f}", total);
}

// "Worse than nominal on WHAT (a against b)", "No better ..." or "".
std::string compared(const HeldOut& all, const char* what) {
  const AgainstNominal how = against_nominal(all);
  if (how == AgainstNominal::Better) return "";
  return fmt::format("{} than nominal on {} ({} against {})",
                     how == AgainstNominal::Worse ? "Worse" : "No better", what,
                     total_text(all.total_held_out), total_text(all.total_nominal));
}

void add(std::vector<std::string>& list, std::string sentence) {
  if (!sentence.empty()) list.push_back(std::move(sentence));
}

}  // namespace

AgainstNominal against_nominal(const HeldOut& figures) {
  const double held_out = figures.total_held_out;
  if (held_out <= figures.total_nominal || held_out < kNoError) return AgainstNominal::Better;
  // Not-a-number is worse than anything.
  return held_out <= kWorseBeyond * figures.total_nominal ? AgainstNominal::NoBetter : AgainstNominal::Worse;
}

std::string worse_on_repetitions(const SchemeFigures& repetitions) {
  const std::string text = compared(repetitions.all, "repetitions left out");
  if (text.empty()) return "";
  return text + (against_nominal(repetitions.all) == AgainstNominal::Worse
                     ? ": do not use these parameters."
                     : ": nominal parameters do as well.");
}

std::string repeats(const SchemeFigures& repetitions) {
  const HeldOut& all = repetitions.all;
  if (all.total_held_out < kNoError || all.total_full < kNoError) return "";
  if (!(all.total_held_out <= kRepeatsWithin * all.total_full)) return "";
  return fmt::format("Repeats: error on repetitions left out {} ({:+.1f} % against fitted).",
                     total_text(all.total_held_out), change_percent(all.total_held_out, all.total_full));
}

std::string fits_more_than_it_learns(const SchemeFigures& repetitions) {
  const HeldOut& all = repetitions.all;
  if (all.total_held_out < kNoError || all.total_held_out <= kRepeatsWithin * all.total_full) return "";
  return fmt::format(
      "Fits more than it learns: error on repetitions left out is {:.1f} % larger than on fitted ones.",
      change_percent(all.total_held_out, all.total_full));
}

std::string worse_on_new_kinds(const SchemeFigures& trajectories) {
  const std::string text = compared(trajectories.all, "kinds of drives that it was not fitted to");
  return text.empty() ? "" : text + ".";
}

std::string kinds_that_are_needed(const SchemeFigures& trajectories) {
  const FoldFigures* worst = nullptr;
  for (const FoldFigures& fold : trajectories.folds)
    if (is_worse(fold) && (worst == nullptr || ratio(fold) > ratio(*worst))) worst = &fold;
  if (worst == nullptr) return "";
  std::string others;
  for (const FoldFigures& fold : trajectories.folds)
    if (&fold != worst && is_worse(fold)) others += (others.empty() ? "" : ", ") + fold.name;
  if (!others.empty()) others = fmt::format(" (the same of {})", others);
  return fmt::format(
      "Without {} in the fit its error would be {}, nominal has {}{}: the parameters hold for the "
      "kinds "
      "of drives they were fitted to.",
      worst->name, total_text(worst->held_out.total_held_out), total_text(worst->held_out.total_nominal),
      others);
}

std::string better_on_every_kind(const SchemeFigures& trajectories) {
  for (const FoldFigures& fold : trajectories.folds)
    if (against_nominal(fold.held_out) != AgainstNominal::Better || fold.held_out.total_nominal < kNoError)
      return "";
  return fmt::format("Better than nominal on every kind of drive left out ({:+.1f} % in all).",
                     change_percent(trajectories.all.total_held_out, trajectories.all.total_nominal));
}

std::vector<std::string> validation_sentences(const RunRecord& record) {
  std::vector<std::string> list;
  if (const auto repetitions = validation_of(record, kRepetitions)) {
    add(list, worse_on_repetitions(*repetitions));
    add(list, repeats(*repetitions));
    add(list, fits_more_than_it_learns(*repetitions));
  }
  if (const auto trajectories = validation_of(record, kTrajectories)) {
    add(list, worse_on_new_kinds(*trajectories));
    add(list, kinds_that_are_needed(*trajectories));
    add(list, better_on_every_kind(*trajectories));
  }
  return list;
}

std::string validation_warning(const RunRecord& record) {
  std::string text;
  const auto more = [&text](const std::string& sentence) {
    if (!sentence.empty()) text += (text.empty() ? "" : " ") + sentence;
  };
  if (const auto repetitions = validation_of(record, kRepetitions)) more(worse_on_repetitions(*repetitions));
  if (const auto trajectories = validation_of(record, kTrajectories)) {
    const std::string worse = worse_on_new_kinds(*trajectories);
    more(worse);
    if (!worse.empty()) more(kinds_that_are_needed(*trajectories));
  }
  return text;
}

}  // namespace odobench
