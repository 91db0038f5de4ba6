// Plans between two models as what reports/kinds/planning/rival_tables.hpp reads.
#pragma once

#include "bench/studies/planning/rival_models.hpp"
#include "reports/records/record.hpp"

namespace odobench {

void put_rivals(const ModelFits& a, const ModelFits& b, const RivalPlan& plan, RunRecord& record);

}  // namespace odobench
