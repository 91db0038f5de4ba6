// What plans of scenarios and of any robot have in common.
#pragma once

#include <string>
#include <vector>

#include "bench/studies/planning/drive_plan.hpp"
#include "problems/information/drive_planning.hpp"

namespace odobench {

// Of `names`: which are planned, how often, and which may be proposed.
struct DriveSelection {
  std::vector<std::size_t> drives;  // those used at all
  std::vector<int> counts;          // how often each is planned
  std::vector<bool> candidate;
};
// `own`: how often each is driven where --drives says nothing.
DriveSelection select_drives(const std::vector<std::string>& names, const std::vector<int>& own,
                             const DrivePlan& study);

// The relative standard deviations and directions of the plan; what is not determined has no measure.
RunRecord plan_record(const std::string& name, const PlanAnalysis& a,
                      const std::vector<ParameterInfo>& parameters, const DrivePlan& study,
                      InstructionSet kernel);

// Adds what is proposed to the record. Planned drives that are no candidates stay as they are.
void put_proposals(const std::vector<DriveInformation>& drives, const DriveSelection& selection,
                   const std::vector<ParameterInfo>& parameters, double wanted, RunRecord& record);

// The scatter of r simulations of a drive has a rank of r - 1 at most: along the rest nothing would be
// uncertain. "" where there are enough.
std::string too_few_replicas(const DriveSelection& selection, std::size_t parameters, const DrivePlan& study);

// The plan of a robot that is_robot() knows.
std::vector<RunRecord> plan_robot(const DrivePlan& study, InstructionSet kernel, Watcher& watcher,
                                  const Stop& stop);

}  // namespace odobench
