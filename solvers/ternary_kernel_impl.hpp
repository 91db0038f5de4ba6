// Templates behind ternary_kernel.hpp, compiled once per vector width. Included by ternary_kernel_*.cpp only. Everything
// has internal linkage and uses no inline function of another header, so that no wide instruction leaks elsewhere.
#pragma once

#include <string.h>

#include "solvers/ternary_kernel.hpp"

namespace odobench::ternary {
namespace {

template <int W>
struct Lanes {
  typedef double Pack __attribute__((vector_size(W * sizeof(double))));
  typedef long long Mask __attribute__((vector_size(W * sizeof(double))));
};
template <int W>
using Pack = typename Lanes<W>::Pack;
template <int W>
using Mask = typename Lanes<W>::Mask;

template <int W>
inline Pack<W> load(const double* from) {
  Pack<W> v;
  memcpy(&v, from, sizeof v);
  return v;
}
template <int W>
inline void store(double* to, const Pack<W>& v) {
  memcpy(to, &v, sizeof v);
}

// One scan: the largest gain above 0, the first among equals in the order even 0, odd 0, even 1, ...; whether there was one.
template <int W>
inline bool step(GreedyBlock& b) {
  Pack<W> best = {};  // strictly greater than 0 wins
  Pack<W> place = {};
  Pack<W> first;
  for (int l = 0; l < W; ++l) first[l] = 2.0 * l;
  for (int i = 0; i < b.padded; i += W) {
    const Pack<W> slope = load<W>(b.slope + i), diagonal = load<W>(b.diagonal + i);
    const Pack<W> up = load<W>(b.up + i), down = load<W>(b.down + i);
    const Pack<W> gain_up = up * (slope - up * diagonal), gain_down = down * (slope - down * diagonal);
    const Pack<W> at = first + 2.0 * i;
    const Mask<W> better_up = gain_up > best;
    best = better_up ? gain_up : best;
    place = better_up ? at : place;
    const Mask<W> better_down = gain_down > best;
    best = better_down ? gain_down : best;
    place = better_down ? at + 1.0 : place;
  }
  double gains[W], places[W];
  store<W>(gains, best);
  store<W>(places, place);
  double gain = gains[0], where = places[0];
  for (int l = 1; l < W; ++l) {
    const bool better = gains[l] > gain || (gains[l] == gain && places[l] < where);
    gain = better ? gains[l] : gain;
    where = better ? places[l] : where;
  }
  // Every move lowers the cost, so there is an end; only rounding could let tied moves go round for ever.
  if (!(gain > 0) || b.moves >= kMovesPerEntry * b.n) return false;
  const int j = static_cast<int>(where), i = j >> 1;
  const double d = (j & 1) == 0 ? b.up[i] : b.down[i];
  const double t = b.t[i] + d;
  b.t[i] = t;
  b.up[i] = t > 0 ? -1.0 : 1.0 - t;
  b.down[i] = t < 0 ? 1.0 : -1.0 - t;
  b.gain += gain;
  ++b.moves;
  const double* const column = b.twice_q + static_cast<long>(i) * b.padded;
  for (int k = 0; k < b.padded; k += W) store<W>(b.slope + k, load<W>(b.slope + k) - d * load<W>(column + k));
  return true;
}

// The blocks take turns: their scans do not depend on each other and overlap in the processor.
template <int W>
void greedy(GreedyBlock* blocks, int count) {
  unsigned long long going = count >= 64 ? ~0ULL : (1ULL << count) - 1;
  while (going != 0)
    for (int b = 0; b < count; ++b)
      if ((going >> b & 1) != 0 && !step<W>(blocks[b])) going &= ~(1ULL << b);
}

template <int W>
Smallest smallest(const double* table, const double* row, int rows, const double* column, int columns) {
  Smallest best{0, -1};
  for (int i = 0; i < rows; ++i, table += columns) {
    Pack<W> low = load<W>(table) + load<W>(column);
    for (int j = W; j < columns; j += W) {
      const Pack<W> value = load<W>(table + j) + load<W>(column + j);
      low = value < low ? value : low;
    }
    double value = low[0];
    for (int l = 1; l < W; ++l) value = low[l] < value ? low[l] : value;
    value += row[i];
    if (best.row < 0 || value < best.value) best = {value, i};
  }
  return best;
}

template <int W>
Kernel make_kernel(const char* name) {
  return {name, greedy<W>, smallest<W>};
}

}  // namespace
}  // namespace odobench::ternary
