#include "bench/options/written_files.hpp"

#include <fmt/format.h>

#include "base/files.hpp"
#include "base/sha256.hpp"
#include "bench/catalogue/option_values.hpp"
#include "bench/console/interrupt.hpp"
#include "bench/console/table_output.hpp"
#include "datasets/native/sensor_files.hpp"

namespace odobench {

Table written_table(const std::vector<std::filesystem::path>& files) {
  Table table{"written",
              "Files written",
              {text_column("file"), number_column("bytes"), text_column("sha256")},
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
          {text_column("name"), number_column("trajectories"), number_column("recordings"),
           number_column("samples"), number_column("duration", "duration", "s")},
          {{text_cell(dataset.name), count_cell(static_cast<double>(dataset.trajectories.size())),
            count_cell(static_cast<double>(dataset.recordings.size())), count_cell(samples),
            fixed_cell(seconds, 3)}},
          dataset.notes};
}

void save_announced(const Dataset& dataset, const std::filesystem::path& set, bool overwrite, bool json,
                    bool quiet, const SetSensors& sensors) {
  InterruptGuard::remember();
  FileTransaction transaction(existing_files(overwrite));
  std::vector<std::string> ids;
  for (const Recording& r : dataset.recordings) ids.push_back(r.id);
  const std::vector<std::string> remarks = add_sensor_files(sensors, ids, set, transaction);
  add_dataset(dataset, set, transaction, false, InterruptGuard::stop());
  const std::vector<std::filesystem::path> files = transaction.targets();
  transaction.commit();
  std::size_t samples = 0;
  for (const Recording& r : dataset.recordings) samples += r.size();
  if (!quiet)
    note(fmt::format("{}: {} recordings, {} samples", set.string(), dataset.recordings.size(), samples));
  if (!quiet)
    for (const std::string& remark : remarks) note(remark);
  if (json) print_tables({dataset_table(dataset), written_table(files)}, Format::Json);
}

}  // namespace odobench
