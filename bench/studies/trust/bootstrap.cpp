#include "bench/studies/trust/bootstrap.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <mutex>
#include <stdexcept>

#include "base/parallel.hpp"
#include "base/random.hpp"
#include "bench/studies/trust/validation.hpp"

namespace odobench {
namespace {
using Eigen::Index;

std::uint64_t replicate_seed(std::uint64_t seed, ResampleScheme scheme, std::size_t number) {
  return derive_seed(seed, {"bootstrap", name_of(scheme), fmt::format("{}", number)});
}

void draw(const std::vector<std::size_t>& from, Random& random, Resample& out) {
  for (std::size_t i = 0; i < from.size(); ++i)
    out.push_back(
        from[static_cast<std::size_t>(random.integer(0, static_cast<std::int64_t>(from.size()) - 1))]);
}

}  // namespace

std::string name_of(ResampleScheme scheme) {
  return scheme == ResampleScheme::Stratified ? "stratified" : "plain";
}

ResampleScheme resample_scheme(std::string_view name) {
  for (const ResampleScheme scheme : {ResampleScheme::Stratified, ResampleScheme::Plain})
    if (name == name_of(scheme)) return scheme;
  throw std::invalid_argument(fmt::format("'{}': expected stratified or plain", name));
}

Resample draw_resample(std::span<const DriveName> drives, ResampleScheme scheme, std::uint64_t seed,
                       std::size_t number) {
  Random random(replicate_seed(seed, scheme, number));
  Resample resample;
  resample.reserve(drives.size());
  if (scheme == ResampleScheme::Stratified) {
    for (const DrivesOfKind& kind : kinds_of(drives)) draw(kind.recordings, random, resample);
  } else {
    std::vector<std::size_t> all(drives.size());
    for (std::size_t n = 0; n < all.size(); ++n) all[n] = n;
    draw(all, random, resample);
  }
  std::sort(resample.begin(), resample.end());
  return resample;
}

std::string why_no_bootstrap(std::span<const DriveName> drives, ResampleScheme scheme) {
  if (drives.size() < 2) return "there is one recording only: every resample would be it";
  const std::vector<DrivesOfKind> kinds = kinds_of(drives);
  const bool repeated = std::any_of(kinds.begin(), kinds.end(),
                                    [](const DrivesOfKind& kind) { return kind.recordings.size() > 1; });
  if (scheme == ResampleScheme::Plain || repeated) return "";
  return "no kind of drive was driven twice: every stratified resample would be the set itself; plain draws "
         "from all recordings alike";
}

Replicate fit_resample(const std::shared_ptr<const RecordingCosts>& recordings, const Resample& resample,
                       const RefitOptions& options, std::uint64_t seed, const Stop& stop) {
  Vector weights = Vector::Zero(static_cast<Index>(recordings->size()));
  for (const std::size_t n : resample) {
    if (n >= recordings->size())
      throw std::invalid_argument(
          fmt::format("resample: found recording {}, expected one below {}", n, recordings->size()));
    weights[static_cast<Index>(n)] += 1;
  }
  const Refit fit = refit(recordings, weights, options, seed, stop);
  return {resample, fit.z, fit.cost, fit.termination};
}

std::vector<Replicate> bootstrap(const std::shared_ptr<const RecordingCosts>& recordings,
                                 const BootstrapPlan& plan, ReplicateStore* store, Watcher& watcher,
                                 const Stop& stop) {
  const std::vector<DriveName> drives = drive_names(*recordings);
  std::vector<Replicate> replicates(plan.replicates);
  std::vector<std::size_t> missing;
  for (std::size_t k = 0; k < plan.replicates; ++k) {
    replicates[k].resample = draw_resample(drives, plan.scheme, plan.seed, k);
    const Replicate* known = store == nullptr ? nullptr : store->find(k);
    if (known != nullptr && known->resample == replicates[k].resample &&
        known->z.size() == plan.refit.start.size())
      replicates[k] = *known;
    else
      missing.push_back(k);
  }
  std::mutex mutex;
  watcher.count_begins("replicates", static_cast<std::int64_t>(missing.size()));
  parallel_for(
      missing.size(), plan.threads,
      [&](std::size_t i) {
        const std::size_t k = missing[i];
        replicates[k] = fit_resample(recordings, replicates[k].resample, plan.refit,
                                     replicate_seed(plan.seed, plan.scheme, k), stop);
        if (store != nullptr) {
          const std::lock_guard lock(mutex);
          store->add(k, replicates[k]);
        }
        watcher.count_one();
      },
      stop);
  watcher.count_ends();
  return replicates;
}

}  // namespace odobench
