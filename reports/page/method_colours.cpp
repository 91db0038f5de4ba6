#include "reports/page/method_colours.hpp"

#include <algorithm>

#include "reports/figures/vega.hpp"

namespace odobench {
namespace {

using nlohmann::json;

// Places that are not taken have names of blanks, which no legend shows.
std::vector<std::string> shared_domain(const std::vector<std::string>& labels) {
  std::vector<std::string> domain, methods;
  for (const std::string& label : labels)
    if (label != vega::kNominalLabel && label != vega::kReferenceLabel) methods.push_back(label);
  std::string blank;
  for (std::size_t next = 0; domain.empty() || next < methods.size();) {
    const bool first = domain.empty();
    for (std::size_t place = 0; place < kMethodColours; ++place)
      domain.push_back(next < methods.size() ? methods[next++] : (blank += ' '));
    domain.push_back(first ? vega::kNominalLabel : (blank += ' '));
    domain.push_back(first ? vega::kReferenceLabel : (blank += ' '));
  }
  return domain;
}

bool all_in(const json& names, const std::vector<std::string>& domain) {
  return names.is_array() && !names.empty() && std::all_of(names.begin(), names.end(), [&](const json& name) {
           return name.is_string() &&
                  std::find(domain.begin(), domain.end(), name.get<std::string>()) != domain.end();
         });
}

void share(json& node, const std::vector<std::string>& domain) {
  if (node.is_object())
    for (const char* channel : {"color", "shape"}) {
      const auto at = node.find(channel);
      if (at == node.end() || !at->is_object() || !at->contains("scale") ||
          !(*at)["scale"].contains("domain"))
        continue;
      const json own = (*at)["scale"]["domain"];
      if (!all_in(own, domain)) continue;
      (*at)["scale"]["domain"] = domain;
      if (!at->contains("legend") || !(*at)["legend"].is_null()) (*at)["legend"]["values"] = own;
    }
  if (node.is_structured())
    for (json& child : node) share(child, domain);
}

}  // namespace

void share_method_colours(Document& document, const std::vector<std::string>& labels) {
  const std::vector<std::string> domain = shared_domain(labels);
  for (Section& section : document.sections)
    for (Block& block : section.blocks)
      if (Figure* figure = std::get_if<Figure>(&block)) share(figure->spec, domain);
}

}  // namespace odobench
