#!/usr/bin/env python3
"""Do the tests notice when the code is wrong? Changes one operator or constant at a time and runs the tests that should see it.

usage: scripts/mutation_check.py [-n MUTANTS] [-s SEED] [FILE...]     MUTANTS of each file (default: 6); FILE: of those below

Works on a copy of the checkout in build/mutation, so the checkout itself stays as it is. A mutant that does not compile is
replaced by another one; one that ends in a limit of time counts as seen. Lists the survivors; exit code 1 when fewer than 85 % are seen.
Takes about 20 s a mutant on two cores.
"""
import argparse
import os
import random
import re
import shutil
import signal
import subprocess
import sys

ROOT = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
WANTED = 0.85
TIME_LIMIT = 180  # s, of one test program

# Which tests look at a file: kernels, statistics, parsers.
TESTS = {
    "base/files.cpp": ["test_files"],
    "base/text.cpp": ["test_text"],
    "base/json_node.cpp": ["test_dataset", "test_dataset_refusals"],
    "datasets/csv/csv_dialect.cpp": ["test_csv_dialect"],
    "datasets/csv/csv_row.cpp": ["test_csv_dialect", "test_filter_files"],
    "datasets/csv/csv_stream.cpp": ["test_filter_files", "test_csv_dialect"],
    "datasets/native/recording_file.cpp": ["test_dataset", "test_dataset_refusals"],
    "datasets/native/validate.cpp": ["test_dataset_refusals", "test_dataset"],
    "datasets/import/vitko2024/vitko2024_csv.cpp": ["test_import_vitko2024"],
    "problems/calibration/direct_form.cpp": ["test_calibration"],
    "problems/calibration/kernel_impl.hpp": ["test_calibration"],
    "problems/calibration/structure.cpp": ["test_calibration"],
    "problems/entropy/profile_form.cpp": ["test_entropy_windows", "test_sliding_filter"],
    "reports/regression/baseline_check.cpp": ["test_baseline"],
    "reports/statistics/mann_whitney.cpp": ["test_rank_test"],
    "reports/statistics/statistics.cpp": ["test_reports", "test_run_comparison", "test_report_tables"],
    "solvers/lattice/ternary_kernel_impl.hpp": ["test_entropy_windows", "test_sliding_filter"],
}

SWAPS = [
    (r"(?<=[\w\)\]]) \+ (?=[\w\(])", " - "),
    (r"(?<=[\w\)\]]) - (?=[\w\(])", " + "),
    (r"(?<=[\w\)\]]) \* (?=[\w\(])", " / "),
    (r"(?<=[\w\)\]]) / (?=[\w\(])", " * "),
    (r" \+= ", " -= "),
    (r" -= ", " += "),
    (r" < ", " <= "),
    (r" <= ", " < "),
    (r" > ", " >= "),
    (r" >= ", " > "),
    (r" == ", " != "),
    (r" != ", " == "),
    (r" && ", " || "),
    (r" \|\| ", " && "),
    (r"\btrue\b", "false"),
    (r"\bfalse\b", "true"),
    (r"std::min\b", "std::max"),
    (r"std::max\b", "std::min"),
    (r"\bsin\b", "cos"),
    (r"\bcos\b", "sin"),
    (r"(?<![\w.\"'\[])0(?![\w.x'])", "1"),
    (r"(?<![\w.\"'])1(?![\w.'])", "2"),
    (r"(?<![\w.\"'])2(?![\w.'])", "3"),
    (r"!(?=[a-z_(])", ""),
]
SKIPPED = re.compile(r"^\s*(//|#|using |namespace|template|static_assert|assert)|fmt::format\(\"|operator|for_each_value")


def places(text):
    """All (line index, start, end, replacement) that may be changed."""
    found = []
    for number, line in enumerate(text.split("\n")):
        if SKIPPED.search(line):
            continue
        code = line.split("//")[0]
        strings = [m.span() for m in re.finditer(r'"(\\.|[^"\\])*"', code)]
        for pattern, replacement in SWAPS:
            for match in re.finditer(pattern, code):
                if not any(a <= match.start() < b for a, b in strings):
                    found.append((number, match.start(), match.end(), replacement))
    return found


