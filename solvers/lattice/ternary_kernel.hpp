// The innermost loops of the ternary searches, in several vector widths chosen at run time. Every width does
// the same operations in the same order on each element: the results are the same to the last bit.
#pragma once

namespace odobench {
enum class InstructionSet;  // problems/instruction_set.hpp, which files of wide instructions must not include
}

namespace odobench::ternary {

inline constexpr int kPad = 8;  // arrays are padded to a multiple of this, whatever the width
inline constexpr int kMovesPerEntry = 100;

// Greedy descent of one block: t' Q t - g' t over t in {-1, 0, 1}^n, lowered by `gain` so far. Entries at and
// beyond n have gradient 0 and a huge diagonal, so that they never win.
struct GreedyBlock {
  int n, padded;
  const double* twice_q;   // padded columns of 2 Q, n of them
  const double* diagonal;  // Q_ii
  double* slope;           // g - 2 Q t
  double* up;    // what the even candidate of scan position 2i would add to t_i: to 1, or from 1 to 0
  double* down;  // the odd one: to -1, or from -1 to 0
  double* t;
  double gain;
  int moves;
};

struct Kernel {
  // Runs every block to its local optimum.
  void (*greedy)(GreedyBlock* blocks, int count);
  // The row i, the first among equals, of the smallest table[i * columns + j] - |column[j] + row[i]|;
  // `columns` is a multiple of kPad.
  int (*smallest)(const double* table, const double* row, int rows, const double* column, int columns);
};

// Throws std::invalid_argument when the processor does not have it.
Kernel select(InstructionSet set);

}  // namespace odobench::ternary
