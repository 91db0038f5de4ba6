#include "bench/studies/exporting/export_texts.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <set>
#include <stdexcept>

#include "base/text.hpp"
#include "bench/studies/exporting/found_values.hpp"

namespace odobench {
namespace {

std::string replaced(std::string text, const std::string& what, const std::string& by) {
  for (std::size_t at = text.find(what); at != std::string::npos; at = text.find(what, at + by.size()))
    text.replace(at, what.size(), by);
  return text;
}

// A key that every reader of YAML takes for a text.
std::string yaml_key(const std::string& key) {
  static const std::set<std::string> words = {"true", "false", "yes", "no", "on", "off", "null", "y", "n"};
  std::string lower = key;
  std::transform(lower.begin(), lower.end(), lower.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  const auto plain = [](unsigned char c) { return std::isalnum(c) != 0 || c == '_' || c == '/'; };
  const bool bare = !key.empty() && std::all_of(key.begin(), key.end(), plain) &&
                    std::isdigit(static_cast<unsigned char>(key.front())) == 0 &&
                    (lower == "y" || !words.contains(lower));
  if (bare) return key;
  return "\"" + replaced(replaced(printable(key), "\\", "\\\\"), "\"", "\\\"") + "\"";
}

std::vector<std::string> parts_of(const std::string& path) {
  std::vector<std::string> parts(1);
  for (const char c : path)
    if (c == '.')
      parts.emplace_back();
    else
      parts.back() += c;
  return parts;
}

std::string xml_comment(const std::string& text) {
  return fmt::format("<!-- {} -->\n", replaced(text, "--", "- -"));
}

std::string xml_value(const std::string& text) {
  return replaced(replaced(replaced(text, "&", "&amp;"), "\"", "&quot;"), "<", "&lt;");
}

// wheel_radius_left of wheel_left, wheel_radius_front_left, wheel_radius of the only wheel.
std::string radius_property(const std::string& wheel) {
  if (wheel == "wheel") return "wheel_radius";
  return "wheel_radius_" + (wheel.starts_with("wheel_") ? wheel.substr(6) : wheel);
}

std::string upper_name(const std::string& text) {
  std::string name;
  for (const unsigned char c : text) name += std::isalnum(c) != 0 ? static_cast<char>(std::toupper(c)) : '_';
  return name;
}

// frontLeft of front_left.
std::string java_name(const std::string& name) {
  std::string camel = "k";
  bool upper = true;
  for (const char c : name) {
    if (c == '_') {
      upper = true;
      continue;
    }
    camel += upper ? static_cast<char>(std::toupper(static_cast<unsigned char>(c))) : c;
    upper = false;
  }
  return camel;
}

std::string translation(const Wheel& wheel) {
  return fmt::format("new Translation2d({}, {})", decimal(wheel.x, 6), decimal(wheel.y, 6));
}

// In WPILib's order where wheels stand one in each quadrant, else as they are.
std::vector<std::size_t> module_order(const ParameterFile& file) {
  std::vector<std::size_t> order = quadrants(file);
  if (order.empty())
    for (std::size_t i = 0; i < file.wheels.size(); ++i) order.push_back(i);
  return order;
}

std::string java_wheels(const ParameterFile& file) {
  const std::vector<std::string> names = wheel_names(file);
  std::string text;
  for (const std::size_t i : module_order(file)) {
    const Wheel &wheel = file.wheels[i], &nominal = file.nominal_wheels[i];
    if (!wheel.drive.empty())
      text += fmt::format("public static final double {}Radius = {};  // m, nominal {}\n",
                          java_name(names[i]), decimal(wheel.radius, 6), decimal(nominal.radius, 6));
    if (!wheel.steering.empty())
      text += fmt::format(
          "public static final double {}SteeringOffset = {};  // rad, to be added to the module's angle\n",
          java_name(names[i]), decimal(wheel.zero, 6));
  }
  return text;
}

}  // namespace

std::string yaml_text(const ParameterFile& file, const KeyTable& table, const std::string& node) {
  std::string text;
  const auto comments = [&](const std::vector<std::string>& lines) {
    for (const std::string& line : lines) text += "# " + printable(line) + "\n";
  };
  comments(origin_lines(file));
  comments(table.statements);
  for (const std::string& loss : table.losses) text += "# lost: " + printable(loss) + "\n";
  comments(table.elsewhere);
  if (const std::optional<FoundMount> mount = found_mount(file)) {
    text += fmt::format(
        "# ros2 run tf2_ros static_transform_publisher --x {} --y {} --z 0.0 --yaw {} --frame-id base_link "
        "--child-frame-id tracker\n",
        decimal(mount->x.value, 6), decimal(mount->y.value, 6), decimal(mount->yaw.value, 6));
    comments({words_of(mount->x) + "; " + words_of(mount->y) + "; " + words_of(mount->yaw)});
  }
  text += yaml_key(node) + ":\n  ros__parameters:\n";
  std::vector<std::string> open;  // objects
  for (const ExportKey& key : table.keys) {
    const std::vector<std::string> parts = parts_of(key.path);
    std::size_t shared = 0;
    while (shared < open.size() && shared + 1 < parts.size() && open[shared] == parts[shared]) ++shared;
    open.resize(shared);
    for (; open.size() + 1 < parts.size(); open.push_back(parts[open.size()]))
      text += std::string(4 + 2 * open.size(), ' ') + yaml_key(parts[open.size()]) + ":\n";
    text += std::string(4 + 2 * open.size(), ' ') + yaml_key(parts.back()) + ": " + key.value;
    text += key.remark.empty() ? "\n" : "  # " + printable(key.remark) + "\n";
  }
  return text;
}

std::string urdf_text(const ParameterFile& file) {
  const std::vector<std::string> names = wheel_names(file);
  std::string text;
  for (const std::string& line : origin_lines(file)) text += xml_comment(line);
  text += xml_comment("height of the axles above the base frame: not calibrated, write your own");
  text += "<xacro:property name=\"wheel_z\" value=\"0.0\"/>\n";
  for (std::size_t i = 0; i < names.size(); ++i) {
    const Wheel &wheel = file.wheels[i], &nominal = file.nominal_wheels[i];
    const std::string name = xml_value(names[i]);
    text += "\n" +
            xml_comment(fmt::format("{}: nominal x {}, y {}, yaw {}, radius {}", name, decimal(nominal.x, 6),
                                    decimal(nominal.y, 6), decimal(nominal.mount + nominal.zero, 6),
                                    wheel.drive.empty() ? "not measured" : decimal(nominal.radius, 6)));
    if (!wheel.drive.empty())
      text += fmt::format("<xacro:property name=\"{}\" value=\"{}\"/>\n", radius_property(name),
                          decimal(wheel.radius, 6));
    text += xml_comment(
        fmt::format("in <joint name=\"{}_{}joint\">", name, wheel.steering.empty() ? "" : "steering_"));
    text += fmt::format("<origin xyz=\"{} {} ${{wheel_z}}\" rpy=\"0 0 {}\"/>\n", decimal(wheel.x, 6),
                        decimal(wheel.y, 6), decimal(wheel.mount + wheel.zero, 6));
    if (wheel.drive.empty()) continue;
    text += xml_comment("in the wheel's <geometry>, with a width of your own");
    text +=
        fmt::format("<cylinder radius=\"${{{}}}\" length=\"${{wheel_width}}\"/>\n", radius_property(name));
  }
  if (const std::optional<FoundMount> mount = found_mount(file)) {
    text += "\n" + xml_comment("in a fixed joint from base_link to tracker: " + words_of(mount->x) + "; " +
                               words_of(mount->y) + "; " + words_of(mount->yaw));
    text += fmt::format("<origin xyz=\"{} {} 0.0\" rpy=\"0 0 {}\"/>\n", decimal(mount->x.value, 6),
                        decimal(mount->y.value, 6), decimal(mount->yaw.value, 6));
  }
  return text;
}

std::string c_text(const ParameterFile& file, const std::string& prefix) {
  const std::string head = upper_name(prefix);
  std::string text;
  for (const std::string& line : origin_lines(file))
    text += fmt::format("/* {} */\n", replaced(line, "*/", "* /"));
  text += fmt::format("#ifndef {0}_H\n#define {0}_H\n\n", head);
  std::set<std::string> taken;
  for (const ExportKey& key : generic_keys(file).keys) {
    // Behind "parameters." and "wheels.".
    const std::size_t from = key.path.starts_with("noise.") ? 0 : key.path.find('.') + 1;
    const std::string base = head + "_" + upper_name(key.path.substr(from));
    std::string own = base;
    for (int k = 2; !taken.insert(own).second; ++k) own = fmt::format("{}_{}", base, k);
    text += fmt::format("#define {} ({}) /* {} */\n", own, key.value,
                        replaced(printable(key.remark), "*/", "* /"));
  }
  return text + "\n#endif\n";
}

std::string wpilib_text(const ParameterFile& file) {
  const std::string& kind = file.kinematics;
  std::string text;
  for (const std::string& line : origin_lines(file)) text += "// " + line + "\n";
  text += "// Lines to paste into a class of constants; metres and radians, x forward, y left.\n";
  text += java_wheels(file);
  if (kind == "differential" || kind == "skid_steer") {
    double low = 0, high = 0;
    for (const Wheel& wheel : file.wheels) {
      low = std::min(low, wheel.y);
      high = std::max(high, wheel.y);
    }
    return text + fmt::format(
                      "public static final DifferentialDriveKinematics kKinematics =\n"
                      "    new DifferentialDriveKinematics({});  // track\n",
                      decimal(high - low, 6));
  }
  const bool modules = kind.starts_with("swerve") || kind == "4wis4wid";
  if (!modules && kind != "mecanum")
    throw std::invalid_argument(
        fmt::format("--to=wpilib: it has no kinematics for a robot of class '{}'; there are some for "
                    "differential, skid_steer, mecanum, swerve and 4wis4wid",
                    shown(kind)));
  const char* name = modules ? "SwerveDriveKinematics" : "MecanumDriveKinematics";
  text += fmt::format("public static final {0} kKinematics = new {0}(\n", name);
  const std::vector<std::string> names = wheel_names(file);
  const std::vector<std::size_t> order = module_order(file);
  for (std::size_t k = 0; k < order.size(); ++k)
    text +=
        fmt::format("    {}{}  // {}, nominal {}, {}\n", translation(file.wheels[order[k]]),
                    k + 1 < order.size() ? "," : ");", names[order[k]],
                    decimal(file.nominal_wheels[order[k]].x, 6), decimal(file.nominal_wheels[order[k]].y, 6));
  return text;
}

}  // namespace odobench
