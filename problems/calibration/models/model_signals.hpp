// A recording's signals as the kernel takes them: per wheel drive, cos and sin of the steering, its change,
// read earlier or later, with derivatives by the time offset.
#pragma once

#include <vector>

#include "datasets/recording.hpp"
#include "datasets/robots/wheel.hpp"
#include "problems/calibration/kernel/wheels.hpp"
#include "problems/calibration/models/model_terms.hpp"
#include "problems/matrices.hpp"
#include "problems/robots/wheeled_robot.hpp"

namespace odobench {

// value(t - offset) of samples at stamps t (s, increasing), linear between stamps and held beyond the first
// and the last; `by`: its derivative by the offset, the mean of both sides where it has a kink. out: as many
// as values.
void read_earlier(const Vector& t, const Vector& values, double offset, Vector& out, Vector& by);

class ModelSignals {
 public:
  // What all recordings of a robot have in common. `rates`: steering moves the contacts.
  ModelSignals(const robots::WheeledRobot& robot, const ModelTerms& terms);

  // Rows of the streams, and where each wheel finds its own (with other fields as `wheels` has them).
  int streams() const { return streams_; }
  void place(std::vector<kernel::ModelWheel>& wheels) const;

  // The raw values, one row per signal of the robot, one column per stamp. Throws std::invalid_argument
  // naming recording and signal: missing, of the wrong kind, speeds beside increments.
  struct Raw {
    Vector time;  // s
    Matrix values;
    bool increments = false;
    Eigen::Index intervals() const { return time.size() - 1; }
  };
  Raw raw(const Recording& recording) const;

  // data[(step * streams + stream) * width + lane] of lanes of `steps` intervals each; behind the last
  // interval the wheels stand still. gains: of the steering, one per wheel.
  std::vector<double> blocks(const Raw& raw, double time_offset, const std::vector<double>& gains,
                             Eigen::Index steps, int width) const;

 private:
  struct Places {
    int drive = -1, cosine = -1, sine = -1, change = -1, steering = -1;
    int drive_by = -1, steering_by = -1, change_by = -1;
    std::vector<std::pair<Eigen::Index, double>> drives;  // signal, weight
    Eigen::Index steered_by = -1;                         // signal
  };
  std::vector<std::string> names_;
  Eigen::Index drive_count_ = 0;
  std::vector<Places> places_;
  int streams_ = 0;
  bool speeds_only_ = false;
};

}  // namespace odobench
