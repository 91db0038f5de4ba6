#include "bench/options/trust_options.hpp"

#include <fmt/format.h>

#include <stdexcept>
#include <utility>

#include "base/text.hpp"
#include "bench/options/common_options.hpp"

namespace odobench {

void add_validation(CLI::App& app, ValidationChoice& choice) {
  add_value(
      app, "--validate", "LIST",
      "errors on recordings that the fit has not seen: repetitions, trajectories, kfold:K; all: the first "
      "two by fits of each row's own solver; none [repetitions,trajectories where it takes little]",
      [&choice](const std::string& text) { choice = validation_choice(text); });
}

void add_bootstrap(CLI::App& app, TrustChoice& choice) {
  constexpr int kMostReplicates = 100000;
  add_count(app, "--bootstrap", choice.bootstrap, 0, kMostReplicates,
            "fits to sets of recordings drawn with replacement, of the lowest result; a call that was killed "
            "goes on with --out and --overwrite [0]");
  add_value(app, "--bootstrap-scheme", "stratified|plain",
            "draw within kinds of drives, or from all recordings [stratified]",
            [&choice](const std::string& text) {
              try {
                choice.scheme = resample_scheme(text);
              } catch (const std::invalid_argument& error) {
                throw std::invalid_argument(fmt::format("--bootstrap-scheme={}", error.what()));
              }
            });
}

void add_profile(CLI::App& app, TrustChoice& choice) {
  constexpr int kMostSteps = 1000;
  constexpr std::size_t kMostCombinations = 100;
  add_value(
      app, "--profile", "PARAM,...|all",
      "J along these parameters with all others fitted again, and the interval that it gives, of the "
      "lowest result",
      [&choice](const std::string& text) { choice.profile = profile_choice(text, choice.profile.steps); });
  add_count(app, "--profile-steps", choice.profile.steps, 2, kMostSteps,
            "fits on each side of the result [8]");
  app.add_option_function<std::vector<std::string>>(
         "--combination",
         [&choice, kMostCombinations](const std::vector<std::string>& texts) {
           for (const std::string& text : texts) {
             try {
               Formula formula = named_formula(text);
               for (const Formula& other : choice.combinations)
                 if (other.name == formula.name)
                   throw std::invalid_argument(fmt::format("'{}' is given twice", shown(formula.name)));
               choice.combinations.push_back(std::move(formula));
             } catch (const std::invalid_argument& error) {
               throw std::invalid_argument(fmt::format("--combination={}", error.what()));
             }
             if (choice.combinations.size() > kMostCombinations)
               throw std::invalid_argument(
                   fmt::format("--combination: expected at most {}", kMostCombinations));
           }
         },
         "a number of your own with its interval: [NAME=]FORMULA of parameters and of the numbers that the "
         "drives determine, e.g. \"(r1+r2)/2\"; may be given again")
      ->type_name("FORMULA")
      ->allow_extra_args(false);
}

}  // namespace odobench
