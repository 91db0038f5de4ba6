#include "bench/studies/simulation/discretisation_study.hpp"

#include <fmt/format.h>

#include <iterator>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "base/error.hpp"
#include "problems/kalman/linear_system.hpp"
#include "problems/kalman/system_file.hpp"

namespace odobench {
namespace {

using OrderedJson = nlohmann::ordered_json;

constexpr int kMatrixDigits = 8;

// One matrix of the output with its names.
struct Shown {
  std::string id, title, latex;
  const Matrix* matrix;
  const std::vector<SignalInfo>* columns;
};

std::vector<Shown> matrices_of(const LinearSystem& s, const Discretisation& d) {
  std::vector<Shown> list{{"F", "F, state transition", "F", &d.f, &s.states}};
  if (d.psi.cols() > 0) list.push_back({"Psi", "Psi, constant inputs to states", "\\Psi", &d.psi, &s.inputs});
  if (d.gamma.cols() > 0) {
    list.push_back({"Gamma", "Gamma, constant noise to states", "\\Gamma", &d.gamma, &s.noises});
    list.push_back({"Q", "Q, covariance of the noise of a step", "Q", &d.q, &s.states});
  }
  return list;
}

Table matrix_table(const LinearSystem& s, const Shown& m, const std::string& suffix) {
  Table table;
  table.id = m.id;
  table.title = m.title + suffix;
  Column key;
  key.id = key.name = "state";
  key.align = Align::Left;
  table.columns.push_back(key);
  for (const SignalInfo& c : *m.columns) {
    Column column;
    column.id = column.name = c.name;
    table.columns.push_back(column);
  }
  for (Eigen::Index i = 0; i < m.matrix->rows(); ++i) {
    const SignalInfo& state = s.states[static_cast<std::size_t>(i)];
    table.rows.push_back(
        {text_cell(state.unit.empty() ? state.name : fmt::format("{} [{}]", state.name, state.unit))});
    for (Eigen::Index j = 0; j < m.matrix->cols(); ++j)
      table.rows.back().push_back(significant_cell((*m.matrix)(i, j), kMatrixDigits));
  }
  return table;
}

Table error_table(const SeriesDiscretisation& s, int order) {
  Table table;
  table.id = "series_error";
  table.title = fmt::format("Error of the series of order {}", order);
  for (const char* name : {"matrix", "largest error", "bound (1-norm)"}) {
    Column column;
    column.id = column.name = name;
    if (table.columns.empty()) column.align = Align::Left;
    table.columns.push_back(column);
  }
  const auto row = [&](const char* name, double error, std::optional<double> bound) {
    table.rows.push_back(
        {text_cell(name), significant_cell(error, 3), bound ? significant_cell(*bound, 3) : Cell{}});
  };
  row("F", s.f_error, s.f_bound);
  row("Psi", s.psi_error, std::nullopt);
  row("Gamma", s.gamma_error, std::nullopt);
  row("Q", s.q_error, std::nullopt);
  table.notes.push_back(fmt::format(
      "Largest error: biggest entry of the difference to the exact matrix. The integral of F, which "
      "Psi and Gamma are made of, has the bound {:.3g}.",
      s.integral_bound));
  return table;
}

OrderedJson rows_of(const Matrix& m) {
  OrderedJson rows = OrderedJson::array();
  for (Eigen::Index i = 0; i < m.rows(); ++i) {
    OrderedJson row = OrderedJson::array();
    for (Eigen::Index j = 0; j < m.cols(); ++j) row.push_back(m(i, j));
    rows.push_back(row);
  }
  return rows;
}

std::string json_text(const SystemFile& file, const DiscretisationStudy& study, const Discretisation& d,
                      const SeriesDiscretisation* series, const std::vector<Table>& tables) {
  OrderedJson names = OrderedJson::array();
  for (const SignalInfo& s : file.system.states) names.push_back(s.name);
  OrderedJson root{
      {"schema_version", 1}, {"system", file.system.name}, {"period", study.period}, {"states", names}};
  root["order"] = study.order ? OrderedJson(*study.order) : OrderedJson(nullptr);
  for (const Shown& m : matrices_of(file.system, d)) root[m.id] = rows_of(*m.matrix);
  if (series != nullptr)
    root["series_error"] = {{"F", series->f_error},         {"Psi", series->psi_error},
                            {"Gamma", series->gamma_error}, {"Q", series->q_error},
                            {"F_bound", series->f_bound},   {"integral_bound", series->integral_bound}};
  // The same as tables, as every verb has them.
  root["tables"] = OrderedJson::parse(render(tables, Format::Json)).at("tables");
  return root.dump(2) + "\n";
}

std::string latex_number(double value) {
  std::string text = fmt::format("{:.{}g}", value, kMatrixDigits);
  const auto e = text.find('e');
  if (e == std::string::npos) return text;
  return fmt::format("{} \\cdot 10^{{{}}}", text.substr(0, e), std::stoi(text.substr(e + 1)));
}

std::string latex_text(const SystemFile& file, const DiscretisationStudy& study, const Discretisation& d,
                       const SeriesDiscretisation* series) {
  std::string text = fmt::format(
      "% {}, period {}{}; needs amsmath\n", file.system.name, study.period,
      series != nullptr ? fmt::format(", series of order {}", *study.order) : std::string(", exact"));
  const auto out = std::back_inserter(text);
  for (const Shown& m : matrices_of(file.system, d)) {
    fmt::format_to(out, "\\[\n  {} = \\begin{{bmatrix}}\n", m.latex);
    for (Eigen::Index i = 0; i < m.matrix->rows(); ++i) {
      text += "    ";
      for (Eigen::Index j = 0; j < m.matrix->cols(); ++j)
        text += (j > 0 ? " & " : "") + latex_number((*m.matrix)(i, j));
      text += i + 1 < m.matrix->rows() ? " \\\\\n" : "\n";
    }
    text += "  \\end{bmatrix}\n\\]\n";
  }
  return text;
}

}  // namespace

DiscreteSystem discretise_system(const DiscretisationStudy& study) {
  const SystemFile file = read_system(study.system);
  std::optional<SeriesDiscretisation> series;
  Discretisation d;
  try {
    if (study.order) series = discretise_series(file.system, study.period, *study.order);
    d = series ? series->value : discretise(file.system, study.period);
  } catch (const std::invalid_argument& e) {
    // The system is checked, the period a positive number: the result overflows.
    throw DataError(fmt::format("{}: {}", study.system.string(), e.what()));
  }
  const SeriesDiscretisation* errors = series ? &*series : nullptr;
  const std::string suffix =
      fmt::format(" ({}, T = {} s, {})", file.system.name, study.period,
                  study.order ? fmt::format("series of order {}", *study.order) : std::string("exact"));
  DiscreteSystem result;
  for (const Shown& m : matrices_of(file.system, d))
    result.tables.push_back(matrix_table(file.system, m, suffix));
  if (errors != nullptr) result.tables.push_back(error_table(*errors, *study.order));
  result.json = json_text(file, study, d, errors, result.tables);
  result.latex = latex_text(file, study, d, errors);
  return result;
}

}  // namespace odobench
