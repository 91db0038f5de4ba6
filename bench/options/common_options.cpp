#include "bench/options/common_options.hpp"

#include <fmt/format.h>

#include <stdexcept>

#include "base/names.hpp"
#include "base/text.hpp"
#include "bench/catalogue/number_text.hpp"
#include "bench/catalogue/option_values.hpp"
#include "bench/options/config_file.hpp"
#include "solvers/options.hpp"

namespace odobench {

CLI::Option* add_value(CLI::App& app, const std::string& name, const char* type, const std::string& help,
                       const std::function<void(const std::string&)>& set) {
  return app.add_option_function<std::string>(name, set, help)->type_name(type);
}

void add_kernel(CLI::App& app, std::optional<InstructionSet>& kernel, const std::string& remark) {
  add_value(
      app, "--kernel", "auto|avx512|avx2|baseline",
      fmt::format("vector instructions of the cost evaluations; {} [$ODOBENCH_KERNEL, else auto: the widest "
                  "of this processor]",
                  remark),
      [&kernel](const std::string& text) { kernel = instruction_set("--kernel", text); });
}

namespace {

void add_loss(CLI::App& app, CalibrationChoice& choice) {
  add_value(app, "--loss", "NAME[=TUNING][:recording]",
            "what large errors count for: squared, huber, cauchy or tukey, of every sample or of every "
            "recording [squared]",
            [&choice](const std::string& text) { choice.loss = parse_loss(text); });
  add_value(
      app, "--loss-scale", "P,H|S",
      "of a loss per sample in m and rad, of one per recording one number [estimated from the errors of "
      "the least-squares solution]",
      [&choice](const std::string& text) {
        choice.loss_scale.clear();
        for (const std::string& item : comma_items(text))
          choice.loss_scale.push_back(finite_number("--loss-scale", item, true));
      });
}

}  // namespace

void add_screen(CLI::App& app, double& screen) {
  add_value(app, "--screen", "off|Z",
            fmt::format("leave out recordings that differ from their repetitions by more than Z times the "
                        "usual [{:g}]",
                        kUsualScreen),
            [&screen](const std::string& text) {
              screen = text == "off" ? 0 : finite_number("--screen", text, true);
            });
}

void add_cost(CLI::App& app, CalibrationChoice& choice) {
  add_value(
      app, "--cost", "NAME",
      "what is compared with the reference: every_sample, final_pose, segments or optiodom [every_sample]",
      [&choice](const std::string& text) { choice.cost = cost_kind(text); });
  add_value(app, "--integration", "RULE",
            "from motions to poses: euler, midpoint, arc or optiodom-omni [that of the robot's class]",
            [&choice](const std::string& text) { choice.rule = robots::integration_rule(text); });
  add_value(app, "--twist", "RULE", "of steered wheels: least_squares or mean [as the set has it]",
            [&choice](const std::string& text) { choice.twist = twist_rule(text); });
  add_value(app, "--weights", "P,H|auto",
            "of squared position (m) and heading (rad) errors; auto: from the errors of the data [1,1]",
            [&choice](const std::string& text) {
              choice.estimate_weights = text == "auto";
              if (choice.estimate_weights) return;
              const std::size_t comma = text.find(',');
              if (comma == std::string::npos)
                throw std::invalid_argument(fmt::format(
                    "--weights={}: expected two numbers above 0, position,heading, or auto", text));
              choice.position_weight = finite_number("--weights", text.substr(0, comma), true);
              choice.heading_weight = finite_number("--weights", text.substr(comma + 1), true);
            });
  add_value(
      app, "--distance", "M", "between the sample rows of segments and optiodom, in m [0.5]",
      [&choice](const std::string& text) { choice.distance = finite_number("--distance", text, true); });
  add_value(app, "--piece", "Ts|Dm",
            "sample rows of segments and optiodom by time or along the reference instead, e.g. 5s, 0.5m",
            [&choice](const std::string& text) {
              const char unit = text.empty() ? ' ' : text.back();
              if (unit != 's' && unit != 'm')
                throw std::invalid_argument(
                    fmt::format("--piece={}: expected seconds or metres, as in 5s or 0.5m", shown(text)));
              const double size = finite_number("--piece", text.substr(0, text.size() - 1), true);
              choice.piece_seconds = unit == 's' ? size : 0;
              choice.piece_metres = unit == 'm' ? size : 0;
            });
  add_loss(app, choice);
}

void add_calibration(CLI::App& app, CalibrationChoice& choice) {
  add_cost(app, choice);
  app.add_flag(
      "--mount", choice.mount,
      "the tracked frame's place and yaw on the robot are unknowns, too; judge them on other drives");
  add_model(app, choice);
}

void add_model(CLI::App& app, CalibrationChoice& choice) {
  add_value(app, "--model", "NAME,...",
            "nuisance parameters and richer models, docs/models.md: contact_offset, contact_offsets, "
            "steering_zeros, lever_arm, heading_offset, time_offset[=S][:speeds], start_pose, anchor, "
            "least_squares, ...; 'none' for those of the set [as the set has it]",
            [&choice](const std::string& text) {
              if (!choice.model) choice.model.emplace();
              if (text == "none") return;
              for (const std::string& name : comma_items(text)) choice.model->push_back(name);
              model_terms(*choice.model);
            });
}

void add_classical(CLI::App& app, ClassicalChoice& choice) {
  add_value(app, "--classical", "[=LIST]",
            "rows of classical calibrations beside the others: umbmark, jung_chung, censi, ...; 'all' for "
            "every one "
            "[those made for the robot's class]",
            [&choice](const std::string& text) {
              choice.wanted = true;
              // Without a value, and in configuration files.
              if (!text.empty() && text != "true" && text != "{}") choice.names.push_back(text);
            })
      ->expected(0, 1);
  add_value(app, "--side", "M", "side of the squares of classical methods, in m [a quarter of the path]",
            [&choice](const std::string& text) { choice.side = finite_number("--side", text, true); });
}

void add_budget(CLI::App& app, Budget& budget) {
  add_value(app, "--max-evals", "N",
            fmt::format("evaluations (costs and derivatives) of a run at most; 'none' lifts the limit [{}]",
                        kDefaultMaxEvaluations),
            [&budget](const std::string& text) {
              budget.max_evaluations = text == "none" ? 0 : whole_number("--max-evals", text, 1);
            });
  add_value(
      app, "--time-limit", "S", "seconds of a run at most [unlimited]",
      [&budget](const std::string& text) { budget.max_seconds = finite_number("--time-limit", text, true); });
  add_value(
      app, "--target", "J", "stop a run once its cost is at most this",
      [&budget](const std::string& text) { budget.target_cost = finite_number("--target", text, false); });
}

void add_format(CLI::App& app, std::string& format) {
  app.add_option("--format", format, "of the tables [console]")->type_name("console|md|csv|json|latex");
}

void add_json(CLI::App& app, bool& json) {
  app.add_flag("--json", json, "say on standard output, as JSON, what was written");
}

void add_study_folder(CLI::App& app, std::string& out, bool& overwrite) {
  app.add_option("--out", out, "folder for records (runs.jsonl) and tables.*")->type_name("DIR");
  app.add_flag("--overwrite", overwrite, "replace records that the folder holds");
}

void add_count(CLI::App& app, const std::string& name, int& value, int lowest, int highest,
               const std::string& help) {
  app.add_option_function<std::string>(
         name,
         [name, &value, lowest, highest](const std::string& text) {
           value = static_cast<int>(whole_number(name, text, lowest, highest));
         },
         help)
      ->type_name("N");
}

void add_seed(CLI::App& app, std::uint64_t& seed, const std::string& help) {
  add_value(app, "--seed", "N", help,
            [&seed](const std::string& text) { seed = seed_number("--seed", text); });
}

void add_threads(CLI::App& app, int& threads) {
  add_count(app, "--threads", threads, 1, 1024, "threads; results do not depend on them [one per core]");
}

void add_wait(CLI::App& app, int& seconds) {
  add_count(app, "--wait", seconds, 0, 1'000'000,
            "seconds to wait for another process that writes to the store [0]");
}

void add_run_folder(CLI::App& app, std::string& out, bool& overwrite) {
  app.add_option("--out", out, "folder for runs.jsonl (a line per run, as it ends) and tables.*")
      ->type_name("DIR");
  app.add_flag("--overwrite", overwrite, "replace the runs.jsonl of an earlier call in --out");
}

void add_noise_options(CLI::App& app, std::uint64_t& seed, int& threads) {
  add_seed(app, seed, "of the noise [1]");
  add_threads(app, threads);
}

CLI::Option* add_scenario(CLI::App& app, const std::string& name, std::string& scenario) {
  return app.add_option(name, scenario, "file or name; 'bench list scenarios' shows them")
      ->type_name("FILE|NAME");
}

CLI::Option* add_robot(CLI::App& app, std::string& robot) {
  return app
      .add_option(
          "--robot", robot,
          "instead of a scenario: a set.json, a robot alone as JSON, or a class, see 'bench list robots'")
      ->type_name("FILE|CLASS");
}

void require_one(const std::string& scenario, const std::string& robot) {
  if (scenario.empty() && robot.empty()) throw std::invalid_argument("--scenario or --robot is required");
  if (!scenario.empty() && !robot.empty())
    throw std::invalid_argument("--robot: contradictory options: a scenario has a robot of its own");
}

void apply_config(CLI::App& app, const std::string& config) {
  for (const ConfigEntry& entry : read_config(config)) {
    if (entry.key == "json")
      throw std::invalid_argument(
          fmt::format("{}: unknown key 'json', write format = \"json\"", entry.where));
    const bool no_key = entry.key == "config" || entry.key == "help" || entry.key == "version";
    CLI::Option* option = no_key ? nullptr : app.get_option_no_throw("--" + entry.key);
    if (option == nullptr)
      throw std::invalid_argument(fmt::format("{}: unknown key '{}'{}", entry.where, shown(entry.key),
                                              option_suggestion(app, entry.key)));
    if (option->count() > 0) continue;
    try {
      for (const std::string& value : entry.values) option->add_result(value);
      option->run_callback();
    } catch (const std::exception& error) {
      throw std::invalid_argument(fmt::format("{}: {}", entry.where, error.what()));
    }
  }
}

std::string option_suggestion(const CLI::App& app, const std::string& typed) {
  std::vector<std::string> names;
  for (const CLI::Option* option : app.get_options())
    for (const std::string& name : option->get_lnames()) names.push_back(name);
  const auto begin = std::min(typed.find_first_not_of('-'), typed.size());
  const std::string near = nearest_name(typed.substr(begin, typed.find('=') - begin), names);
  if (near.empty() || near == typed) return {};
  return fmt::format(", did you mean '{}{}'?", begin > 0 ? "--" : "", near);
}

}  // namespace odobench
