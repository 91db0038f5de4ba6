// --data=FILE of a benchmark, which Google Benchmark does not know.
#pragma once

#include <algorithm>
#include <cstring>
#include <string>

namespace odobench {

// Takes the option out of the arguments; `otherwise` without it.
inline std::string take_data_option(int& argc, char** argv, std::string otherwise = "") {
  for (int i = 1; i < argc; ++i) {
    if (std::strncmp(argv[i], "--data=", 7) != 0) continue;
    otherwise = argv[i] + 7;
    std::rotate(argv + i, argv + i + 1, argv + argc);
    --argc;
    --i;
  }
  return otherwise;
}

}  // namespace odobench
