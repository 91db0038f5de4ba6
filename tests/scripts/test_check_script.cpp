// scripts/check.sh must fail, and say where, for each kind of violation it looks for: planted one by one in a
// small tree.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <ostream>
#include <string>
#include <vector>

#include "tests/support/run_process.hpp"
#include "tests/support/source_dir.hpp"

namespace odobench::testing {
namespace {

namespace fs = std::filesystem;

ProcessResult check_script(const fs::path& root) {
  return Process({source_dir().string() + "/scripts/check.sh", root.string()}).wait();
}

// A checkout in miniature, without violations.
class MiniatureTree {
 public:
  MiniatureTree() {
    fs::copy_file(source_dir() / ".clang-format", folder_ / ".clang-format");
    write("CMakeLists.txt", "project(miniature)  # never -ffast-math\n");
    write("datasets/recording.hpp", "#pragma once\n");
    write("problems/problem.hpp", "// A comment first.\n#pragma once\n");
    write("problems/calibration/model.hpp", "#pragma once\n#include \"datasets/recording.hpp\"\n");
    write("solvers/solver.hpp", "#pragma once\n#include \"problems/problem.hpp\"\n");
    write("reports/records/record.hpp", "#pragma once\n#include <string>\n");
    write("bench/main.cpp",
          "#include \"reports/records/record.hpp\"\n#include \"solvers/solver.hpp\"\nint main() {}\n");
  }
  void write(const std::string& path, const std::string& text) const {
    fs::create_directories((folder_ / path).parent_path());
    std::ofstream(folder_ / path) << text;
  }
  ProcessResult check() const { return check_script(folder_.path()); }

