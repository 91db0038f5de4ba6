// scripts/check.sh must fail, and say where, for each kind of violation it looks for: planted one by one in a small tree.
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <ostream>
#include <stdexcept>
#include <string>
#include <vector>

namespace {

namespace fs = std::filesystem;

struct Outcome {
  int exit_code = -1;
  std::string output;
};

Outcome run_shell(const std::string& command) {
  Outcome outcome;
  FILE* pipe = popen((command + " 2>&1").c_str(), "r");
  if (!pipe) return outcome;
  std::array<char, 4096> buffer;
  while (const std::size_t count = fread(buffer.data(), 1, buffer.size(), pipe)) {
    outcome.output.append(buffer.data(), count);
  }
  const int status = pclose(pipe);
  if (WIFEXITED(status)) outcome.exit_code = WEXITSTATUS(status);
  return outcome;
}

// A checkout in miniature, without violations, deleted at the end.
class MiniatureTree {
 public:
  MiniatureTree() {
    std::string name = (fs::temp_directory_path() / "odobench_check_XXXXXX").string();
    if (!mkdtemp(name.data())) throw std::runtime_error("cannot create " + name);
    root_ = name;
    fs::copy_file(fs::path(ODOBENCH_SOURCE_DIR) / ".clang-format", root_ / ".clang-format");
    write("CMakeLists.txt", "project(miniature)  # never -ffast-math\n");
    write("datasets/recording.hpp", "#pragma once\n");
    write("problems/problem.hpp", "// A comment first.\n#pragma once\n#include \"datasets/recording.hpp\"\n");
    write("solvers/solver.hpp", "#pragma once\n#include \"problems/problem.hpp\"\n");
    write("reports/record.hpp", "#pragma once\n#include <string>\n");
    write("bench/main.cpp", "#include \"reports/record.hpp\"\n#include \"solvers/solver.hpp\"\nint main() {}\n");
  }
  ~MiniatureTree() { fs::remove_all(root_); }
  MiniatureTree(const MiniatureTree&) = delete;
  MiniatureTree& operator=(const MiniatureTree&) = delete;

  void write(const std::string& path, const std::string& text) const {
    fs::create_directories((root_ / path).parent_path());
    std::ofstream(root_ / path) << text;
  }
  Outcome check() const {
    return run_shell("'" ODOBENCH_SOURCE_DIR "/scripts/check.sh' '" + root_.string() + "'");
  }

