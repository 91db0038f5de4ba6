#include "bench/written.hpp"

#include "base/files.hpp"
#include "base/sha256.hpp"

namespace odobench {
namespace {

Column column(const char* id, const char* unit = "", Align align = Align::Right) {
  return {id, id, unit, "", "", align};
}

}  // namespace

Table written_table(const std::vector<std::filesystem::path>& files) {
  Table table{"written",
              "Files written",
              {column("file", "", Align::Left), column("bytes"), column("sha256", "", Align::Left)},
              {},
              {}};
  for (const std::filesystem::path& file : files) {
    const std::string bytes = read_file(file);
    table.rows.push_back(
        {text_cell(file.string()), count_cell(static_cast<double>(bytes.size())), text_cell(sha256(bytes))});
  }
  return table;
}

Table dataset_table(const Dataset& dataset) {
  double samples = 0, seconds = 0;
  for (const Recording& r : dataset.recordings) {
    samples += static_cast<double>(r.size());
    if (r.size() > 1) seconds += static_cast<double>(r.time_us.back() - r.time_us.front()) * 1e-6;
  }
  return {"dataset",
          "Data set " + dataset.name,
          {column("name", "", Align::Left), column("trajectories"), column("recordings"), column("samples"),
           column("duration", "s")},
          {{text_cell(dataset.name), count_cell(static_cast<double>(dataset.trajectories.size())),
            count_cell(static_cast<double>(dataset.recordings.size())), count_cell(samples),
            fixed_cell(seconds, 3)}},
          dataset.notes};
}

}  // namespace odobench
