#include "bench/studies/figure_files.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstring>
#include <stdexcept>
#include <string>
#include <vector>

#include "base/files.hpp"
#include "reports/page/web_assets.hpp"

extern char** environ;  // NOLINT: POSIX has no header for it

namespace odobench {
namespace {

namespace fs = std::filesystem;

// A folder that nobody else can read, gone at the end.
class PrivateFolder {
 public:
  PrivateFolder() {
    std::string name = (fs::temp_directory_path() / "odobench_figures_XXXXXX").string();
    if (mkdtemp(name.data()) == nullptr)
      throw std::runtime_error(fmt::format("cannot make a folder {}: {}", name, std::strerror(errno)));
    path_ = name;
  }
  ~PrivateFolder() {
    std::error_code ignored;
    fs::remove_all(path_, ignored);
  }
  PrivateFolder(const PrivateFolder&) = delete;
  PrivateFolder& operator=(const PrivateFolder&) = delete;

  std::string write(std::string_view name, std::string_view text) const {
    const fs::path file = path_ / name;
    write_file(file, text);
    return file.string();
  }
  std::string operator/(std::string_view name) const { return (path_ / name).string(); }

 private:
  fs::path path_;
};

// Runs words[0], found in PATH, without a shell and with nothing to read; what it writes goes to `log`. Its
// exit code, 127 when there is no such program, 128 + signal when one ended it. Ended early when `stop` is
// asked for: Interruption.
int run(std::vector<std::string> words, const std::string& log, const Stop& stop) {
  std::vector<char*> arguments;
  for (std::string& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
  posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, log.c_str(), O_WRONLY | O_CREAT | O_APPEND, 0600);
  posix_spawn_file_actions_adddup2(&actions, STDOUT_FILENO, STDERR_FILENO);
  pid_t child = -1;
  const int failure = posix_spawnp(&child, arguments[0], &actions, nullptr, arguments.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  if (failure == ENOENT) return 127;
  if (failure != 0)
    throw std::runtime_error(fmt::format("cannot start {}: {}", words[0], std::strerror(failure)));
  int status = 0;
  for (pid_t ended = 0; ended == 0;) {
    ended = waitpid(child, &status, WNOHANG);
    if (ended < 0 && errno != EINTR)
      throw std::runtime_error(fmt::format("lost {}: {}", words[0], std::strerror(errno)));
    if (ended > 0) break;
    ended = 0;
    if (stop.requested()) ::kill(child, SIGKILL);  // it writes into our private folder only
    ::poll(nullptr, 0, 20);
  }
  stop.check();
  return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

std::string specifications(const Document& document) {
  nlohmann::json list = nlohmann::json::array();
  for (const Figure* figure : figures(document))
    list.push_back({{"id", figure->id}, {"spec", standalone(*figure, document.datasets)}});
  return list.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

}  // namespace

std::vector<fs::path> write_figures(const Document& document, const fs::path& folder, Existing existing,
                                    Watcher& watcher, const Stop& stop) {
  if (figures(document).empty()) return {};
  if (!has_chart_library())
    throw std::runtime_error(
        fmt::format("figures need the chart library, which this program was built without, since {}; install "
                    "npm, configure "
                    "and build again",
                    why_no_charts()));
  watcher.results_begin();
  const PrivateFolder work;
  for (int k = 0; k < kChartLibraryFiles; ++k) work.write(chart_library(k).name, chart_library(k).text);
  work.write("theme.js", web_file("theme.js"));
  const std::string script = work.write("render_svg.js", web_file("render_svg.js"));
  const std::string list = work.write("figures.json", specifications(document));
  const std::string log = work / "log";
  const fs::path drawn = work / "drawn";
  fs::create_directory(drawn);
  const int code = run({"node", script, drawn.string(), list}, log, stop);
  if (code == 127) throw std::runtime_error("figures as SVG files need node: install nodejs (18 or newer)");
  if (code != 0) {
    const std::string said = read_file(log);
    throw std::runtime_error(said.empty() ? fmt::format("node ended with exit code {}", code)
                                          : said.substr(0, said.find('\n')));
  }
  FileTransaction transaction(existing);
  std::vector<fs::path> files;
  for (const Figure* figure : figures(document)) {
    const std::string name = figure->id + ".svg";
    files.push_back(folder / name);
    transaction.add(files.back(), read_file(drawn / name));
  }
  transaction.commit();
  return files;
}

}  // namespace odobench
