// Particle swarms on the box: particles with position x, velocity v and personal best p. u1, u2 are vectors
// of numbers uniform in [0, 1), drawn anew for every use; (.) is the product element by element.
//
// variant=modern (default): the swarm moves in the frame of its own memory, and its inertia follows its
// success. With B the eigenvectors of the covariance of the personal bests, every iteration does
//     v <- W v + c1 B [u1 (.) B'(p - x)] + c2 B [u2 (.) B'(l - x)],   x <- x + v                         (M1)
//     W <- W + 0.05 (f - 0.4), kept in [0.3, 0.8];  f = share of the particles that bettered their best  (M2)
// where l is the best personal best among the particle and `informants` others, drawn anew after every
// iteration that did not better the swarm's best (the random topology of Clerc's Standard PSO 2007). The
// cloud of personal bests takes the shape of the level sets, so that (M1) is the swarm (3.13) in coordinates
// in which the valley is axis-parallel: its own numbers never have to know the valley's direction or
// condition. (M2) is the success-based inertia of Nickabadi et al. (Appl. Soft Comput. 11, 2011) as a
// controller: too wide a swarm never betters a best in a narrow valley, one that always does is contracting
// too early. x lives in the coordinates of solvers/box/boundary_map.hpp; a coordinate that leaves them is put
// on the bound and loses its velocity, so that the swarm can lie on bounds exactly.
//
// variant=thesis (J. Vitko, Zagreb 2024), g the best of the swarm, fixed W, c1, c2, x clipped to the box,
// v = 0 at first:
//     v <- W v + c1 u1 (.) (p - x) + c2 u2 (.) (g - x),   x <- x + v                            (3.13)-(3.14)
// (the thesis prints c1 twice; the second one is c2).
// variant=matlab: solvers/population/particle_swarm_matlab.cpp.
#pragma once

#include "solvers/solver.hpp"

namespace odobench {

struct ParticleSwarmOptions {
  std::string variant = "modern";
  int swarm = 0;        // 0: modern 4 m, at least 20; thesis 100; matlab min(100, 10 m)
  int iterations = 0;   // 0: modern 20000; thesis 500; matlab 200 m
  double inertia = -1;  // W; -1: modern 0.6 at first, thesis 0.7298; matlab adapts it in [0.1, 1.1]
  double c1 = -1;       // -1: modern 0.8, thesis 1.49618, matlab 1.49
  double c2 = -1;       // -1: modern 1.2, thesis 1.49618, matlab 1.49
  // modern
  int informants = 3;
  double cost_tolerance = 1e-12;
  double boundary = 0.01;
  // matlab
  double min_neighbours = 0.25;
  int stall_iterations = 20;
  double function_tolerance = 1e-6;
  void bind(OptionBinder& binder);
  void validate() const;
};

class ParticleSwarm final : public Solver {
 public:
  explicit ParticleSwarm(ParticleSwarmOptions options) : options_(std::move(options)) {}
  std::string why_not(const Problem&) const override { return {}; }
  Outcome minimise(Run& run) const override;

 private:
  ParticleSwarmOptions options_;
};

Outcome minimise_swarm_modern(Run& run, const ParticleSwarmOptions& options);
Outcome minimise_swarm_thesis(Run& run, const ParticleSwarmOptions& options);
Outcome minimise_swarm_matlab(Run& run, const ParticleSwarmOptions& options);

SolverEntry particle_swarm_entry();

// Positions (m x n), velocities, personal bests and their costs.
struct Swarm {
  Matrix x, v, best;
  Vector best_costs;
  // The newly evaluated costs of x; returns how many particles bettered their best.
  int remember(const Vector& costs);
};

}  // namespace odobench
