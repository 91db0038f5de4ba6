#include <algorithm>
#include <cmath>
#include <limits>

#include "solvers/lattice/ternary_blocks.hpp"
#include "solvers/lattice/ternary_search.hpp"

namespace odobench {
namespace {

constexpr int kLargestTable = 10;  // 3^10 doubles are 0.5 MB
constexpr int kColumnDigits = 4;

int power_of_three(int n) {
  int value = 1;
  while (n-- > 0) value *= 3;
  return value;
}

// g't of all t in {-1, 0, 1}^n, the first variable being the fastest; `out` has room for 3^n.
void linear_terms(const double* g, int n, double* out) {
  out[0] = 0;
  int size = 1;
  for (int i = 0; i < n; ++i, size *= 3)
    for (int k = 0; k < size; ++k) {
      const double base = out[k];
      out[k] = base - g[i];
      out[k + size] = base;
      out[k + 2 * size] = base + g[i];
    }
}

// One block of at most kLargestTable variables: t'Qt in a table of rows (the later variables) and columns
// (the first ones), to which a linear term adds one number per row and one per column. t and -t share an
// entry, whose value is the better of their costs, t'Qt - |g't|: the upper half of the rows is enough,
// beginning with the row of zeros.
class TableBlock {
 public:
  explicit TableBlock(const Eigen::MatrixXd& q)
      : n_(static_cast<int>(q.rows())),
        first_(std::min(n_, kColumnDigits)),
        all_rows_(power_of_three(n_ - first_)),
        rows_(all_rows_ / 2 + 1),
        columns_(power_of_three(first_)),
        padded_(ternary::padded(columns_)),
        q_(q),
        table_(static_cast<std::size_t>(rows_) * static_cast<std::size_t>(padded_),
               std::numeric_limits<double>::infinity()),
        row_(static_cast<std::size_t>(all_rows_)),
        column_(static_cast<std::size_t>(padded_), 0.0) {
    Eigen::VectorXd t(n_);
    for (int r = 0; r < rows_; ++r)
      for (int c = 0; c < columns_; ++c) {
        decode(r, c, t.data());
        table_[static_cast<std::size_t>(r) * static_cast<std::size_t>(padded_) +
               static_cast<std::size_t>(c)] = t.dot(q_ * t);
      }
  }

  int size() const { return n_; }

  double minimise(const double* g, double* t, const ternary::Kernel& kernel, std::int64_t& evaluations) {
    const int free = fix_what_no_choice_can_turn(g, t);
    if (free == 0) {
      evaluations += 1;
    } else if (free <= n_ - first_ - 1) {
      best_ = std::numeric_limits<double>::infinity();
      enumerate(0, free, 0);
      for (int f = 0; f < free; ++f) t[free_[f]] = best_choice_[f];
      evaluations += power_of_three(free);
    } else {
      linear_terms(g, first_, column_.data());
      linear_terms(g + first_, n_ - first_, row_.data());
      const double* const upper_half = row_.data() + all_rows_ / 2;
      const int row = kernel.smallest(table_.data(), upper_half, rows_, column_.data(), padded_);
      const double* const entries =
          table_.data() + static_cast<std::size_t>(row) * static_cast<std::size_t>(padded_);
      const auto value = [&](int c) {
        return entries[c] - std::abs(column_[static_cast<std::size_t>(c)] + upper_half[row]);
      };
      int column = 0;
      for (int c = 1; c < columns_; ++c)
        if (value(c) < value(column)) column = c;
      decode(row, column, t);
      if (column_[static_cast<std::size_t>(column)] + upper_half[row] < 0)
        for (int i = 0; i < n_; ++i) t[i] = t[i] == 0 ? 0 : -t[i];
      evaluations += static_cast<std::int64_t>(all_rows_) * columns_;
    }
    double cost = 0;
    for (int i = 0; i < n_; ++i) {
      double row = -g[i];
      for (int j = 0; j < n_; ++j) row += q_(j, i) * t[j];
      cost += row * t[i];
    }
    return cost;
  }

 private:
  // `row` counts within the upper half.
  void decode(int row, int column, double* t) const {
    row += all_rows_ / 2;
    for (int i = 0; i < first_; ++i, column /= 3) t[i] = column % 3 - 1;
    for (int i = first_; i < n_; ++i, row /= 3) t[i] = row % 3 - 1;
  }

