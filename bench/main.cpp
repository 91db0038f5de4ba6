#include "bench/cli.hpp"

int main(int argc, char** argv) {
  return odobench::bench_main(argc, argv);
}
