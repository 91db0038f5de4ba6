#include "solvers/lattice/greedy_scan.hpp"

namespace odobench {

Eigen::Index greedy_choice(const Vector& costs, double incumbent) {
  Eigen::Index choice = -1;
  double best = incumbent;
  for (Eigen::Index k = 0; k < costs.size(); ++k) {
    if (!(costs[k] < best)) continue;
    best = costs[k];
    choice = k;
  }
  return choice;
}

ScanEnd greedy_scan(Run& run, const Neighbourhood& neighbourhood, Vector& u, double& cost, int& moves_left) {
  for (;;) {
    const Matrix neighbours = neighbourhood(u);
    if (neighbours.cols() == 0) return ScanEnd::LocalMinimum;
    Vector costs(neighbours.cols());
    run.batch_cost(neighbours, costs);
    if (run.stop()) return ScanEnd::RunStopped;
    run.iteration();
    const Eigen::Index choice = greedy_choice(costs, cost);
    if (choice < 0) return ScanEnd::LocalMinimum;
    if (moves_left == 0) return ScanEnd::MoveLimit;
    --moves_left;
    u = neighbours.col(choice);
    cost = costs[choice];
  }
}

}  // namespace odobench
