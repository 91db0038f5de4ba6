// Templates behind ternary_kernel.hpp, compiled once per vector width. Included by ternary_kernel_*.cpp only.
// Everything has internal linkage and uses no inline function of another header, so that no wide instruction
// leaks elsewhere.
#pragma once

#include <string.h>

#include "solvers/lattice/ternary_kernel.hpp"

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

// One scan: the largest gain above 0, the first among equals in the order even 0, odd 0, even 1, ...; whether
// there was one.
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
inline Pack<W> lower(const Pack<W>& a, const Pack<W>& b) {
  return a < b ? a : b;
}
template <int W>
inline Pack<W> magnitude(const Pack<W>& v) {
  return (Pack<W>)((Mask<W>)v & 0x7fffffffffffffffLL);
}

// The smallest of table[j] - |column[j] + row| in each of R rows, R chains of comparisons beside each other.
template <int W, int R>
inline void smallest_of_rows(const double* table, const double* row, const double* column, int columns,
                             double* out) {
  Pack<W> low[R];
  for (int r = 0; r < R; ++r)
    low[r] = load<W>(table + static_cast<long>(r) * columns) - magnitude<W>(load<W>(column) + row[r]);
  for (int j = W; j < columns; j += W) {
    const Pack<W> linear = load<W>(column + j);
    for (int r = 0; r < R; ++r)
      low[r] = lower<W>(load<W>(table + static_cast<long>(r) * columns + j) - magnitude<W>(linear + row[r]),
                        low[r]);
  }
  for (int r = 0; r < R; ++r) {
    double lanes[W];
    store<W>(lanes, low[r]);
    for (int width = W / 2; width > 0; width /= 2)
      for (int l = 0; l < width; ++l) lanes[l] = lanes[l + width] < lanes[l] ? lanes[l + width] : lanes[l];
    out[r] = lanes[0];
  }
}

template <int W>
int smallest(const double* table, const double* row, int rows, const double* column, int columns) {
  constexpr int kTogether = 4;
  int best = -1;
  double lowest = 0, low[kTogether];
  for (int i = 0; i < rows;) {
    const int count = rows - i >= kTogether ? kTogether : 1;
    const double* const from = table + static_cast<long>(i) * columns;
    if (count == kTogether)
      smallest_of_rows<W, kTogether>(from, row + i, column, columns, low);
    else
      smallest_of_rows<W, 1>(from, row + i, column, columns, low);
    for (int r = 0; r < count; ++r, ++i) {
      if (best >= 0 && !(low[r] < lowest)) continue;
      lowest = low[r];
      best = i;
    }
  }
  return best;
}

template <int W>
Kernel make_kernel() {
  return {greedy<W>, smallest<W>};
}

}  // namespace
}  // namespace odobench::ternary
