#include "solvers/libraries/library_versions.hpp"

#include <IpoptConfig.h>
#include <ceres/version.h>
#include <fmt/format.h>
#include <nlopt.h>

#include <Eigen/Core>

namespace odobench {

std::string library_versions() {
  int major = 0, minor = 0, bugfix = 0;
  nlopt_version(&major, &minor, &bugfix);
  return fmt::format("Ceres {}, Ipopt {}, NLopt {}.{}.{}, Eigen {}.{}.{}", CERES_VERSION_STRING,
                     IPOPT_VERSION, major, minor, bugfix, EIGEN_WORLD_VERSION, EIGEN_MAJOR_VERSION,
                     EIGEN_MINOR_VERSION);
}

}  // namespace odobench