 private:
  TemporaryFolder folder_;
};

struct Violation {
  std::string name, path, text, expected;
};
void PrintTo(const Violation& violation, std::ostream* out) {
  *out << violation.name;
}

const std::vector<Violation> kViolations = {
    {"DatasetsIncludeProblems", "datasets/reader.hpp", "#pragma once\n#include \"problems/problem.hpp\"\n",
     "datasets/reader.hpp:2: includes \"problems/problem.hpp\": datasets includes only base"},
    {"ReportsIncludeSolvers", "reports/render/table.hpp", "#pragma once\n#include \"solvers/solver.hpp\"\n",
     "reports/render/table.hpp:2: includes \"solvers/solver.hpp\": reports/render includes nothing of ours "
     "but "
     "base"},
    {"TablesIncludeThePage", "reports/render/table.cpp", "#include \"reports/page/html_page.hpp\"\n",
     "reports/render/table.cpp:1: includes \"reports/page/html_page.hpp\": reports/render includes nothing "
     "of ours "
     "but base"},
    {"BaseIncludesDatasets", "base/files.cpp", "#include \"datasets/reader.hpp\"\n",
     "base/files.cpp:1: includes \"datasets/reader.hpp\": base includes nothing of ours but base"},
    {"ProblemsIncludeOtherDatasetHeader", "problems/classic/model.cpp", "#include \"datasets/reader.hpp\"\n",
     "problems/classic/model.cpp:1: includes \"datasets/reader.hpp\": problems/classic includes only "
     "base"},
    {"SolversIncludeConcreteProblem", "solvers/method.cpp", "#include \"problems/calibration/model.hpp\"\n",
     "solvers/method.cpp:1: includes \"problems/calibration/model.hpp\": solvers includes only base"},
    {"SolversIncludeDatasets", "solvers/local/method.cpp", "#include \"datasets/recording.hpp\"\n",
     "solvers/local/method.cpp:1: includes \"datasets/recording.hpp\": solvers/local includes only base"},
    {"ACatalogueIncludesAVerb", "bench/catalogue/list.cpp", "#include \"bench/verbs/run.hpp\"\n",
     "bench/catalogue/list.cpp:1: includes \"bench/verbs/run.hpp\": bench/catalogue includes only base"},
    {"TestsIncludeVerbs", "tests/test_cli.cpp", "#include \"bench/verbs/run.hpp\"\n",
     "tests/test_cli.cpp:1: includes \"bench/verbs/run.hpp\": tests includes only base"},
    {"BenchIncludesTests", "bench/run.cpp", "#include \"tests/support/shared.hpp\"\n",
     "bench/run.cpp:1: includes \"tests/support/shared.hpp\": bench includes only base"},
    {"RelativePath", "solvers/method.cpp", "#include \"solver.hpp\"\n",
     "solvers/method.cpp:1: includes \"solver.hpp\": write the path from the repository root"},
    {"AngleBrackets", "solvers/method.cpp", "#include <bench/verbs/options.hpp>\n",
     "solvers/method.cpp:1: includes \"bench/verbs/options.hpp\": write our own headers in quotes"},
    {"NoPragmaOnce", "solvers/method.hpp", "// A comment.\nint f();\n",
     "solvers/method.hpp:1: no #pragma once"},
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
  const ProcessResult outcome = MiniatureTree().check();
  EXPECT_EQ(outcome.exit_code, 0) << outcome.out;
}

TEST_P(CheckScriptViolation, FailsAndSaysWhere) {
  const MiniatureTree tree;
  tree.write(GetParam().path, GetParam().text);
  const ProcessResult outcome = tree.check();
  EXPECT_EQ(outcome.exit_code, 1);
  EXPECT_NE(outcome.out.find(GetParam().expected), std::string::npos) << outcome.out;
}
INSTANTIATE_TEST_SUITE_P(Planted, CheckScriptViolation, ::testing::ValuesIn(kViolations),
                         [](const auto& violation) { return violation.param.name; });

TEST(CheckScript, FailsForACircleOfHeadersAndOfRooms) {
  const MiniatureTree tree;
  tree.write("solvers/a.hpp", "#pragma once\n#include \"solvers/b.hpp\"\n");
  tree.write("solvers/b.hpp", "#pragma once\n");
  ProcessResult outcome = tree.check();
  if (outcome.out.find("rooms skipped") != std::string::npos) GTEST_SKIP() << "python3 is not installed";
  EXPECT_EQ(outcome.exit_code, 0) << outcome.out;
  tree.write("solvers/b.hpp", "#pragma once\n#include \"solvers/a.hpp\"\n");
  outcome = tree.check();
  EXPECT_EQ(outcome.exit_code, 1);
  EXPECT_THAT(outcome.out,
              ::testing::HasSubstr("headers in a circle: solvers/a.hpp -> solvers/b.hpp -> solvers/a.hpp"));
  tree.write("solvers/b.hpp", "#pragma once\n");
  tree.write("reports/kinds/entropy/a.hpp", "#pragma once\n");
  tree.write("reports/kinds/entropy/b.cpp", "#include \"reports/kinds/planning/a.hpp\"\n");
  tree.write("reports/kinds/planning/a.hpp", "#pragma once\n");
  EXPECT_EQ(tree.check().exit_code, 0);
  tree.write("reports/kinds/planning/b.cpp", "#include \"reports/kinds/entropy/a.hpp\"\n");
  outcome = tree.check();
  EXPECT_EQ(outcome.exit_code, 1);
  EXPECT_THAT(outcome.out, ::testing::HasSubstr("reports/kinds/entropy:1: includes reports/kinds/planning"));
}

TEST(CheckScript, FailsForAFigureOfOtherRooms) {
  const MiniatureTree tree;
  tree.write("docs/figures/rooms.svg", "<svg/>");
  const ProcessResult outcome = tree.check();
  if (outcome.out.find("rooms skipped") != std::string::npos) GTEST_SKIP() << "python3 is not installed";
  EXPECT_EQ(outcome.exit_code, 1);
  EXPECT_THAT(outcome.out, ::testing::HasSubstr("docs/figures/rooms.svg:1: not that of the sources"));
}

TEST(CheckScript, FailsForALongFile) {
  const MiniatureTree tree;
  std::string text;
  for (int line = 0; line < 451; ++line) text += "// A line.\n";
  tree.write("solvers/method.cpp", text);
  const ProcessResult outcome = tree.check();
  EXPECT_EQ(outcome.exit_code, 1);
  EXPECT_NE(outcome.out.find("solvers/method.cpp:451: longer than 450 lines"), std::string::npos)
      << outcome.out;
}

TEST(CheckScript, FailsForAWideCommentAndALongFunction) {
  const MiniatureTree tree;
  std::string text = "// " + std::string(108, 'x') + "\nint f() {\n  // A comment does not count.\n";
  for (int line = 0; line < 59; ++line) text += "  f();\n";
  tree.write("solvers/method.cpp", text + "}\n");
  const ProcessResult outcome = tree.check();
  EXPECT_EQ(outcome.exit_code, 1);
  EXPECT_THAT(outcome.out, ::testing::HasSubstr("solvers/method.cpp:1: a comment of 111 columns"));
  EXPECT_THAT(outcome.out,
              ::testing::HasSubstr("solvers/method.cpp:2: a function of 61 lines, expected at most 60"));
}

TEST(CheckScript, FailsForUnformattedCodeOrSaysThatItCannotLook) {
  const MiniatureTree tree;
  tree.write("solvers/method.cpp", "int   f( );\n");
  const ProcessResult outcome = tree.check();
  if (outcome.out.find("check: format skipped") != std::string::npos) {
    EXPECT_EQ(outcome.exit_code, 0) << outcome.out;
    GTEST_SKIP() << "clang-format 14 is not installed";
  }
  EXPECT_EQ(outcome.exit_code, 1);
  EXPECT_NE(outcome.out.find("solvers/method.cpp:1:"), std::string::npos) << outcome.out;
}

TEST(CheckScript, FailsWhereThereIsNoSource) {
  const TemporaryFolder empty;
  const ProcessResult outcome = check_script(empty.path());
  EXPECT_EQ(outcome.exit_code, 1);
  EXPECT_NE(outcome.err.find("no sources"), std::string::npos) << outcome.err;
}

}  // namespace
}  // namespace odobench::testing
