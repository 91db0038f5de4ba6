// Writes the sample report for the browser tests: sample_report PAGE.html [FIGURES.json TABLES.json]
#include <fstream>
#include <iostream>

#include "reports/page/web_assets.hpp"
#include "tests/support/data/sample_document.hpp"

namespace {

bool write(const char* path, const std::string& text) {
  std::ofstream out(path, std::ios::binary);
  return static_cast<bool>((out << text).flush());
}

}  // namespace

int main(int argc, char** argv) {
  using namespace odobench;
  if (argc != 2 && argc != 4) {
    std::cerr << "usage: sample_report PAGE.html [FIGURES.json TABLES.json]\n";
    return 2;
  }
  const Document document = odobench::testing::sample_document();
  if (!write(argv[1], render_html(document))) return 1;
  if (argc == 4) {
    nlohmann::json list = nlohmann::json::array();
    std::vector<Table> tables;
    for (const Figure* figure : figures(document))
      list.push_back({{"id", figure->id}, {"spec", standalone(*figure, document.datasets)}});
    for (const Section& section : document.sections)
      for (const Block& block : section.blocks)
        if (const auto* table = std::get_if<Table>(&block)) tables.push_back(*table);
    if (!write(argv[2], list.dump()) || !write(argv[3], render(tables, Format::Json))) return 1;
  }
  if (!has_chart_library()) {
    std::cerr << "sample_report: this build has no chart library\n";
    return 77;
  }
}
