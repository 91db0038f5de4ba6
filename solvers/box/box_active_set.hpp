// Primal active-set method for strictly convex quadratic models on a box, shared by its two forms: H and g
// (solvers/box/box_quadratic.hpp) and A and b (solvers/box/box_least_squares.hpp).
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "problems/problem.hpp"

namespace odobench {

enum class Held : char { No, Lower, Upper };
using Indices = std::vector<Eigen::Index>;

inline Indices free_of(const std::vector<Held>& held) {
  Indices free;
  for (std::size_t i = 0; i < held.size(); ++i)
    if (held[i] == Held::No) free.push_back(static_cast<Eigen::Index>(i));
  return free;
}

// The Model has
//     Vector gradient(d) const              of the model at d (m)
//     Vector free_step(free, d, g) const    from d to the minimum over the free coordinates, in their order
//     double size(i) const                  square root of the curvature along coordinate i
// Returns d with lower <= d <= upper whose multipliers have the right signs; at most 50 m changes of the set.
// `held`: the set to begin with; d starts at 0 in free coordinates.
template <class Model>
Vector box_active_set(const Model& model, const Vector& lower, const Vector& upper, std::vector<Held> held) {
  const Eigen::Index m = lower.size();
  const auto at = [&](Eigen::Index i) -> Held& { return held[static_cast<std::size_t>(i)]; };
  Vector d = Vector::Zero(m);
  for (Eigen::Index i = 0; i < m; ++i)
    if (at(i) != Held::No) d[i] = at(i) == Held::Lower ? lower[i] : upper[i];
  for (Eigen::Index change = 0; change < 50 * m; ++change) {
    const Indices free = free_of(held);
    Vector step = Vector::Zero(m);
    if (!free.empty()) step(free) = model.free_step(free, d, model.gradient(d));
    double length = 1.0;
    Eigen::Index blocking = -1;
    for (const Eigen::Index i : free) {
      const double room = step[i] < 0 ? lower[i] - d[i] : upper[i] - d[i];
      if (step[i] != 0 && room / step[i] < length) {
        length = std::max(0.0, room / step[i]);
        blocking = i;
      }
    }
    d += length * step;
    if (blocking >= 0) {
      at(blocking) = step[blocking] < 0 ? Held::Lower : Held::Upper;
      d[blocking] = step[blocking] < 0 ? lower[blocking] : upper[blocking];
      continue;
    }
    // Minimum on the free subspace: release the bound whose multiplier has the wrong sign most, or be done.
    const Vector reduced = model.gradient(d);
    Eigen::Index worst = -1;
    double worst_value = 0, largest = 0;
    for (Eigen::Index i = 0; i < m; ++i) {
      const double size = model.size(i);
      if (size > 0) largest = std::max(largest, std::abs(reduced[i]) / size);
      if (at(i) == Held::No || lower[i] == upper[i] || !(size > 0)) continue;
      const double wrong = (at(i) == Held::Lower ? -reduced[i] : reduced[i]) / size;
      if (wrong > worst_value) {
        worst_value = wrong;
        worst = i;
      }
    }
    if (worst < 0 || worst_value <= 1e-14 * largest) break;
    at(worst) = Held::No;
  }
  return d;
}

// The bounds that steepest descent from d = 0 would leave through at once.
inline std::vector<Held> held_at_start(const Vector& g, const Vector& lower, const Vector& upper) {
  std::vector<Held> held(static_cast<std::size_t>(g.size()), Held::No);
  for (Eigen::Index i = 0; i < g.size(); ++i) {
    if (lower[i] >= 0 && g[i] > 0) held[static_cast<std::size_t>(i)] = Held::Lower;
    if (upper[i] <= 0 && g[i] < 0) held[static_cast<std::size_t>(i)] = Held::Upper;
  }
  return held;
}

// Block principal pivoting (Judice, Pires 1994): all coordinates on the wrong side change at once while their
// number falls and a few times more, else only the last of them (Murty's rule, which ends). Returns the set
// it ended with, right or not: the active-set method goes on from there.
template <class Model>
std::vector<Held> pivoted_set(const Model& model, const Vector& lower, const Vector& upper,
                              std::vector<Held> held) {
  constexpr int kPatience = 10;
  const Eigen::Index m = lower.size();
  std::size_t fewest = static_cast<std::size_t>(m) + 1;
  int patience = kPatience;
  for (int round = 0; round < 100; ++round) {
    Vector d = Vector::Zero(m);
    for (Eigen::Index i = 0; i < m; ++i) {
      const Held at = held[static_cast<std::size_t>(i)];
      if (at != Held::No) d[i] = at == Held::Lower ? lower[i] : upper[i];
    }
    const Indices free = free_of(held);
    if (!free.empty()) d(free) += model.free_step(free, d, model.gradient(d));
    const Vector reduced = model.gradient(d);
    Indices wrong;
    std::vector<Held> next = held;
    for (Eigen::Index i = 0; i < m; ++i) {
      Held& at = next[static_cast<std::size_t>(i)];
      const Held before = at;
      if (at == Held::No)
        at = d[i] < lower[i] ? Held::Lower : d[i] > upper[i] ? Held::Upper : Held::No;
      else if (lower[i] < upper[i] && (at == Held::Lower ? reduced[i] < 0 : reduced[i] > 0))
        at = Held::No;
      if (at != before) wrong.push_back(i);
    }
    if (wrong.empty()) return held;
    if (wrong.size() < fewest) {
      fewest = wrong.size();
      patience = kPatience;
    } else if (patience-- <= 0) {
      const auto last = static_cast<std::size_t>(wrong.back());
      const Held changed = next[last];
      next = held;
      next[last] = changed;
    }
    held = std::move(next);
  }
  return held;
}

// The minimum of the model on the box; g is its gradient at d = 0. Small models change one bound at a time;
// large ones, whose factorisations cost, find their set by pivoting first.
template <class Model>
Vector minimise_on_box(const Model& model, const Vector& g, const Vector& lower, const Vector& upper) {
  constexpr Eigen::Index kLarge = 33;
  std::vector<Held> held = held_at_start(g, lower, upper);
  if (g.size() >= kLarge) held = pivoted_set(model, lower, upper, std::move(held));
  return box_active_set(model, lower, upper, std::move(held));
}

}  // namespace odobench
