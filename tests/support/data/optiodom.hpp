// OptiOdom's recordings and what an independent evaluation says about them (robots.json), whose parameters
// are diameters and whole distances.
#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <string>

#include "base/angle.hpp"
#include "datasets/import/optiodom/optiodom.hpp"
#include "tests/support/shared_data.hpp"

namespace odobench::testing {

inline std::filesystem::path optiodom_folder() {
  return shared_folder() / "datasets" / "optiodom";
}

inline const nlohmann::json& optiodom_reference(const std::string& name = "robots.json") {
  static std::map<std::string, nlohmann::json> documents;
  nlohmann::json& document = documents[name];
  if (document.is_null()) {
    std::ifstream file(shared_folder() / "reference" / name);
    document = nlohmann::json::parse(file);
  }
  return document;
}

inline const Dataset& optiodom_set(const std::string& folder) {
  static std::map<std::string, Dataset> sets;
  const auto found = sets.find(folder);
  if (found != sets.end()) return found->second;
  return sets.emplace(folder, import_optiodom({optiodom_folder() / folder})).first->second;
}

inline Eigen::VectorXd vector_of_json(const nlohmann::json& list) {
  const auto values = list.get<std::vector<double>>();
  return Eigen::Map<const Eigen::VectorXd>(values.data(), static_cast<Eigen::Index>(values.size()));
}

// Ours are half of the reference's, but for the distance of all but omni4 and the tricycle's zero.
inline Eigen::VectorXd halves(const std::string& type, Eigen::Index count) {
  Eigen::VectorXd factors = Eigen::VectorXd::Constant(count, 0.5);
  if (type != "omni4") factors[0] = 1;
  if (type == "tricyc") factors[2] = 1;
  return factors;
}

// Parameters of our robot from the reference's, and back; the rollers' angle is ours alone.
inline Eigen::VectorXd our_parameters(const std::string& type, const Eigen::VectorXd& reference) {
  const Eigen::VectorXd z = reference.cwiseProduct(halves(type, reference.size()));
  if (type != "omni4") return z;
  Eigen::VectorXd ours(7);
  ours << z.head(2), kPi / 4, z.tail(4);
  return ours;
}
inline Eigen::VectorXd without_roller(const std::string& type, const Eigen::VectorXd& ours) {
  if (type != "omni4") return ours;
  Eigen::VectorXd z(6);
  z << ours.head(2), ours.tail(4);
  return z;
}
inline Eigen::VectorXd their_parameters(const std::string& type, const Eigen::VectorXd& ours) {
  const Eigen::VectorXd z = without_roller(type, ours);
  return z.cwiseQuotient(halves(type, z.size()));
}
// The gradient by the reference's parameters.
inline Eigen::VectorXd their_gradient(const std::string& type, const Eigen::VectorXd& ours) {
  const Eigen::VectorXd g = without_roller(type, ours);
  return g.cwiseProduct(halves(type, g.size()));
}

}  // namespace odobench::testing

// First line of every test that needs them.
#define ODOBENCH_NEEDS_OPTIODOM()                                              \
  ODOBENCH_NEEDS_SHARED();                                                     \
  if (!std::filesystem::exists(odobench::testing::optiodom_folder() / "diff")) \
  GTEST_SKIP() << "needs " << odobench::testing::optiodom_folder()
