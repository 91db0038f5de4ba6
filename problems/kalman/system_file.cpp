#include "problems/kalman/system_file.hpp"

#include <fmt/format.h>

#include <stdexcept>

#include "base/json_node.hpp"

namespace odobench {
namespace {

// States, inputs or noises: the exponential of three times as many rows takes a second.
constexpr std::size_t kMostRows = 200;

Matrix read_matrix(const JsonNode& node) {
  const std::vector<JsonNode> rows = node.elements();
  if (rows.empty()) node.fail("an empty array", "a matrix as an array of rows");
  if (rows.size() > kMostRows)
    node.fail(fmt::format("{} rows", rows.size()), fmt::format("at most {}", kMostRows));
  Matrix m;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const std::vector<double> row = rows[i].numbers();
    if (i == 0) m.resize(static_cast<Eigen::Index>(rows.size()), static_cast<Eigen::Index>(row.size()));
    if (row.size() > kMostRows)
      rows[i].fail(fmt::format("a row of {}", row.size()), fmt::format("at most {}", kMostRows));
    if (static_cast<Eigen::Index>(row.size()) != m.cols() || row.empty())
      rows[i].fail(fmt::format("a row of {}", row.size()),
                   i == 0 ? std::string("at least one number") : fmt::format("{} as in the first", m.cols()));
    for (Eigen::Index j = 0; j < m.cols(); ++j)
      m(static_cast<Eigen::Index>(i), j) = row[static_cast<std::size_t>(j)];
  }
  return m;
}

// "v_x [m/s]" -> name and unit.
SignalInfo signal(const std::string& text) {
  const auto open = text.find(" [");
  if (open == std::string::npos || text.back() != ']') return {text, ""};
  return {text.substr(0, open), text.substr(open + 2, text.size() - open - 3)};
}

std::vector<SignalInfo> read_names(const JsonNode& root, const std::string& key, const char* letter,
                                   Eigen::Index count) {
  std::vector<SignalInfo> names;
  if (root.has(key)) {
    for (const JsonNode& name : root.at(key).elements()) names.push_back(signal(name.text()));
    if (names.size() != static_cast<std::size_t>(count))
      root.at(key).fail(fmt::format("{} names", names.size()), fmt::format("{} as the matrices say", count));
  } else {
    for (Eigen::Index i = 1; i <= count; ++i) names.push_back({fmt::format("{}{}", letter, i), ""});
  }
  return names;
}

}  // namespace

SystemFile read_system(const std::filesystem::path& file) {
  const JsonNode root = JsonNode::read(file);
  root.allow_only({"name", "description", "states", "inputs", "noises", "A", "B", "G", "Qc"});
  SystemFile result;
  LinearSystem& s = result.system;
  s.name = root.has("name") ? root.at("name").text() : file.stem().string();
  result.description = root.text_or_empty("description");
  s.a = read_matrix(root.at("A"));
  s.b = root.has("B") ? read_matrix(root.at("B")) : Matrix(s.a.rows(), 0);
  if (root.has("G") != root.has("Qc"))
    root.fail(root.has("G") ? "G without Qc" : "Qc without G", "both or neither");
  s.g = root.has("G") ? read_matrix(root.at("G")) : Matrix(s.a.rows(), 0);
  s.qc = root.has("Qc") ? read_matrix(root.at("Qc")) : Matrix(0, 0);
  s.states = read_names(root, "states", "x", s.a.rows());
  s.inputs = read_names(root, "inputs", "u", s.b.cols());
  s.noises = read_names(root, "noises", "w", s.g.cols());
  try {
    validate(s);
  } catch (const std::invalid_argument& error) {
    throw DataError(fmt::format("{}: {}", file.string(), error.what()));
  }
  return result;
}

}  // namespace odobench
