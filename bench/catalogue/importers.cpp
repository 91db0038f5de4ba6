#include "bench/catalogue/importers.hpp"

#include <filesystem>

#include "bench/catalogue/option_values.hpp"
#include "datasets/import/csv/csv_import.hpp"
#include "datasets/import/optiodom/optiodom.hpp"
#include "datasets/import/vitko2024/vitko2024.hpp"

namespace odobench {
namespace {

Dataset from_csv(const ImportRequest& request) {
  CsvImport imported = import_csv(comma_items(request.from), request.map);
  if (request.say)
    for (const std::string& line : imported.report) request.say(line);
  return std::move(imported.dataset);
}

Dataset from_optiodom(const ImportRequest& request) {
  std::vector<std::filesystem::path> folders;
  for (const std::string& item : comma_items(request.from)) folders.emplace_back(item);
  return import_optiodom(folders, {request.exclude});
}

Dataset from_vitko2024(const ImportRequest& request) {
  return import_vitko2024(request.from, request.progress, 0, request.drop_lost);
}

}  // namespace

const std::vector<ImporterEntry>& known_importers() {
  static const std::vector<ImporterEntry> list = {
      {"csv", false, false, true, from_csv},
      {"vitko2024", false, true, false, from_vitko2024},
      {"optiodom", true, false, false, from_optiodom},
  };
  return list;
}

}  // namespace odobench
