// What `bench fuse` found -> tables in the layout of J. Vitko's thesis (tables 43-67), and what it lacks:
// root mean square errors, consistency (NEES, NIS) with bands, and a verdict in words.
#pragma once

#include <string>
#include <vector>

#include "reports/records/record.hpp"
#include "reports/render/table.hpp"

namespace odobench {

struct FusionSensorRow {
  std::string name;
  double used = 0, rejected = 0, late = 0;
  double mean_nis = 0;  // over the degrees of freedom `dof`: expected value
  int dof = 0;
  double lower = 0, upper = 0;  // band of the mean
  // Of a gyro, rad/s: root mean square over the recordings of its mean difference to the wheels, and what of
  // that white noise explains. Not in records.
  double innovation_rms = 0, innovation_noise = 0;
};

// One parameter set with one filter, over all recordings.
struct FusionRow {
  std::string label;      // "published:ga+ekf"
  bool filtered = false;  // odometry alone has no covariance, hence nothing below the errors
  double rmse_position = 0, rmse_heading = 0;
  // Mean over the recordings at each instant, mean of that over the instants; part of the instants inside the
  // band.
  double mean_nees = 0, inside = 0;
  double lower = 0, upper = 0;  // band of the mean over the recordings
  std::vector<double> nees;     // that mean at each instant
  std::vector<FusionSensorRow> sensors;
  std::string verdict;
};

// sensors       which they are; the title says that they are synthetic
// errors.LABEL  per filtered label: tables 43-48, 49-54, 55-60, trajectories as rows
// errors.TRAJ   tables 61-66: every label, difference to nominal odometry in brackets
// totals        table 67
// consistency   RMSE, NEES, verdict;   innovations: per sensor NIS, used, rejected, late
// `records`: evaluations as of `bench evaluate`, one per label, "nominal" first. `sensors` null: left out.
std::vector<Table> fusion_tables(const Table* sensors, const std::vector<RunRecord>& records,
                                 const std::vector<FusionRow>& rows);

}  // namespace odobench
