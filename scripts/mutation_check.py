#!/usr/bin/env python3
"""Do the tests notice when the code is wrong? Changes one operator or constant at a time and runs the tests that should see it.

usage: scripts/mutation_check.py [-n MUTANTS] [-s SEED] [FILE...]     MUTANTS of each file (default: 6); FILE: of those below

Works on a copy of the checkout in build/mutation, so the checkout itself stays as it is. A mutant that does not compile is
replaced by another one; one that ends in a limit of time or memory counts as seen. Lists the survivors, also in
build/mutation/survivors.txt; exit code 1 when fewer than 85 % are seen. The first run builds for some minutes; then a mutant takes about 3 s.
"""
import argparse
import filecmp
import os
import random
import re
import resource
import shutil
import signal
import subprocess
import sys
import time

ROOT = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
FOLDER = os.path.join(ROOT, "build", "mutation")
WANTED = 0.85
TIME_LIMIT = 30  # s, of one test program; the slowest takes about one
MEMORY_LIMIT = 4 << 30  # bytes

# Which tests look at a file (kernels, statistics, parsers), those that find most first: the others then need not be built.
TESTS = {
    "base/files.cpp": ["test_files"],
    "base/text.cpp": ["test_text"],
    "base/json_node.cpp": ["test_json_node", "test_dataset_refusals", "test_dataset"],
    "datasets/csv/csv_dialect.cpp": ["test_csv_dialect"],
    "datasets/csv/csv_row.cpp": ["test_csv_dialect", "test_filter_files"],
    "datasets/csv/csv_stream.cpp": ["test_filter_files", "test_csv_dialect"],
    "datasets/native/recording_file.cpp": ["test_dataset", "test_dataset_refusals"],
    "datasets/native/validate.cpp": ["test_dataset_refusals", "test_dataset"],
    "datasets/import/vitko2024/vitko2024_csv.cpp": ["test_vitko2024_csv", "test_import_vitko2024"],
    "problems/calibration/direct_form.cpp": ["test_calibration"],
    "problems/calibration/kernel/kernel_impl.hpp": ["test_calibration"],
    "problems/calibration/structure.cpp": ["test_calibration"],
    "problems/entropy/profile_form.cpp": ["test_entropy_windows", "test_sliding_filter"],
    "reports/regression/baseline_check.cpp": ["test_baseline"],
    "reports/statistics/mann_whitney.cpp": ["test_mann_whitney"],
    "reports/statistics/statistics.cpp": ["test_reports", "test_changes", "test_report_tables"],
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
    (r"(?<![\w.\"'])(?<!= -)1(?![\w.'])", "2"),  # not of "= -1", which stands for "none" as well as -2 does
    (r"(?<![\w.\"'])2(?![\w.'])", "3"),
    (r"!(?=[a-z_(])", ""),
]
# Comments and declarations; memory set aside beforehand, whose size changes no result; whether a descriptor is one: 0, 1 and 2 are taken
# when the program starts, so "< 0", "<= 0" and "< 1" say the same.
SKIPPED = re.compile(r"^\s*(//|#|using |namespace|template|static_assert)|\breserve\(|(fd|descriptor_?) (<|>=) 0")


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


def run(words, output=subprocess.DEVNULL, limit=None):
    """The exit code; -1 when it took too long."""

    def limit_memory():
        if limit:
            resource.setrlimit(resource.RLIMIT_AS, (MEMORY_LIMIT, MEMORY_LIMIT))
            resource.setrlimit(resource.RLIMIT_CORE, (0, 0))

    process = subprocess.Popen(words, cwd=FOLDER, stdout=output, stderr=subprocess.STDOUT, start_new_session=True, preexec_fn=limit_memory)
    try:
        return process.wait(limit)
    except BaseException as reason:
        os.killpg(process.pid, signal.SIGKILL)
        process.wait()
        if isinstance(reason, subprocess.TimeoutExpired):
            return -1
        raise


