// Recordings as the filters take them: wheel speeds that hold until the next stamp, drives from the origin.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "bench/catalogue/problem_factory.hpp"
#include "problems/fusion/sensors_file.hpp"

namespace odobench {

struct FusableRecordings {
  std::vector<Recording> recordings;
  std::vector<Eigen::Vector2d> origins;  // what was taken off positions; as many, or none
};

// Those of a set of the thesis' robot. Increments, as imported logs have them, become the speed that
// increment / step is from the stamp before, with the steering angle of the same step; the reference moves so
// that each drive begins at (0, 0). Speeds stay as they are. Throws DataError for another robot and for a
// reference that is not at every stamp.
FusableRecordings fusable_recordings(const LoadedProblem& loaded);

// The same shift for poses that were measured, in the reference's frame.
void shift_streams(const FusableRecordings& fusable, const SensorsFile& sensors,
                   std::vector<std::vector<SensorStream>>& streams);

}  // namespace odobench
