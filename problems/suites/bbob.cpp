#include "problems/suites/bbob.hpp"

#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <stdexcept>

#include "problems/suites/bbob_functions.hpp"
#include "problems/suites/bbob_random.hpp"

namespace odobench {
namespace {

constexpr int kUsualDimension = 10;

struct BbobModel {
  std::string label;
  BbobInstance instance;
  std::vector<ParameterInfo> list;

  std::string name() const { return label; }
  const std::vector<ParameterInfo>& parameters() const { return list; }
  double cost(const ConstVectorRef& x) const { return instance.raw(x) + instance.offset; }
  double known_optimum() const { return instance.offset; }
  std::vector<Vector> known_minimisers() const { return {instance.best}; }
  // The offset is added last.
  double rounding_floor(const ConstVectorRef& x) const {
    return 2 * std::numeric_limits<double>::epsilon() *
           (std::abs(instance.offset) + std::abs(instance.raw(x)));
  }
};

struct SmoothBbobModel : BbobModel {
  double cost_and_gradient(const ConstVectorRef& x, VectorRef g) const {
    return instance.raw_and_gradient(x, g) + instance.offset;
  }
};

std::string bbob_name(int function) {
  return fmt::format("bbob:f{}", function);
}

}  // namespace

std::vector<ClassicEntry> bbob_entries() {
  std::vector<ClassicEntry> list;
  for (int k = 1; k <= kBbobFunctions; ++k) {
    ClassicEntry entry{bbob_name(k),
                       "bbob",
                       kUsualDimension,
                       DimensionRule{2, 40, 1},
                       0,
                       fmt::format("BBOB (2009) f{}, {}", k, bbob_title(k)),
                       bbob_offset(k, 1)};
    entry.instances = kBbobInstances;
    entry.hard = bbob_hardness(k);
    list.push_back(std::move(entry));
  }
  return list;
}

Problem make_bbob_problem(const std::string& name, int dimension, int instance) {
  int function = 0;
  for (int k = 1; k <= kBbobFunctions; ++k)
    if (name == bbob_name(k)) function = k;
  if (function == 0) throw std::invalid_argument(fmt::format("unknown problem '{}'", name));
  if (instance < 1 || instance > kBbobInstances)
    throw std::invalid_argument(
        fmt::format("problem '{}': instance {}; expected 1..{}", name, instance, kBbobInstances));
  SmoothBbobModel model;
  model.label = name;
  model.instance = BbobInstance::make(function, dimension, instance);
  for (int i = 1; i <= dimension; ++i) model.list.push_back({fmt::format("x{}", i), "1", 0.0, -5.0, 5.0});
  if (BbobInstance::has_gradient(function)) return Problem(std::move(model));
  return Problem(static_cast<BbobModel>(std::move(model)));
}

}  // namespace odobench