class Copy:
    """A copy of the checkout's sources with a build of its own."""

    def __init__(self, tests):
        self.source = os.path.join(FOLDER, "source")
        self.build = os.path.join(FOLDER, "build")
        self.scratch = os.path.join(FOLDER, "scratch")
        os.makedirs(self.scratch, exist_ok=True)
        os.environ["TMPDIR"] = self.scratch  # what a mutant that crashes leaves behind
        os.environ["ODOBENCH_SHARED"] = os.path.abspath(os.environ.get("ODOBENCH_SHARED", os.path.join(ROOT, "..", "shared")))
        self.copy()
        launcher = ["-DCMAKE_CXX_COMPILER_LAUNCHER=ccache"] if shutil.which("ccache") else []
        configure = ["cmake", "-S", self.source, "-B", self.build, "-G", "Ninja", "-DCMAKE_BUILD_TYPE=Release", "-DCMAKE_CXX_FLAGS_RELEASE=-O1",
                     "-DODOBENCH_PROGRAM=OFF", "-DODOBENCH_BENCHMARKS=OFF", "-DODOBENCH_CHARTS=OFF", *launcher]
        with open(os.path.join(FOLDER, "build.log"), "w") as log:
            if run(configure, log) != 0 or run(["cmake", "--build", self.build, "--target", *tests], log) != 0:
                sys.exit("mutation_check: the checkout itself does not build: see " + log.name)
        for test in tests:
            if not self.passes(test):
                sys.exit("mutation_check: %s fails without any change" % test)

    def copy(self):
        """Only what differs is written, so that little is built again; the source of an interrupted run's mutant differs."""
        listed = subprocess.run(["git", "ls-files", "-co", "--exclude-standard"], cwd=ROOT, check=True, capture_output=True, text=True)
        names = {name for name in listed.stdout.split("\n") if os.path.isfile(os.path.join(ROOT, name))}
        for folder, _, files in os.walk(self.source):
            for file in files:
                if os.path.relpath(os.path.join(folder, file), self.source) not in names:
                    os.remove(os.path.join(folder, file))
        for name in names:
            path, target = os.path.join(ROOT, name), os.path.join(self.source, name)
            if not os.path.exists(target) or not filecmp.cmp(path, target, shallow=False):
                os.makedirs(os.path.dirname(target), exist_ok=True)
                shutil.copy(path, target)

    def compiles(self, test):
        return run(["cmake", "--build", self.build, "--target", test]) == 0

    def passes(self, test):
        passed = run([os.path.join(self.build, "tests", test), "--gtest_brief=1", "--gtest_fail_fast"], limit=TIME_LIMIT) == 0
        for left in os.listdir(self.scratch):
            shutil.rmtree(os.path.join(self.scratch, left), ignore_errors=True)
        return passed

    def verdict(self, tests):
        """The first test that fails, "" when none does, None when the mutant does not compile."""
        for test in tests:
            if not self.compiles(test):
                return None
            if not self.passes(test):
                return test
        return ""


def check(copy, name, count, seed):
    """Tries `count` mutants of one file: how many there were, who saw them, the survivors as lines of text."""
    path = os.path.join(copy.source, name)
    with open(path) as file:
        original = file.read()
    lines = original.split("\n")
    candidates = places(original)
    random.Random("%d %s" % (seed, name)).shuffle(candidates)
    seen_by, survivors = [], []
    for number, start, end, replacement in candidates:
        if len(seen_by) + len(survivors) == count:
            break
        mutant = lines[number][:start] + replacement + lines[number][end:]
        with open(path, "w") as file:
            file.write("\n".join(lines[:number] + [mutant] + lines[number + 1:]))
        test = copy.verdict(TESTS[name])
        if test == "":
            survivors.append("%s:%d: %s  ->  %s" % (name, number + 1, lines[number].strip(), mutant.strip()))
        elif test is not None:
            seen_by.append(test)
    with open(path, "w") as file:
        file.write(original)
    return len(seen_by) + len(survivors), seen_by, survivors


def main():
    parser = argparse.ArgumentParser(usage=__doc__.split("usage: ")[1].split("\n")[0], add_help=False)
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
        begin = time.time()
        tried, seen_by, survived = check(copy, name, options.n, options.s)
        seen += len(seen_by)
        total += tried
        survivors += survived
        print("%-42s %2d of %2d seen, %4.0f s: %s" % (name, len(seen_by), tried, time.time() - begin, ", ".join(
            "%s %d" % (test, seen_by.count(test)) for test in TESTS[name] if test in seen_by)), flush=True)
        for survivor in survived:
            print("  survived  " + survivor, flush=True)
    with open(os.path.join(FOLDER, "survivors.txt"), "w") as file:
        file.write("".join(survivor + "\n" for survivor in survivors))
    print("mutation_check: %d of %d seen (%.0f %%)" % (seen, total, 100.0 * seen / max(total, 1)))
    sys.exit(0 if seen >= WANTED * total else 1)


if __name__ == "__main__":
    main()
