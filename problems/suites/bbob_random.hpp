// The random numbers, rotations, optima and offsets of the BBOB functions: the generator of N. Hansen,
// S. Finck, R. Ros, A. Auger, "Real-parameter black-box optimization benchmarking 2009: noiseless functions
// definitions", INRIA RR-6829, as the COCO platform has it. Instances are COCO's: instance 3 of f10 in five
// dimensions is the same function here and there.
#pragma once

#include <cstdint>
#include <vector>

#include "problems/matrices.hpp"

namespace odobench {

// Numbers in (0, 1): Lewis, Goodman and Miller's generator (16807, modulo 2^31 - 1) behind a table of 32 that
// it shuffles.
std::vector<double> bbob_uniform(std::size_t count, std::int64_t seed);

// Standard normal numbers by Box and Muller of the first and the second half of 2 count uniform ones.
std::vector<double> bbob_normal(std::size_t count, std::int64_t seed);

// Gram and Schmidt's orthogonal matrix of the columns of n x n normal numbers (n x n).
Matrix bbob_rotation(std::int64_t seed, Eigen::Index n);

// Four digits in [-4, 4), never zero (n).
Vector bbob_optimum(std::int64_t seed, Eigen::Index n);

// Two digits in [-1000, 1000], of a Cauchy distribution. 4 shares the seed of 3, 18 that of 17.
double bbob_offset(int function, int instance);

// What everything of an instance is seeded by.
std::int64_t bbob_seed(int function, int instance);

}  // namespace odobench
