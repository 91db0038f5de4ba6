#include "bench/studies/trust_figures.hpp"

#include <fmt/format.h>

#include <stdexcept>
#include <utility>

#include "base/error.hpp"
#include "problems/trust/combined_intervals.hpp"
#include "problems/trust/trust.hpp"

namespace odobench {
namespace {

IntervalRecord interval_record(const Interval& i) {
  IntervalRecord record;
  record.deviation = i.deviation;
  record.df = i.df;
  record.half_width = i.half_width;
  record.same_deviation = i.same_deviation;
  record.same_df = i.same_df;
  record.same_half_width = i.same_half_width;
  record.refused = name_of(i.refused);
  record.reason = i.reason;
  return record;
}

TrustRecord trust_record(const Trust& trust) {
  TrustRecord record;
  record.recordings = static_cast<int>(trust.recordings);
  record.kinds = static_cast<int>(trust.kinds);
  record.exact_hessian = trust.exact_hessian;
  if (trust.kind_test.possible) {
    record.kind_f = trust.kind_test.f;
    record.kind_p = trust.kind_test.p;
    record.systematic = trust.kind_test.systematic;
  }
  for (const DeterminedNumber& d : trust.determined)
    record.determined.push_back({d.number.name, d.number.words, d.number.unit, d.number.nominal,
                                 d.number.value, interval_record(d.interval)});
  for (const ParameterInterval& p : trust.parameters)
    record.parameters.push_back({p.name, p.unit, p.value, interval_record(p.interval)});
  for (const DriveError& d : trust.drives)
    record.drives.push_back({d.drive, d.what, d.unit, d.scatter, interval_record(d.interval)});
  record.ratios_only = trust.ratios_only;
  record.remarks = trust.map_remarks;
  record.sentences = trust.sentences;
  return record;
}

}  // namespace

void describe_trust(const LoadedProblem& loaded, const Vector& x, RunRecord& record) {
  if (!loaded.apart) return;
  const auto give_up = [&](const std::exception& error) {
    record.notes.push_back(fmt::format("{}: nothing is said about trust: {}", record.label, error.what()));
  };
  try {
    record.trust = trust_record(assess_trust(*loaded.apart->get(), loaded.apart->robot(), x));
    for (Measure& measure : trust_measures(*record.trust)) record.measures.put(std::move(measure));
    double free = 0, on_bounds = 0;
    for (const ParameterValue& p : record.parameters) {
      if (p.lower < p.upper) ++free;
      if (p.lower < p.upper && !p.at_bound.empty()) ++on_bounds;
    }
    if (free > 0) record.measures.put({"trust.share_on_bounds", on_bounds / free, "", Better::Lower});
  } catch (const DataError& error) {
    give_up(error);
  } catch (const std::invalid_argument& error) {
    give_up(error);
  }
}

void describe_combinations(const LoadedProblem& loaded, const std::vector<Formula>& formulas,
                           RunRecord& record) {
  if (!loaded.apart || !record.trust) return;
  Vector z(static_cast<Eigen::Index>(record.parameters.size()));
  for (std::size_t i = 0; i < record.parameters.size(); ++i)
    z[static_cast<Eigen::Index>(i)] = record.parameters[i].value;
  record.trust->combinations.clear();
  for (const CombinationInterval& c :
       combination_intervals(*loaded.apart->get(), loaded.apart->robot(), z, formulas))
    record.trust->combinations.push_back({c.formula.name, c.formula.text, c.unit, c.nominal, c.value,
                                          c.of_the_map, interval_record(c.interval)});
}

}  // namespace odobench
