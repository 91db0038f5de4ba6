#include <algorithm>

#include "solvers/lattice/ternary_blocks.hpp"
#include "solvers/lattice/ternary_search.hpp"

namespace odobench {
namespace {

class TernaryGreedy final : public BlockSearch {
 public:
  TernaryGreedy(const std::vector<QuadraticBlock>& blocks, InstructionSet kernel)
      : kernel_(ternary::select(kernel)) {
    check_blocks(blocks);
    for (const QuadraticBlock& block : blocks) {
      Data data;
      data.n = static_cast<int>(block.q.rows());
      data.padded = ternary::padded(data.n);
      data.twice_q.assign(static_cast<std::size_t>(data.n * data.padded), 0.0);
      data.diagonal.assign(static_cast<std::size_t>(data.padded), kNever);
      for (int i = 0; i < data.n; ++i) {
        data.diagonal[static_cast<std::size_t>(i)] = block.q(i, i);
        for (int k = 0; k < data.n; ++k)
          data.twice_q[static_cast<std::size_t>(i * data.padded + k)] = 2.0 * block.q(k, i);
      }
      for (auto* array : {&data.slope, &data.t, &data.up, &data.down})
        array->assign(static_cast<std::size_t>(data.padded), 0.0);
      data_.push_back(std::move(data));
    }
    for (Data& d : data_)
      work_.push_back({d.n, d.padded, d.twice_q.data(), d.diagonal.data(), d.slope.data(), d.up.data(),
                       d.down.data(), d.t.data(), 0, 0});
  }

  SearchResult minimise(std::span<const double> g, std::span<double> x) override {
    const double* from = g.data();
    for (ternary::GreedyBlock& block : work_) {
      std::copy(from, from + block.n, block.slope);
      std::fill(block.slope + block.n, block.slope + block.padded, 0.0);
      std::fill(block.t, block.t + block.padded, 0.0);
      std::fill(block.up, block.up + block.padded, 1.0);
      std::fill(block.down, block.down + block.padded, -1.0);
      block.gain = 0;
      block.moves = 0;
      from += block.n;
    }
    kernel_.greedy(work_.data(), static_cast<int>(work_.size()));
    SearchResult result;
    result.iterations = 1;
    double* to = x.data();
    for (const ternary::GreedyBlock& block : work_) {
      to = std::copy(block.t, block.t + block.n, to);
      result.cost -= block.gain;
      result.iterations += block.moves;
      result.evaluations += 2LL * block.n * (block.moves + 1);
    }
    return result;
  }

 private:
  static constexpr double kNever = 1e300;
  struct Data {
    int n = 0, padded = 0;
    std::vector<double> twice_q, diagonal, slope, t, up, down;
  };
  ternary::Kernel kernel_;
  std::vector<Data> data_;
  std::vector<ternary::GreedyBlock> work_;
};

}  // namespace

std::unique_ptr<BlockSearch> ternary_greedy(const std::vector<QuadraticBlock>& blocks,
                                            InstructionSet kernel) {
  return std::make_unique<TernaryGreedy>(blocks, kernel);
}

}  // namespace odobench
