#include "reports/page/html_figure.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

#include "reports/page/html_text.hpp"

namespace odobench {
namespace {

using nlohmann::json;

constexpr int kDefaultHeight = 200;  // Vega-Lite's of a view
constexpr int kAxisRoom = 45;
constexpr int kLegendRoom = 30;

int sum_or_max(const json& views, int columns) {
  int total = 0, row = 0, k = 0;
  for (const json& view : views) {
    row = std::max(row, estimated_height(view));
    if (++k % columns == 0 || k == static_cast<int>(views.size())) {
      total += row;
      row = 0;
    }
  }
  return total;
}

bool has_legend(const json& spec) {
  const auto encoding = spec.find("encoding");
  return encoding != spec.end() && encoding->is_object() &&
         (encoding->contains("color") || encoding->contains("strokeDash") || encoding->contains("shape"));
}

void require_data(const json& node, const std::string& id,
                  const std::map<std::string, std::string>& datasets) {
  if (node.is_object() && node.contains("data") && node["data"].is_object() &&
      node["data"].contains("name")) {
    const std::string name = node["data"]["name"].get<std::string>();
    if (!datasets.contains(name))
      throw std::invalid_argument(fmt::format("figure {}: no data set '{}' in the document", id, name));
  }
  if (node.is_structured())
    for (const json& child : node) require_data(child, id, datasets);
}

}  // namespace

int estimated_height(const json& spec) {
  if (!spec.is_object()) return kDefaultHeight;
  if (spec.contains("vconcat")) return sum_or_max(spec["vconcat"], 1);
  if (spec.contains("hconcat")) return sum_or_max(spec["hconcat"], 1 << 20);
  if (spec.contains("concat")) {
    const json columns = spec.value("columns", json(1));
    return sum_or_max(spec["concat"], columns.is_number_integer() ? std::max(1, columns.get<int>()) : 1);
  }
  if (spec.contains("spec")) return estimated_height(spec["spec"]) + kLegendRoom;
  const auto height = spec.find("height");
  const int own = height != spec.end() && height->is_number() ? height->get<int>() : kDefaultHeight;
  return own + kAxisRoom + (has_legend(spec) ? kLegendRoom : 0);
}

std::string render_html_figure(const Figure& figure, int number) {
  const std::string id = html_escape(figure.id);
  std::string out = fmt::format("<figure id=\"figure-{}\" data-figure=\"{}\">\n", id, id);
  out +=
      fmt::format("<div class=\"figure-head\"><h3><span class=\"number\">Figure {}.</span> {}</h3></div>\n",
                  number, html_escape(figure.title));
  out +=
      fmt::format("<div class=\"chart\" style=\"min-height:{}px\"></div>\n", estimated_height(figure.spec));
  return out + fmt::format("<figcaption>{}</figcaption>\n</figure>\n", html_escape(figure.caption));
}

std::string render_html_specification(const Figure& figure,
                                      const std::map<std::string, std::string>& datasets) {
  require_data(figure.spec, figure.id, datasets);
  return fmt::format("<script type=\"application/json\" data-figure=\"{}\">{}</script>\n",
                     html_escape(figure.id), html_json(figure.spec));
}

std::string render_html_dataset(const std::string& name, const std::string& text) {
  return fmt::format("<script type=\"application/json\" data-dataset=\"{}\">{}</script>\n", html_escape(name),
                     html_json(text));
}

}  // namespace odobench
