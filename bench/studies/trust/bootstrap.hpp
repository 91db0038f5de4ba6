// The spread of a calibration over sets of recordings drawn with replacement (Efron 1979).
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "bench/studies/trust/fold_plan.hpp"
#include "bench/studies/trust/refit.hpp"
#include "bench/studies/watcher.hpp"

namespace odobench {

// Stratified: from each kind of drive as many recordings as it has. Plain: from all recordings alike.
enum class ResampleScheme { Stratified, Plain };
std::string name_of(ResampleScheme scheme);  // "stratified", "plain"
// Throws std::invalid_argument "'x': expected stratified or plain" for another name.
ResampleScheme resample_scheme(std::string_view name);

// Places of recordings, ascending, one that was drawn twice stands twice.
using Resample = std::vector<std::size_t>;

// Resample `number`, from 0: its own seed derive_seed(seed, {"bootstrap", scheme, number}), so that any one
// can be drawn alone.
Resample draw_resample(std::span<const DriveName> drives, ResampleScheme scheme, std::uint64_t seed,
                       std::size_t number);

// "" or the sentence why every resample would be the set itself.
std::string why_no_bootstrap(std::span<const DriveName> drives, ResampleScheme scheme);

struct Replicate {
  Resample resample;
  Vector z;
  double cost = 0;  // sum of J_n over the resample
  std::string termination;
};

// The fit to a given resample. Throws std::invalid_argument for a place that does not exist, and what refit()
// throws.
Replicate fit_resample(const std::shared_ptr<const RecordingCosts>& recordings, const Resample& resample,
                       const RefitOptions& options, std::uint64_t seed, const Stop& stop = {});

struct BootstrapPlan {
  std::size_t replicates = 0;
  ResampleScheme scheme = ResampleScheme::Stratified;
  std::uint64_t seed = 1;
  int threads = 0;  // 0: one per core; no result depends on it
  RefitOptions refit;
};

// Keeps replicates between processes; called from several threads, one at a time.
class ReplicateStore {
 public:
  virtual ~ReplicateStore() = default;
  // Null where it is not there.
  virtual const Replicate* find(std::size_t number) const = 0;
  virtual void add(std::size_t number, const Replicate& replicate) = 0;
};

// All replicates in their order; those that the store (null: none) has with the same resample are taken from
// there, the others are added to it as they end. The watcher is told of each. Throws Interruption, and what
// refit() and the store throw.
std::vector<Replicate> bootstrap(const std::shared_ptr<const RecordingCosts>& recordings,
                                 const BootstrapPlan& plan, ReplicateStore* store, Watcher& watcher,
                                 const Stop& stop = {});

}  // namespace odobench
