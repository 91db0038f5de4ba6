#include <cmath>
#include <cstdint>
#include <nlohmann/json.hpp>

#include "base/json_node.hpp"
#include "base/text.hpp"
#include "reports/render/table.hpp"

namespace odobench {
namespace {

using Json = nlohmann::ordered_json;

Json number(const std::optional<double>& value) {
  return Json(finite_or_null(value));
}

// Counts are integers for machines, too.
Json value_json(const Cell& cell) {
  const double value = *cell.value;
  const bool count = cell.notation == Notation::Fixed && cell.precision == 0;
  if (count && std::abs(value) < 0x1p53 && value == std::trunc(value))
    return static_cast<std::int64_t>(value);
  return number(value);
}

Json cell_json(const Cell& cell, const Column& column) {
  if (cell.empty()) return nullptr;
  const Json content = cell.value ? value_json(cell) : Json(cell.text);
  if (!cell.difference && cell.mark.empty()) return content;
  Json out{{"value", content}};
  if (cell.difference) out["difference"] = number(cell.difference);
  if (!cell.mark.empty()) out[column.mark_name] = cell.mark;
  return out;
}

Json table_json(const Table& table) {
  Json columns = Json::array(), rows = Json::array();
  for (const Column& column : table.columns)
    columns.push_back(Json{{"id", column.id}, {"name", column.name}, {"unit", column.unit}});
  for (const auto& row : table.rows) {
    Json out = Json::object();
    for (std::size_t c = 0; c < row.size(); ++c)
      out[table.columns[c].id] = cell_json(row[c], table.columns[c]);
    rows.push_back(std::move(out));
  }
  return Json{
      {"id", table.id}, {"title", table.title}, {"columns", columns}, {"rows", rows}, {"notes", table.notes}};
}

}  // namespace

std::string render_json(const std::vector<Table>& tables) {
  Json list = Json::array();
  for (const Table& table : tables) list.push_back(table_json(table));
  const Json document{{"schema_version", 1}, {"tables", std::move(list)}};
  return safe_json(document.dump(1, ' ', false, Json::error_handler_t::replace)) + "\n";
}

}  // namespace odobench