 private:
  fs::path root_;
};

struct Violation {
  std::string name, path, text, expected;
};
void PrintTo(const Violation& violation, std::ostream* out) { *out << violation.name; }

const std::vector<Violation> kViolations = {
    {"DatasetsIncludeProblems", "datasets/reader.hpp", "#pragma once\n#include \"problems/problem.hpp\"\n",
     "datasets/reader.hpp:2: includes \"problems/problem.hpp\": datasets/ includes nothing of ours"},
    {"ReportsIncludeSolvers", "reports/table.hpp", "#pragma once\n#include \"solvers/solver.hpp\"\n",
     "reports/table.hpp:2: includes \"solvers/solver.hpp\": reports/ includes nothing of ours"},
    {"ProblemsIncludeOtherDatasetHeader", "problems/model.cpp", "#include \"datasets/reader.hpp\"\n",
     "problems/model.cpp:1: includes \"datasets/reader.hpp\": problems/ includes only"},
    {"SolversIncludeConcreteProblem", "solvers/method.cpp", "#include \"problems/calibration/model.hpp\"\n",
     "solvers/method.cpp:1: includes \"problems/calibration/model.hpp\": solvers/ includes only"},
    {"SolversIncludeDatasets", "solvers/method.cpp", "#include \"datasets/recording.hpp\"\n",
     "solvers/method.cpp:1: includes \"datasets/recording.hpp\": solvers/ includes only"},
    {"TestsIncludeBench", "tests/test_cli.cpp", "#include \"bench/options.hpp\"\n",
     "tests/test_cli.cpp:1: includes \"bench/options.hpp\": nothing includes bench/"},
    {"BenchIncludesTests", "bench/run.cpp", "#include \"tests/support/shared.hpp\"\n",
     "bench/run.cpp:1: includes \"tests/support/shared.hpp\": nothing but tests/ includes tests/"},
    {"RelativePath", "solvers/method.cpp", "#include \"solver.hpp\"\n",
     "solvers/method.cpp:1: includes \"solver.hpp\": write the path from the repository root"},
    {"AngleBrackets", "solvers/method.cpp", "#include <bench/options.hpp>\n",
     "solvers/method.cpp:1: includes \"bench/options.hpp\": write our own headers in quotes"},
    {"NoPragmaOnce", "solvers/method.hpp", "// A comment.\nint f();\n", "solvers/method.hpp:1: no #pragma once"},
    {"NativeCode", "CMakeLists.txt", "add_compile_options(-O3\n  -march=native)\n",
     "CMakeLists.txt:2: -march=native is not allowed"},
    {"FastMath", "cmake/flags.cmake", "set(CMAKE_CXX_FLAGS \"-ffast-math\")\n",
     "cmake/flags.cmake:1: -ffast-math is not allowed"},
    {"FastMathInPreset", "CMakePresets.json", "{\"CMAKE_CXX_FLAGS\": \"-Ofast\"}\n",
     "CMakePresets.json:1: -Ofast is not allowed"},
    {"OptimisePragma", "solvers/method.cpp", "#pragma GCC optimize(\"fast-math\")\n",
     "solvers/method.cpp:1: changes optimisation"},
};

class CheckScriptViolation : public ::testing::TestWithParam<Violation> {};

TEST(CheckScript, PassesWithoutViolation) {
  const Outcome outcome = MiniatureTree().check();
  EXPECT_EQ(outcome.exit_code, 0) << outcome.output;
}

TEST_P(CheckScriptViolation, FailsAndSaysWhere) {
  const MiniatureTree tree;
  tree.write(GetParam().path, GetParam().text);
  const Outcome outcome = tree.check();
  EXPECT_EQ(outcome.exit_code, 1);
  EXPECT_NE(outcome.output.find(GetParam().expected), std::string::npos) << outcome.output;
}
INSTANTIATE_TEST_SUITE_P(Planted, CheckScriptViolation, ::testing::ValuesIn(kViolations),
                         [](const auto& violation) { return violation.param.name; });

TEST(CheckScript, FailsForALongFile) {
  const MiniatureTree tree;
  std::string text;
  for (int line = 0; line < 451; ++line) text += "// A line.\n";
  tree.write("solvers/method.cpp", text);
  const Outcome outcome = tree.check();
  EXPECT_EQ(outcome.exit_code, 1);
  EXPECT_NE(outcome.output.find("solvers/method.cpp:451: longer than 450 lines"), std::string::npos) << outcome.output;
}

TEST(CheckScript, FailsForUnformattedCodeOrSaysThatItCannotLook) {
  const MiniatureTree tree;
  tree.write("solvers/method.cpp", "int   f( );\n");
  const Outcome outcome = tree.check();
  if (outcome.output.find("check: format skipped") != std::string::npos) {
    EXPECT_EQ(outcome.exit_code, 0) << outcome.output;
    GTEST_SKIP() << "clang-format 14 is not installed";
  }
  EXPECT_EQ(outcome.exit_code, 1);
  EXPECT_NE(outcome.output.find("solvers/method.cpp:1:"), std::string::npos) << outcome.output;
}

TEST(CheckScript, FailsWhereThereIsNoSource) {
  EXPECT_NE(run_shell("'" ODOBENCH_SOURCE_DIR "/scripts/check.sh' /nonexistent").exit_code, 0);
}

}  // namespace
