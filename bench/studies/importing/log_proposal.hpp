// A map for logs, to be filled in: what their fields seem to be, with the evidence.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "base/stop.hpp"
#include "datasets/logs/log_file.hpp"

namespace odobench {

struct LogProposal {
  std::string map;                   // JSON; null where the logs do not say
  std::vector<std::string> reasons;  // a line each
  bool complete = false;             // wheels, a class and a reference were found
};

// Roles by names and types (datasets/import/logs/log_roles.hpp), then by what the drives say. With (v, omega)
// the reference's velocity along its heading and yaw rate, a wheel's rate w = alpha v + beta omega by least
// squares: the sign of alpha is the wheel's, that of beta / alpha the side it stands on, 1 / alpha about its
// radius, the distance between sides about the track.
// `robot`: its class, where it is known.
LogProposal propose_log_map(const std::vector<std::filesystem::path>& logs, const LogOptions& options,
                            const Stop& stop, const std::string& robot = "");

}  // namespace odobench
