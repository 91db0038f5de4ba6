#include "datasets/entropy/entropy_window_file.hpp"

#include <fmt/format.h>

#include <cmath>
#include <set>

#include "base/json_node.hpp"
#include "base/range.hpp"

namespace odobench {
namespace {

constexpr const char* kWindowFormat = "entropy-window-1";
constexpr std::int64_t kMostSamples = 10000;

double finite(const JsonNode& node) {
  return node.number();
}

double positive(const JsonNode& node) {
  const double value = finite(node);
  if (!(value > 0)) node.fail(fmt::format("{}", value), "a number > 0");
  return value;
}

std::vector<double> finite_numbers(const JsonNode& node, std::size_t count) {
  const std::vector<double> values = node.numbers();
  if (values.size() != count) node.fail(fmt::format("{} numbers", values.size()), fmt::format("{}", count));
  for (std::size_t i = 0; i < count; ++i)
    if (!in_range(values[i]))
      node.fail(fmt::format("{} in place {}", values[i], i),
                fmt::format("numbers of at most {:g} in size", kLargestNumber));
  return values;
}

EntropyConstants constants(const JsonNode& window) {
  const std::int64_t samples = window.at("N").integer();
  if (samples < 3 || samples > kMostSamples)
    window.at("N").fail(fmt::format("{}", samples), fmt::format("3 .. {}", kMostSamples));
  const JsonNode params = window.at("params");
  EntropyConstants c;
  c.samples = static_cast<int>(samples);
  c.dt = positive(params.at("dt"));
  c.length = positive(params.at("ilgis")) / 100;
  c.width = positive(params.at("plotis")) / 100;
  c.wheel_distance = positive(params.at("L"));
  c.sigma_encoder = positive(params.at("sigma_e"));
  c.sigma_acceleration = positive(params.at("sigma_a"));
  c.sigma_rotation = positive(params.at("sigma_theta"));
  c.step_acceleration = positive(params.at("step_a"));
  c.step_rotation = positive(params.at("step_z"));
  return c;
}

EntropyWindow window_from(const JsonNode& node) {
  EntropyWindow window;
  window.id = node.at("id").text();
  if (window.id.empty()) node.at("id").fail("an empty text", "the name of the window");
  window.group = node.text_or_empty("group");
  window.constants = constants(node);
  const auto count = static_cast<std::size_t>(window.constants.samples);
  window.samples.resize(count);

  const std::vector<double> psi = finite_numbers(node.at("psi"), 4);
  const std::vector<JsonNode> wheels = node.at("ce").elements();
  if (wheels.size() != 4)
    node.at("ce").fail(fmt::format("{} arrays", wheels.size()), "one for each of 4 wheels");
  const std::vector<double> ax = finite_numbers(node.at("ax"), count);
  const std::vector<double> ay = finite_numbers(node.at("ay"), count);
  const std::vector<double> rotation = finite_numbers(node.at("ctheta"), count);
  for (std::size_t w = 0; w < 4; ++w) {
    const std::vector<double> displacement = finite_numbers(wheels[w], count);
    for (std::size_t n = 0; n < count; ++n) {
      window.samples[n].wheel[w] = displacement[n];
      window.samples[n].steering[w] = psi[w];
    }
  }
  for (std::size_t n = 0; n < count; ++n) {
    window.samples[n].ax = ax[n];
    window.samples[n].ay = ay[n];
    window.samples[n].rotation = rotation[n];
  }
  return window;
}

}  // namespace

std::vector<EntropyWindow> load_entropy_windows(const std::filesystem::path& file) {
  const JsonNode root = JsonNode::read(file);
  if (root.at("format").text() != kWindowFormat)
    root.at("format").fail(fmt::format("\"{}\"", root.at("format").text()),
                           fmt::format("\"{}\"", kWindowFormat));
  std::vector<EntropyWindow> windows;
  std::set<std::string> ids;
  for (const JsonNode& node : root.at("windows").elements()) {
    windows.push_back(window_from(node));
    if (!ids.insert(windows.back().id).second)
      node.at("id").fail(fmt::format("\"{}\" a second time", windows.back().id),
                         "another name for every window");
  }
  if (windows.empty()) root.at("windows").fail("an empty array", "at least one window");
  return windows;
}

}  // namespace odobench
