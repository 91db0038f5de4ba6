#include "reports/kinds/trust/validation_record.hpp"

#include <fmt/format.h>

#include <array>
#include <utility>

#include "reports/records/series.hpp"

namespace odobench {
namespace {

struct HeldOutName {
  const char* name;
  double HeldOut::*member;
  const char* unit;
  Better better;
};
constexpr std::array<HeldOutName, 6> kHeldOut{
    {{"cost_held_out", &HeldOut::cost_held_out, "", Better::Lower},
     {"cost_full", &HeldOut::cost_full, "", Better::None},
     {"cost_nominal", &HeldOut::cost_nominal, "", Better::None},
     {"total_held_out", &HeldOut::total_held_out, "m + rad", Better::Lower},
     {"total_full", &HeldOut::total_full, "m + rad", Better::None},
     {"total_nominal", &HeldOut::total_nominal, "m + rad", Better::None}}};

std::string key(const std::string& scheme, const char* name) {
  return fmt::format("validation.{}.{}", scheme, name);
}
std::string fold_key(const std::string& scheme, const char* name) {
  return fmt::format("validation.{}.fold_{}", scheme, name);
}

std::string fold_name(const std::string& scheme, std::size_t fold, const RecordingError& first) {
  if (scheme == kTrajectories) return first.trajectory;
  return fmt::format("{}", scheme == kRepetitions ? static_cast<std::size_t>(first.repetition) : fold + 1);
}

// How many recordings each fold leaves out, and its name. False where the series does not fit the record.
bool name_folds(const RunRecord& record, SchemeFigures& figures) {
  for (std::size_t n = 0; n < figures.fold_of.size(); ++n) {
    const double number = figures.fold_of[n];
    if (number == 0) continue;
    if (!(number >= 1 && number <= static_cast<double>(figures.folds.size()))) return false;
    const auto fold = static_cast<std::size_t>(number) - 1;
    if (figures.folds[fold].recordings++ == 0)
      figures.folds[fold].name = fold_name(figures.scheme, fold, record.errors[n]);
  }
  return true;
}

}  // namespace

void put_validation(const SchemeFigures& figures, RunRecord& record) {
  const std::string& scheme = figures.scheme;
  for (const HeldOutName& h : kHeldOut) {
    record.measures.put({key(scheme, h.name), figures.all.*h.member, h.unit, h.better, scheme});
    std::vector<double>& series = record.series[fold_key(scheme, h.name)];
    series.clear();
    for (const FoldFigures& fold : figures.folds) series.push_back(fold.held_out.*h.member);
  }
  if (figures.cost_predicted)
    record.measures.put({key(scheme, "cost_predicted"), *figures.cost_predicted, "", Better::None, scheme});
  record.series[key(scheme, "fold")] = figures.fold_of;
  std::vector<double> parameters, costs, totals;
  for (const FoldFigures& fold : figures.folds) {
    parameters.insert(parameters.end(), fold.parameters.begin(), fold.parameters.end());
    costs.push_back(fold.cost_fitted);
    totals.push_back(fold.total_fitted);
  }
  record.series[key(scheme, "parameters")] = std::move(parameters);
  record.series[key(scheme, "cost_fitted")] = std::move(costs);
  record.series[key(scheme, "total_fitted")] = std::move(totals);
}

std::optional<SchemeFigures> validation_of(const RunRecord& record, const std::string& scheme) {
  const auto costs = record.series.find(key(scheme, "cost_fitted"));
  const std::vector<double>* fold_of = series_of(record, key(scheme, "fold").c_str(), record.errors.size());
  if (costs == record.series.end() || costs->second.empty() || fold_of == nullptr) return std::nullopt;
  const std::size_t count = costs->second.size();
  SchemeFigures figures{scheme, *fold_of, std::vector<FoldFigures>(count), {}, {}};
  const auto read = [&](const std::string& name, const auto& store) {
    const std::vector<double>* series = series_of(record, name.c_str(), count);
    if (series == nullptr) return false;
    for (std::size_t k = 0; k < count; ++k) store(figures.folds[k], (*series)[k]);
    return true;
  };
  bool whole = read(key(scheme, "cost_fitted"), [](FoldFigures& f, double v) { f.cost_fitted = v; }) &&
               read(key(scheme, "total_fitted"), [](FoldFigures& f, double v) { f.total_fitted = v; });
  for (const HeldOutName& h : kHeldOut) {
    const std::optional<double> value = record.measures.value(key(scheme, h.name));
    if (value) figures.all.*h.member = *value;
    whole = whole && value &&
            read(fold_key(scheme, h.name), [&](FoldFigures& f, double v) { f.held_out.*h.member = v; });
  }
  if (!whole || !name_folds(record, figures)) return std::nullopt;
  const std::size_t n = record.parameters.size();
  if (const auto* p = series_of(record, key(scheme, "parameters").c_str(), count * n); p != nullptr)
    for (std::size_t k = 0; k < count; ++k)
      figures.folds[k].parameters.assign(p->begin() + static_cast<std::ptrdiff_t>(k * n),
                                         p->begin() + static_cast<std::ptrdiff_t>((k + 1) * n));
  figures.cost_predicted = record.measures.value(key(scheme, "cost_predicted"));
  return figures;
}

std::vector<SchemeFigures> validations_of(const RunRecord& record) {
  std::vector<SchemeFigures> list;
  for (const char* scheme : {kRepetitions, kTrajectories, kKFold})
    if (std::optional<SchemeFigures> figures = validation_of(record, scheme))
      list.push_back(std::move(*figures));
  return list;
}

double change_percent(double a, double b) {
  return 100 * (a - b) / b;
}

}  // namespace odobench
