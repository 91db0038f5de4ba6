// bootstrap/PROBLEM.jsonl of a run directory: replicates as they end, so that a run that was killed goes on.
//
// The first line says of what they are,
//   {"bootstrap": 1, "problem", "dataset_sha256", "box", "scheme", "seed", "solver", "kernel", "version",
//    "start": [the fit to all recordings]},
// each other line is one replicate, in the order in which they ended and, once all are there, in their own:
//   {"replicate": number from 0, "recordings": [places from 0], "cost", "parameters": [..], "termination"}
#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>

#include "base/files.hpp"
#include "bench/studies/trust/bootstrap.hpp"

namespace odobench {

class ReplicateFile final : public ReplicateStore {
 public:
  // Takes what the file holds if its first line is `header`; anything else in it is replaced. A last line
  // that was cut off is left out, and so is everything from a damaged line on: replicates can be made again,
  // with the same bits. Throws std::invalid_argument when the file may not be replaced, DataError when it
  // cannot be read.
  ReplicateFile(std::filesystem::path file, nlohmann::json header);

  std::size_t size() const { return known_.size(); }
  // What is wrong with a damaged line, "" where none is.
  const std::string& damage() const { return damage_; }
  const Replicate* find(std::size_t number) const override;
  void add(std::size_t number, const Replicate& replicate) override;
  // Puts the replicates in their order.
  void finish();

 private:
  void read(const std::string& text);
  std::string lines() const;

  const std::filesystem::path path_;
  const std::string header_;
  std::map<std::size_t, Replicate> known_;
  std::unique_ptr<LineFile> file_;  // opened with the first replicate that is added
  bool in_order_ = true;
  std::string damage_;
};

}  // namespace odobench
