#include <fmt/format.h>

#include <charconv>
#include <stdexcept>
#include <string_view>

#include "problems/classic/nist.hpp"

// The assembler puts the file between two symbols of this object file.
asm(".pushsection .rodata\n"
    ".global odobench_nist_strd_begin\n.global odobench_nist_strd_end\n"
    "odobench_nist_strd_begin:\n.incbin \"" ODOBENCH_NIST_STRD
    "\"\n"
    "odobench_nist_strd_end:\n.byte 0\n.popsection\n");
extern "C" const char odobench_nist_strd_begin[];
extern "C" const char odobench_nist_strd_end[];

namespace odobench {
namespace {

[[noreturn]] void refuse(int line, const std::string& what) {
  throw std::logic_error(
      fmt::format("nist_strd.txt:{}: {}", line, what));  // part of the program, not of its input
}

std::vector<std::string_view> words(std::string_view line) {
  std::vector<std::string_view> list;
  for (std::size_t from = 0; (from = line.find_first_not_of(' ', from)) != std::string_view::npos;) {
    const std::size_t to = std::min(line.find(' ', from), line.size());
    list.push_back(line.substr(from, to - from));
    from = to;
  }
  return list;
}

Vector numbers(const std::vector<std::string_view>& list, std::size_t first, int line) {
  Vector v(static_cast<Eigen::Index>(list.size() - first));
  for (std::size_t i = first; i < list.size(); ++i) {
    const std::string_view word = list[i];
    const auto [end, error] =
        std::from_chars(word.data(), word.data() + word.size(), v[static_cast<Eigen::Index>(i - first)]);
    if (error != std::errc() || end != word.data() + word.size())
      refuse(line, fmt::format("found '{}', expected a number", word));
  }
  return v;
}

class Reader {
 public:
  std::vector<NistData> read(std::string_view text) {
    while (!text.empty()) {
      const std::size_t end = std::min(text.find('\n'), text.size());
      ++line_;
      take(text.substr(0, end));
      text.remove_prefix(std::min(end + 1, text.size()));
    }
    finish();
    return std::move(list_);
  }

 private:
  void take(std::string_view line) {
    const std::vector<std::string_view> w = words(line);
    if (w.empty() || w[0][0] == '#') return;
    if (w[0] == "problem" && w.size() == 2) {
      finish();
      list_.push_back({std::string(w[1]), {}, {}, {}, {}, 0, {}});
      return;
    }
    if (list_.empty()) refuse(line_, "expected 'problem NAME' first");
    NistData& data = list_.back();
    if (w[0] == "model")
      data.model = line.substr(line.find(' ') + 1);
    else if (w[0] == "start_1" || w[0] == "start_2")
      data.starts.push_back(numbers(w, 1, line_));
    else if (w[0] == "certified")
      data.certified = numbers(w, 1, line_);
    else if (w[0] == "certified_rss" && w.size() == 2)
      data.certified_rss = numbers(w, 1, line_)[0];
    else if (w[0] == "columns")
      data.columns.assign(w.begin() + 1, w.end());
    else if (w.size() == data.columns.size())
      rows_.push_back(numbers(w, 0, line_));
    else
      refuse(line_, fmt::format("found {} values, expected {}", w.size(), data.columns.size()));
  }

  void finish() {
    if (list_.empty()) return;
    NistData& data = list_.back();
    const bool complete = data.starts.size() == 2 && data.certified.size() > 0 && !rows_.empty() &&
                          data.starts[0].size() == data.certified.size() &&
                          data.starts[1].size() == data.certified.size();
    if (!complete) refuse(line_, fmt::format("problem '{}' is not complete", data.name));
    data.observations.resize(static_cast<Eigen::Index>(rows_.size()),
                             static_cast<Eigen::Index>(data.columns.size()));
    for (std::size_t i = 0; i < rows_.size(); ++i)
      data.observations.row(static_cast<Eigen::Index>(i)) = rows_[i].transpose();
    rows_.clear();
  }

  std::vector<NistData> list_;
  std::vector<Vector> rows_;
  int line_ = 0;
};

}  // namespace

const std::vector<NistData>& nist_data() {
  static const std::vector<NistData> list =
      Reader().read({odobench_nist_strd_begin,
                     static_cast<std::size_t>(odobench_nist_strd_end - odobench_nist_strd_begin)});
  return list;
}

}  // namespace odobench