def run(words, folder, limit=None):
    process = subprocess.Popen(words, cwd=folder, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, start_new_session=True)
    try:
        return process.wait(limit)
    except subprocess.TimeoutExpired:
        os.killpg(process.pid, signal.SIGKILL)
        process.wait()
        return -1


class Copy:
    """A copy of the checkout's sources with a build of its own."""

    def __init__(self, tests):
        self.folder = os.path.join(ROOT, "build", "mutation", "source")
        self.build = os.path.join(ROOT, "build", "mutation", "build")
        files = subprocess.run(["git", "ls-files", "-co", "--exclude-standard"], cwd=ROOT, check=True, capture_output=True, text=True)
        shutil.rmtree(self.folder, ignore_errors=True)
        for name in files.stdout.split("\n"):
            if name and os.path.exists(os.path.join(ROOT, name)):
                os.makedirs(os.path.dirname(os.path.join(self.folder, name)), exist_ok=True)
                shutil.copy2(os.path.join(ROOT, name), os.path.join(self.folder, name))
        launcher = ["-DCMAKE_CXX_COMPILER_LAUNCHER=ccache"] if shutil.which("ccache") else []
        subprocess.run(["cmake", "-S", self.folder, "-B", self.build, "-G", "Ninja", "-DCMAKE_BUILD_TYPE=Release", "-DCMAKE_CXX_FLAGS_RELEASE=-O1",
                        "-DODOBENCH_PROGRAM=OFF", "-DODOBENCH_BENCHMARKS=OFF", "-DODOBENCH_CHARTS=OFF", *launcher],
                       check=True, stdout=subprocess.DEVNULL)
        if not self.compiles(tests):
            sys.exit("mutation_check: the checkout itself does not build: see " + self.build)
        for test in tests:
            if not self.passes(test):
                sys.exit("mutation_check: %s fails without any change" % test)

    def compiles(self, tests):
        return run(["cmake", "--build", self.build, "--target", *tests], self.folder) == 0

    def passes(self, test):
        shared = os.environ.get("ODOBENCH_SHARED", os.path.join(ROOT, "..", "shared"))
        os.environ["ODOBENCH_SHARED"] = os.path.abspath(shared)
        return run([os.path.join(self.build, "tests", test), "--gtest_brief=1"], self.folder, TIME_LIMIT) == 0


def main():
    parser = argparse.ArgumentParser(usage=__doc__.split("\n\n", 1)[1], add_help=False)
    parser.add_argument("-n", type=int, default=6)
    parser.add_argument("-s", type=int, default=1)
    parser.add_argument("files", nargs="*", default=sorted(TESTS))
    options = parser.parse_args()
    unknown = [name for name in options.files if name not in TESTS]
    if unknown:
        sys.exit("mutation_check: no tests are listed for %s" % unknown[0])
    copy = Copy(sorted({test for name in options.files for test in TESTS[name]}))
    seen = total = 0
    survivors = []
    for name in options.files:
        path = os.path.join(copy.folder, name)
        with open(path) as file:
            original = file.read()
        candidates = places(original)
        random.Random("%d %s" % (options.s, name)).shuffle(candidates)
        wanted, here = options.n, 0
        for number, start, end, replacement in candidates:
            if wanted == 0:
                break
            lines = original.split("\n")
            before = lines[number]
            lines[number] = before[:start] + replacement + before[end:]
            with open(path, "w") as file:
                file.write("\n".join(lines))
            if not copy.compiles(TESTS[name]):
                continue
            wanted -= 1
            total += 1
            if all(copy.passes(test) for test in TESTS[name]):
                survivors.append("%s:%d: %s  ->  %s" % (name, number + 1, before.strip(), lines[number].strip()))
            else:
                seen += 1
                here += 1
        with open(path, "w") as file:
            file.write(original)
        print("%-42s %d of %d seen" % (name, here, options.n - wanted), flush=True)
    for survivor in survivors:
        print("survived  " + survivor)
    print("mutation_check: %d of %d seen (%.0f %%)" % (seen, total, 100.0 * seen / max(total, 1)))
    sys.exit(0 if seen >= WANTED * total else 1)


if __name__ == "__main__":
    main()