  // With s = g - 2 Q t of the fixed variables, t_i is 1 in every optimum when even the worst choice of the
  // free others leaves s_i above Q_ii, -1 mirrored, 0 when even the best keeps |s_i| below it. Returns how
  // many stay free.
  int fix_what_no_choice_can_turn(const double* g, double* t) {
    int free = n_;
    for (int i = 0; i < n_; ++i) {
      free_[i] = i;
      slope_[i] = g[i];
      others_[i] = 0;
      for (int j = 0; j < n_; ++j) others_[i] += j == i ? 0 : 2.0 * std::abs(q_(j, i));
    }
    for (int f = 0; f < free;) {
      const int i = free_[f];
      const double slope = std::abs(slope_[i]);
      const bool turned = slope - others_[i] > q_(i, i);
      if (!turned && !(slope + others_[i] < q_(i, i))) {
        ++f;
        continue;
      }
      t[i] = turned ? std::copysign(1.0, slope_[i]) : 0.0;
      free_[f] = free_[--free];
      for (int k = 0; k < free; ++k) {
        const int j = free_[k];
        slope_[j] -= 2.0 * t[i] * q_(j, i);
        others_[j] -= 2.0 * std::abs(q_(j, i));
      }
      f = 0;
    }
    return free;
  }

  // All choices of free_[f..free), cost of the earlier ones given.
  void enumerate(int f, int free, double cost) {
    if (f == free) {
      if (cost < best_) {
        best_ = cost;
        std::copy(choice_, choice_ + free, best_choice_);
      }
      return;
    }
    const int i = free_[f];
    for (const double value : {-1.0, 0.0, 1.0}) {
      double slope = slope_[i];
      for (int h = 0; h < f; ++h) slope -= 2.0 * choice_[h] * q_(i, free_[h]);
      choice_[f] = value;
      enumerate(f + 1, free, cost + value * (value * q_(i, i) - slope));
    }
  }

  int n_, first_, all_rows_, rows_, columns_, padded_;
  Eigen::MatrixXd q_;
  std::vector<double> table_, row_, column_;
  int free_[kLargestTable] = {};
  double slope_[kLargestTable] = {}, others_[kLargestTable] = {};
  double choice_[kLargestTable] = {}, best_choice_[kLargestTable] = {};
  double best_ = 0;
};

class TernaryExact final : public BlockSearch {
 public:
  TernaryExact(const std::vector<QuadraticBlock>& blocks, int largest_table, std::function<bool()> stop,
               InstructionSet kernel)
      : stop_(std::move(stop)), kernel_(ternary::select(kernel)) {
    check_blocks(blocks);
    for (const QuadraticBlock& block : blocks) {
      Part part;
      // Equal blocks share their table: x and y of a window do.
      for (std::size_t b = 0; b < parts_.size() && part.twin < 0; ++b)
        if (blocks[b].q.rows() == block.q.rows() && blocks[b].q == block.q)
          part.twin = parts_[b].twin < 0 ? static_cast<int>(b) : parts_[b].twin;
      part.size = block.q.rows();
      if (part.twin < 0 && part.size <= largest_table) part.table = std::make_unique<TableBlock>(block.q);
      if (part.twin < 0 && part.size > largest_table)
        part.tree = std::make_unique<TernaryBranchAndBound>(block.q);
      parts_.push_back(std::move(part));
    }
    greedy_ = ternary_greedy(blocks, kernel);
  }

  SearchResult minimise(std::span<const double> g, std::span<double> x) override {
    SearchResult result;
    result.iterations = 1;
    if (needs_incumbent()) greedy_->minimise(g, x);
    const double* from = g.data();
    double* to = x.data();
    for (const Part& part : parts_) {
      const Part& owner = part.twin < 0 ? part : parts_[static_cast<std::size_t>(part.twin)];
      if (owner.table)
        result.cost += owner.table->minimise(from, to, kernel_, result.evaluations);
      else
        result.cost +=
            owner.tree->minimise(Eigen::Map<const Eigen::VectorXd>(from, part.size),
                                 Eigen::Map<Eigen::VectorXd>(to, part.size), stop_, result.evaluations);
      from += part.size;
      to += part.size;
    }
    return result;
  }

 private:
  struct Part {
    Eigen::Index size = 0;
    int twin = -1;
    std::unique_ptr<TableBlock> table;
    std::unique_ptr<TernaryBranchAndBound> tree;
  };
  bool needs_incumbent() const {
    return std::any_of(parts_.begin(), parts_.end(), [](const Part& part) { return part.tree != nullptr; });
  }
  std::function<bool()> stop_;
  ternary::Kernel kernel_;
  std::vector<Part> parts_;
  std::unique_ptr<BlockSearch> greedy_;
};

}  // namespace

std::unique_ptr<BlockSearch> ternary_exact(const std::vector<QuadraticBlock>& blocks,
                                           std::function<bool()> stop, InstructionSet kernel) {
  return std::make_unique<TernaryExact>(blocks, kLargestTable, std::move(stop), kernel);
}

std::unique_ptr<BlockSearch> ternary_branch_and_bound(const std::vector<QuadraticBlock>& blocks,
                                                      std::function<bool()> stop) {
  return std::make_unique<TernaryExact>(blocks, 0, std::move(stop), InstructionSet::Baseline);
}

}  // namespace odobench
