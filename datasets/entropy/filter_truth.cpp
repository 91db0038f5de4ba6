#include "datasets/entropy/filter_truth.hpp"

#include <fmt/format.h>

#include <numbers>

namespace odobench {
namespace {

std::string wheel_column(int wheel, char axis) {
  return fmt::format("enc{}{}_m", wheel + 1, axis);
}

// "sx_m" may also be written "sx".
std::vector<std::string> spellings(const std::string& name) {
  return {name, name.substr(0, name.find('_'))};
}

}  // namespace

const std::vector<std::string>& FilterTruthReader::columns() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> list = {"sx_m", "sy_m", "dtheta_deg", "dtheta_rad", "ax_m_s2", "ay_m_s2"};
    for (int w = 0; w < 4; ++w)
      for (const char axis : {'x', 'y'}) list.push_back(wheel_column(w, axis));
    return list;
  }();
  return names;
}

FilterTruthReader::FilterTruthReader(const std::filesystem::path& file, const ColumnMapping& mapping,
                                     const std::atomic<bool>* interrupt)
    : stream_(file, ',', interrupt) {
  if (stream_.interrupted()) return;
  const ColumnFinder finder(stream_, mapping, columns());
  sx_ = finder.require_any(spellings("sx_m"));
  sy_ = finder.require_any(spellings("sy_m"));
  ax_ = finder.require_any(spellings("ax_m_s2"));
  ay_ = finder.require_any(spellings("ay_m_s2"));
  const auto radians = finder.find("dtheta_rad");
  rotation_ = radians ? *radians : finder.require("dtheta_deg");
  rotation_unit_ = radians ? 180 / std::numbers::pi : 1;

  std::array<std::array<std::size_t, 2>, 4> places{};
  std::string missing, there;
  for (int w = 0; w < 4; ++w)
    for (int axis = 0; axis < 2; ++axis) {
      const std::string name = wheel_column(w, axis == 0 ? 'x' : 'y');
      const auto column = finder.find_any(spellings(name));
      if (column) places[w][axis] = *column;
      std::string& list = column ? there : missing;
      if (list.empty()) list = name;
    }
  if (!there.empty() && !missing.empty())
    stream_.fail(fmt::format("found \"{}\" but no column \"{}\", expected all eight of the wheels or none",
                             there, missing));
  if (!there.empty()) wheel_ = places;
}

bool FilterTruthReader::next(FilterTruth& truth) {
  if (!stream_.next()) return false;
  truth.sx = stream_.number(sx_);
  truth.sy = stream_.number(sy_);
  truth.rotation_deg = rotation_unit_ * stream_.number(rotation_);
  truth.ax = stream_.number(ax_);
  truth.ay = stream_.number(ay_);
  if (wheel_) {
    truth.wheel.emplace();
    for (int w = 0; w < 4; ++w)
      for (int axis = 0; axis < 2; ++axis) (*truth.wheel)[w][axis] = stream_.number((*wheel_)[w][axis]);
  }
  ++rows_;
  return true;
}

void FilterTruthReader::too_short(const std::string& file) const {
  stream_.fail(
      fmt::format("found the end of the file after {} rows, expected as many as in {}", rows_, file));
}

void FilterTruthReader::too_long(const std::string& file) const {
  stream_.fail(fmt::format("found more than {} rows, expected as many as in {}", rows_ - 1, file));
}

}  // namespace odobench
