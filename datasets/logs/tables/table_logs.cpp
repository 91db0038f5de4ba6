#include "datasets/logs/tables/table_logs.hpp"

#include "datasets/logs/arrays/mat.hpp"
#include "datasets/logs/arrays/npz.hpp"
#include "datasets/logs/tables/json_lines.hpp"
#include "datasets/logs/tables/table_log.hpp"
#include "datasets/logs/tables/trajectories.hpp"

namespace odobench {

const std::vector<LogFormat>& table_log_formats() {
  static const std::vector<LogFormat> formats{mat_log_format(), mat73_log_format(),      npz_log_format(),
                                              npy_log_format(), json_lines_log_format(), motive_log_format(),
                                              tum_log_format(), euroc_log_format(),      kitti_log_format(),
                                              csv_log_format()};
  return formats;
}

}  // namespace odobench
