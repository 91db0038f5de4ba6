#include "reports/figures/document.hpp"

#include <fmt/format.h>

#include <functional>
#include <stdexcept>

namespace odobench {

std::vector<const Figure*> figures(const Document& document) {
  std::vector<const Figure*> list;
  for (const Section& section : document.sections)
    for (const Block& block : section.blocks)
      if (const auto* figure = std::get_if<Figure>(&block)) list.push_back(figure);
  return list;
}

nlohmann::json standalone(const Figure& figure, const std::map<std::string, std::string>& datasets) {
  nlohmann::json spec = figure.spec;
  const std::function<void(nlohmann::json&)> fill = [&](nlohmann::json& node) {
    if (node.is_object() && node.contains("data") && node["data"].is_object() &&
        node["data"].contains("name")) {
      nlohmann::json& data = node["data"];
      const std::string name = data["name"].get<std::string>();
      const auto found = datasets.find(name);
      if (found == datasets.end())
        throw std::invalid_argument(
            fmt::format("figure {}: no data set '{}' in the document", figure.id, name));
      data.erase("name");
      data["values"] = found->second;
    }
    if (node.is_structured())
      for (nlohmann::json& child : node) fill(child);
  };
  fill(spec);
  return spec;
}

}  // namespace odobench
