#include "problems/classic/nist.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "problems/classic/nist_models.hpp"

namespace odobench {
namespace {

using Groups = std::vector<std::vector<int>>;  // parameters of terms that may change places
struct Symmetry {
  Groups terms;
  Groups signs;  // parameters that may change their signs together
};

Symmetry symmetry_of(const std::string& name) {
  if (name.starts_with("Lanczos")) return {{{0, 1}, {2, 3}, {4, 5}}, {}};
  if (name == "MGH17") return {{{1, 3}, {2, 4}}, {}};
  if (name == "ENSO") return {{{3, 4, 5}, {6, 7, 8}}, {{3, 5}, {6, 8}}};
  if (name.starts_with("Gauss")) return {{{2, 3, 4}, {5, 6, 7}}, {{4}, {7}}};
  if (name == "Eckerle4") return {{}, {{0, 1}}};
  return {};
}

// The certified parameters first, then what the symmetry makes of them.
std::vector<Vector> equivalent(const Vector& certified, const Symmetry& symmetry) {
  std::vector<std::size_t> order(symmetry.terms.size());
  for (std::size_t k = 0; k < order.size(); ++k) order[k] = k;
  std::vector<Vector> list;
  do {
    Vector x = certified;
    for (std::size_t k = 0; k < order.size(); ++k)
      for (std::size_t i = 0; i < symmetry.terms[k].size(); ++i)
        x[symmetry.terms[k][i]] = certified[symmetry.terms[order[k]][i]];
    for (unsigned flips = 0; flips < 1u << symmetry.signs.size(); ++flips) {
      Vector y = x;
      for (std::size_t k = 0; k < symmetry.signs.size(); ++k)
        if (flips >> k & 1u)
          for (const int i : symmetry.signs[k]) y[i] = -y[i];
      list.push_back(y);
    }
  } while (std::next_permutation(order.begin(), order.end()));
  return list;
}

class Regression {
 public:
  Regression(std::string name, const NistData& data, const Vector& start)
      : name_(std::move(name)), model_(nist_model(data.name)), optimum_(data.certified_rss) {
    for (Eigen::Index i = 0; i < start.size(); ++i) {
      const double half = 10 * std::max({std::abs(data.starts[0][i]), std::abs(data.starts[1][i]),
                                         std::abs(data.certified[i])});
      parameters_.push_back({fmt::format("b{}", i + 1), "1", start[i], -half, half});
    }
    y_ = data.observations.col(0);
    if (data.name == "Nelson") y_ = y_.array().log();
    x_ = data.observations.rightCols(data.observations.cols() - 1).transpose();
    for (const Vector& x : equivalent(data.certified, symmetry_of(data.name)))
      if (inside(x)) minimisers_.push_back(x);
  }
  std::string name() const { return name_; }
  const std::vector<ParameterInfo>& parameters() const { return parameters_; }
  double known_optimum() const { return optimum_; }
  const std::vector<Vector>& known_minimisers() const { return minimisers_; }
  Eigen::Index residual_count() const { return y_.size(); }

  double cost(const ConstVectorRef& x) const {
    Vector r(residual_count());
    residuals(x, r);
    return r.squaredNorm();
  }
  void residuals(const ConstVectorRef& b, VectorRef r) const {
    for (Eigen::Index i = 0; i < r.size(); ++i) r[i] = model_(b.data(), x_.col(i).data(), nullptr) - y_[i];
  }
  void residuals_and_jacobian(const ConstVectorRef& b, VectorRef r, MatrixRef j) const {
    Vector row(b.size());
    for (Eigen::Index i = 0; i < r.size(); ++i) {
      r[i] = model_(b.data(), x_.col(i).data(), row.data()) - y_[i];
      j.row(i) = row.transpose();
    }
  }

 private:
  bool inside(const Vector& x) const {
    for (std::size_t i = 0; i < parameters_.size(); ++i)
      if (!(std::abs(x[static_cast<Eigen::Index>(i)]) < parameters_[i].upper)) return false;
    return true;
  }

  std::string name_;
  NistModel model_;
  double optimum_;
  std::vector<ParameterInfo> parameters_;
  std::vector<Vector> minimisers_;
  Vector y_;
  Matrix x_;  // one column per observation
};

std::string problem_name(const NistData& data, std::size_t start) {
  return fmt::format("nist:{}/{}", data.name, start + 1);
}

}  // namespace

std::vector<ClassicEntry> nist_entries() {
  std::vector<ClassicEntry> list;
  for (const NistData& data : nist_data())
    for (std::size_t k = 0; k < data.starts.size(); ++k) {
      const int n = static_cast<int>(data.certified.size());
      list.push_back({problem_name(data, k), "nist", n, DimensionRule::exactly(n),
                      static_cast<int>(data.observations.rows()),
                      fmt::format("NIST StRD {}, start {}: {}", data.name, k + 1, data.model),
                      data.certified_rss});
    }
  return list;
}

Problem make_nist_problem(const std::string& name) {
  for (const NistData& data : nist_data())
    for (std::size_t k = 0; k < data.starts.size(); ++k)
      if (name == problem_name(data, k)) return Problem(Regression(name, data, data.starts[k]));
  throw std::invalid_argument(fmt::format("unknown problem '{}'", name));
}

}  // namespace odobench
