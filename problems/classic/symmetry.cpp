#include "problems/classic/symmetry.hpp"

#include <algorithm>
#include <numeric>

namespace odobench {

std::vector<Vector> equivalent_points(const Vector& x, const Symmetry& symmetry) {
  std::vector<std::size_t> order(symmetry.terms.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::vector<Vector> points;
  do {
    Vector exchanged = x;
    for (std::size_t k = 0; k < order.size(); ++k)
      for (std::size_t i = 0; i < symmetry.terms[k].size(); ++i)
        exchanged[symmetry.terms[k][i]] = x[symmetry.terms[order[k]][i]];
    for (unsigned flips = 0; flips < 1u << symmetry.signs.size(); ++flips) {
      points.push_back(exchanged);
      for (std::size_t k = 0; k < symmetry.signs.size(); ++k)
        if (flips >> k & 1u)
          for (const int i : symmetry.signs[k]) points.back()[i] *= -1;
    }
  } while (std::next_permutation(order.begin(), order.end()));
  return points;
}

}  // namespace odobench
