// Minimising a sum of independent quadratic blocks (problems/block_quadratic.hpp) over t in {-1, 0, 1}^n or
// [-1, 1]^n: the searches behind the solvers `exact` and `relaxed`, and the inner loops of the
// relative-entropy filter. All of them refuse (std::invalid_argument) a block that is not square, finite,
// symmetric and positive definite, and a kernel that the processor does not have. The kernel decides how fast
// a search is, never what it finds.
#pragma once

#include <functional>
#include <memory>

#include "problems/instruction_set.hpp"
#include "problems/problem.hpp"

namespace odobench {

// Greedy from t = 0 (T. Stirblys, Kaunas 2015, section 2.2.2): in each scan the single change of lowest cost,
// the first one among equals in the order i = 0.., within i the other levels from 1 down. Blocks do not meet,
// so each is searched by itself; iterations = 1 + changes, as if all were scanned together. A call allocates
// nothing.
std::unique_ptr<BlockSearch> ternary_greedy(const std::vector<QuadraticBlock>& blocks,
                                            InstructionSet kernel = widest_instruction_set());

// The lattice optimum, for many linear terms. Variables that no choice of the others can turn are fixed
// first; what is left of a block of at most 10 is enumerated with tables made once (a few ms), of a larger
// one by branch and bound, which polls `stop` now and then: when that holds the answer is the best found so
// far, never worse than the greedy one. `evaluations` counts candidates, or nodes.
std::unique_ptr<BlockSearch> ternary_exact(const std::vector<QuadraticBlock>& blocks,
                                           std::function<bool()> stop = {},
                                           InstructionSet kernel = widest_instruction_set());

// The same by branch and bound alone, best for a single linear term. Its one greedy search uses the kernel
// that every processor has.
std::unique_ptr<BlockSearch> ternary_branch_and_bound(const std::vector<QuadraticBlock>& blocks,
                                                      std::function<bool()> stop = {});

// The optimum of the relaxation [-1, 1]^n.
std::unique_ptr<BlockSearch> box_relaxation(const std::vector<QuadraticBlock>& blocks);

}  // namespace odobench
