// Every LaTeX table that the program makes, put into a document and compiled. Skipped without a LaTeX that
// has siunitx 3.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <regex>

#include "tests/support/run_process.hpp"
#include "tests/support/shared_data.hpp"
#include "tests/support/source_dir.hpp"

namespace odobench {
namespace {

using ::testing::HasSubstr;
using testing::Process;
using testing::ProcessResult;
using testing::run_bench;
using testing::TemporaryFolder;

std::string document(const std::string& body) {
  return "\\documentclass[a4paper]{article}\n\\usepackage[T1]{fontenc}\n\\usepackage{array, booktabs, "
         "graphicx}\n"
         "\\usepackage{siunitx}\n\\maxdeadcycles=1000\n\\begin{document}\n" +
         body + "\\clearpage\n\\end{document}\n";
}

// "" when it compiles, else the end of the log.
class Latex {
 public:
  Latex() {
    for (const char* name : {"pdflatex", "lualatex"})
      for (const char* folder : {"/usr/bin/", "/usr/local/bin/", "/Library/TeX/texbin/"})
        if (program_.empty() && std::filesystem::exists(std::string(folder) + name))
          program_ = std::string(folder) + name;
  }
  bool works() const { return !program_.empty() && compile("\\unit{\\metre}\n").empty(); }
  std::string compile(const std::string& body) const {
    const std::string file = folder_.file("document.tex", document(body));
    const ProcessResult run = Process({program_, "-interaction=nonstopmode", "-halt-on-error",
                                       "-output-directory", folder_.path().string(), file})
                                  .wait(300);
    log_ = testing::content(folder_ / "document.log");
    if (run.exit_code == 0) return "";
    const auto error = log_.find("\n!");
    return error == std::string::npos ? "no error in the log" : log_.substr(error, 2000);
  }
  const std::string& log() const { return log_; }

 private:
  std::string program_;
  TemporaryFolder folder_;
  mutable std::string log_;
};

class CliLatex : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!latex_.works()) GTEST_SKIP() << "no pdflatex or lualatex with siunitx 3 on this machine";
  }
  std::string tables(std::vector<std::string> arguments) {
    arguments.push_back("--format=latex");
    const ProcessResult run = run_bench(arguments, 300);
    EXPECT_LE(run.exit_code, 1) << arguments.front() << ": " << run.err;
    EXPECT_THAT(run.out, HasSubstr("\\end{table}")) << arguments.front();
    return run.out + "\\clearpage\n";  // LaTeX gives up with some fifty floats that wait for their page
  }
  void expect_to_compile(const std::string& body) {
    EXPECT_EQ(latex_.compile(body), "");
    EXPECT_FALSE(std::regex_search(latex_.log(), std::regex("Overfull.*pt too wide|Float too large")))
        << "wider or higher than the page";
  }
  Latex latex_;
  TemporaryFolder folder_;
};

std::string source(const std::string& path) {
  return (source_dir() / path).string();
}

TEST_F(CliLatex, TablesOfRunsCompile) {
  const std::string a = (folder_ / "a").string(), b = (folder_ / "b").string();
  std::string body = tables(
      {"--solver=lm,pso[variant=thesis],ga", "--repeat=3", "--max-evals=300", "--quiet", "--out=" + a});
  body += tables({"--solver=lm,pso[variant=thesis],cmaes", "--repeat=3", "--max-evals=200", "--polish=lm",
                  "--quiet", "--out=" + b});
  body += tables({"compare", a, b, "--metrics=all", "--fail-on=J:+1%"});
  ASSERT_EQ(run_bench({"check", a, "--baseline=" + (folder_ / "c.json").string(), "--update"}).exit_code, 0);
  body += tables({"check", b, "--baseline=" + (folder_ / "c.json").string()});
  body += tables({"evaluate", "--parameters=nominal,truth"}) + tables({"evaluate"});
  expect_to_compile(body);
}

TEST_F(CliLatex, ListsCompile) {
  std::string body;
  for (const char* what : {"solvers", "problems", "data", "scenarios"}) body += tables({"list", what});
  body += tables({"list", "scenarios", "vitko2024"}) + tables({"list", "scenarios", "exp1_steered"});
  body += tables({"list", "data", source("datasets/demo/set.json")});
  EXPECT_EQ(latex_.compile(body), "");  // the path of the checkout may be too long for a line
}

TEST_F(CliLatex, TablesOfFiltersAndSimulationsCompile) {
  const std::string sensors = "--sensors=" + source("datasets/sensors/heading_only.json");
  std::string body = tables({"fuse", sensors}) + tables({"tune", sensors, "--max-evals=5"});
  body += tables({"plan", "--robot=vitko2024"});
  body += tables({"verify", "--scenario=vitko2024", "--parameters=nominal,truth", "--repeat=2"});
  expect_to_compile(body);
}

TEST_F(CliLatex, TablesOfWindowsCompile) {
  const auto shared = testing::shared_folder() / "reference";
  if (!std::filesystem::exists(shared)) GTEST_SKIP() << "no shared/reference";
  std::string body =
      tables({"windows", (shared / "entropy_windows.json").string(), "--only=csharp", "--quiet"});
  body += tables({"filter", "--data=" + (shared / "entropy_series_csharp.csv").string(),
                  "--truth=" + (shared / "entropy_series_csharp_truth.csv").string(), "--gap",
                  "--as-published", "--quiet"});
  expect_to_compile(body);
}

}  // namespace
}  // namespace odobench
