#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "reports/figures/vega.hpp"
#include "reports/page/method_colours.hpp"

namespace odobench {
namespace {

using nlohmann::json;
using ::testing::ElementsAre;

Figure figure(const std::vector<std::string>& domain) {
  return {"f", "f", "", {{"layer", {{{"encoding", {{"color", vega::line_color("label", domain)}}}}}}}};
}

json color(const Document& document, std::size_t k) {
  return std::get<Figure>(document.sections[0].blocks[k]).spec["layer"][0]["encoding"]["color"];
}

std::size_t place(const json& channel, const std::string& name) {
  const std::vector<std::string> domain = channel["scale"]["domain"];
  return static_cast<std::size_t>(std::find(domain.begin(), domain.end(), name) - domain.begin()) % 9;
}

TEST(MethodColours, AMethodHasOnePlaceInThePaletteOfAllFigures) {
  Document document;
  document.sections.push_back({"s", "s", "", {}});
  document.sections[0].blocks = {figure({"nominal", "lm", "pso"}), figure({"pso"}),
                                 figure({"lm", "motion capture"}), figure({"camera", "gyro"})};
  share_method_colours(document, {"nominal", "lm", "ip", "pso"});
  EXPECT_EQ(place(color(document, 0), "pso"), 2u);
  EXPECT_EQ(place(color(document, 1), "pso"), 2u);
  EXPECT_EQ(place(color(document, 0), "nominal"), 7u);
  EXPECT_EQ(place(color(document, 2), "motion capture"), 8u);
  const std::vector<std::string> shown = color(document, 1)["legend"]["values"];
  EXPECT_THAT(shown, ElementsAre("pso"));
  const std::vector<std::string> other = color(document, 3)["scale"]["domain"];
  EXPECT_THAT(other, ElementsAre("camera", "gyro")) << "no methods: theirs alone";
}

TEST(MethodColours, TheEighthMethodBeginsAnewWithoutTheGreyOne) {
  std::vector<std::string> labels;
  for (int k = 0; k < 16; ++k) labels.push_back("m" + std::to_string(k));
  Document document;
  document.sections.push_back({"s", "s", "", {figure(labels)}});
  share_method_colours(document, labels);
  for (std::size_t k = 0; k < labels.size(); ++k)
    EXPECT_EQ(place(color(document, 0), labels[k]), k % kMethodColours) << k;
}

}  // namespace
}  // namespace odobench
