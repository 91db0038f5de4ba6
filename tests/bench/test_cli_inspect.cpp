// bench inspect, and what run and evaluate say of the sets that they take: the cases from the field, the real
// recordings, made-up faults.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>
#include <nlohmann/json.hpp>

#include "datasets/dataset.hpp"
#include "tests/support/faulty_sets.hpp"
#include "tests/support/run_process.hpp"
#include "tests/support/shared_data.hpp"

namespace odobench {
namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;
using testing::ProcessResult;
using testing::run_bench;
using testing::TemporaryFolder;

nlohmann::json table(const ProcessResult& result, const std::string& id) {
  const auto all = nlohmann::json::parse(result.out);
  for (const auto& t : all.at("tables"))
    if (t.at("id") == id) return t;
  ADD_FAILURE() << "no table " << id;
  return {};
}

std::vector<std::string> kinds_in(const ProcessResult& result) {
  std::vector<std::string> kinds;
  const auto findings = table(result, "findings");
  for (const auto& row : findings.at("rows")) kinds.push_back(row.at("kind"));
  return kinds;
}

// A set with this fault in its last size, as files.
std::string faulty(const TemporaryFolder& folder, const std::string& name) {
  Dataset d = testing::clean_set("4wis4wid", 5);
  for (const testing::Fault& fault : testing::faults())
    if (fault.name == name) fault.inject(d, fault.sizes.back());
  save_dataset(d, folder / "set.json");
  return (folder / "set.json").string();
}

struct FieldCase {
  std::string name;
  std::vector<std::string> kinds;
  int exit_code;
  std::string says;  // a part of the messages
};

class FieldCases : public ::testing::TestWithParam<FieldCase> {};

TEST_P(FieldCases, GetTheirRightOutcome) {
  ODOBENCH_NEEDS_SHARED();
  const FieldCase& c = GetParam();
  const std::string set = (testing::shared_folder() / "cases" / c.name / "set.json").string();
  const ProcessResult result = run_bench({"inspect", set, "--json"});
  EXPECT_EQ(result.exit_code, c.exit_code) << result.err;
  EXPECT_EQ(kinds_in(result), c.kinds);
  EXPECT_THAT(result.out, HasSubstr(c.says));
}

INSTANTIATE_TEST_SUITE_P(
    Every, FieldCases,
    ::testing::ValuesIn(std::vector<FieldCase>{
        {"all_bounds_equal", {}, 0, ""},
        {"capture_frozen_2s", {"capture_frozen"}, 0, "arc_ccw_1: the pose stands still from sample 49 to 89"},
        {"capture_in_room_frame", {"start_offset"}, 1, "5 of 5 drives start up to 1.8 m from the origin"},
        {"capture_late_48ms", {"reference_lag"}, 0, "the reference lags behind the wheels by 48 ms"},
        {"capture_millimetres", {"position_unit"}, 1, "millimetres (factor 1000)"},
        {"clock_jump_60s", {"clock_jump"}, 1, "line_x_1: 60.05 s between samples 59 and 60"},
        {"control_clean", {}, 0, ""},
        {"diameter_as_radius", {"common_factor"}, 1, "diameters entered as radii?"},
        {"encoder_overflow", {"encoder_overflow"}, 1, "arc_cw_1: wheel 4 speed 2011 rad/s at sample 70"},
        {"errors_larger_than_said", {}, 0, ""},
        {"heading_wrapped", {"heading_wrapped"}, 1, "spin_ccw_1: theta jumps by 2 pi at sample 90"},
        {"one_drive_of_fifteen_wrong",
         {"recording_unlike"},
         0,
         "arc_cw_2: wheels and reference disagree by 36 %"},
        {"one_drive_slips", {"recording_unlike", "wheel_slip"}, 0, "line_y_2: wheel 1 rolls +0.33 m/s off"},
        {"origin_on_rear_axle", {"layout_asymmetric"}, 0, "use the least-squares velocity"},
        {"pivot_5cm_off", {"tracked_point"}, 0, "displaced by (5.0, -0.1) cm"},
        {"robot_never_moved", {"never_moved"}, 1, "nor do the wheels: nothing can be calibrated"},
        {"steering_2_zero_3deg", {"steering_zero"}, 0, "-0.3, +2.7, +0.2, -0.2 deg"},
        {"steering_degrees", {"steering_degrees"}, 1, "steering angles look like degrees"},
        {"time_in_milliseconds", {"time_unit"}, 1, "the stamps look like milliseconds"},
        {"track_as_half_track", {"rotation_factor"}, 0, "while distances fit: half track"},
        {"wheel_2_reversed", {"wheel_reversed"}, 1, "wheel 2 rolls against the reference"},
        {"wheel_order_fl_fr_rl_rr", {"wheel_order"}, 1, "(FL, FR, RL, RR)"},
        {"wheel_speed_rpm", {"common_factor"}, 1, "revolutions per minute"}}),
    [](const auto& one) { return one.param.name; });

TEST(CliInspect, TheRealRecordingsHaveALagAndNothingElse) {
  ODOBENCH_NEEDS_SHARED();
  const TemporaryFolder folder;
  const std::string set = (folder / "set.json").string();
  const ProcessResult made =
      run_bench({"import", "vitko2024", "--out=" + set,
                 "--from=" + (testing::shared_folder() / "datasets/vitko2024").string()});
  ASSERT_EQ(made.exit_code, 0) << made.err;
  EXPECT_THAT(made.err, HasSubstr("reference_lag"));
  const ProcessResult result = run_bench({"inspect", set, "--json"});
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_THAT(kinds_in(result), ::testing::ElementsAre("reference_lag"));
  const auto figures = table(result, "figures");
  for (const auto& row : figures.at("rows"))
    if (row.at("figure") == "lag") {
      EXPECT_NEAR(row.at("value").get<double>(), -0.058, 0.003);
    }
}

TEST(CliInspect, TheDemoSetIsSilent) {
  const ProcessResult result = run_bench({"inspect", "--json"});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_THAT(kinds_in(result), IsEmpty());
  EXPECT_EQ(result.err, "");
}

TEST(CliInspect, WritesAMendedSetAndSaysWhatItChanged) {
  const TemporaryFolder folder;
  const std::string set = faulty(folder, "wheel_reversed"), mended = (folder / "mended.json").string();
  const ProcessResult result = run_bench({"inspect", set, "--fix", "--out=" + mended});
  EXPECT_EQ(result.exit_code, 1) << result.err;  // of the set that was looked at
  EXPECT_THAT(result.out, HasSubstr("Mended: wheel 2 rolls against the reference"));
  EXPECT_EQ(run_bench({"inspect", mended}).exit_code, 0);
  EXPECT_THAT(load_dataset(mended).notes.back(), HasSubstr("mended: wheel_reversed"));
  EXPECT_EQ(run_bench({"inspect", set, "--fix", "--out=" + mended}).exit_code, 2);  // it is there
  EXPECT_EQ(run_bench({"inspect", set, "--fix"}).exit_code, 2);
  EXPECT_EQ(run_bench({"inspect", (folder / "none.json").string()}).exit_code, 3);
}

TEST(CliInspect, RunRefusesWhatDecidesTheFitUnlessAccepted) {
  const TemporaryFolder folder;
  const std::string data = "--data=" + faulty(folder, "wheel_reversed");
  const ProcessResult refused = run_bench({"--solver=lm", data, "--out=" + (folder / "out").string()});
  EXPECT_EQ(refused.exit_code, 3);
  EXPECT_EQ(testing::lines(refused.err).size(), 1u) << refused.err;
  EXPECT_THAT(refused.err, HasSubstr("wheel_reversed: wheel 2 rolls against the reference"));
  EXPECT_THAT(refused.err, HasSubstr("--accept=wheel_reversed"));
  EXPECT_FALSE(std::filesystem::exists(folder / "out"));
  for (const char* accepted : {"--accept=gap,wheel_reversed", "--accept=all"}) {
    const ProcessResult result = run_bench({"--solver=lm", data, accepted, "--json"});
    EXPECT_EQ(result.exit_code, 0) << result.err;
    EXPECT_THAT(result.err, HasSubstr("warning: wheel_reversed: "));
    EXPECT_THAT(table(result, "found").at("notes").dump(), HasSubstr("wheel_reversed: wheel 2"));
  }
  EXPECT_EQ(run_bench({"--solver=lm", data, "--accept=gap"}).exit_code, 3);
  const ProcessResult wrong = run_bench({"--solver=lm", data, "--accept=wheel_reverse"});
  EXPECT_EQ(wrong.exit_code, 2);
  EXPECT_THAT(wrong.err, HasSubstr("did you mean 'wheel_reversed'"));
}

TEST(CliInspect, EvaluateSaysWhatRunRefuses) {
  const TemporaryFolder folder;
  const std::string data = "--data=" + faulty(folder, "wheel_reversed");
  const ProcessResult result = run_bench({"evaluate", data, "--out=" + (folder / "out").string()});
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_THAT(result.err, HasSubstr("wheel_reversed: wheel 2"));
  EXPECT_THAT(testing::content(folder / "out/runs.jsonl"), HasSubstr("wheel_reversed: wheel 2"));
}

TEST(CliInspect, AtMostSixLinesAndHowToSeeTheOthers) {
  const TemporaryFolder folder;
  Dataset d = testing::clean_set("4wis4wid", 5);
  for (std::size_t i = 0; i < 8; ++i) d.recordings[i].reference.y[d.recordings[i].size() / 2] += 1;
  save_dataset(d, folder / "set.json");
  const ProcessResult result = run_bench({"evaluate", "--data=" + (folder / "set.json").string()});
  EXPECT_EQ(testing::lines(result.err).size(), 7u) << result.err;
  EXPECT_THAT(result.err, HasSubstr("and 2 more: bench inspect "));
}

TEST(CliInspect, ABadFitIsSaidToBeOne) {
  const TemporaryFolder folder;
  Dataset d = testing::clean_set("4wis4wid", 5);
  Reference& reference = d.recordings[0].reference;
  // What no parameters explain.
  for (std::size_t k = 20; k < reference.x.size(); ++k) reference.y[k] += k % 2 == 0 ? 0.3 : -0.3;
  save_dataset(d, folder / "set.json");
  const std::string data = "--data=" + (folder / "set.json").string();
  const ProcessResult result = run_bench({"--solver=lm", data, "--screen=off", "--json"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_THAT(table(result, "found").at("notes").dump(),
              HasSubstr("the drive " + d.recordings[0].id + " makes "));
  const auto fit = table(result, "fit");
  EXPECT_EQ(fit.at("rows").size(), d.recordings.size() + 1);
  EXPECT_EQ(fit.at("rows").back().at("recording"), "all");
  const ProcessResult clean = run_bench({"--solver=lm", "--json"});
  EXPECT_THAT(table(clean, "found").at("notes").dump(), Not(HasSubstr("the drive ")));
  EXPECT_THAT(table(clean, "found").at("notes").dump(), Not(HasSubstr("sit on bounds")));
  EXPECT_THAT(table(clean, "found").at("notes").dump(), Not(HasSubstr("does not help")));
}

}  // namespace
}  // namespace odobench
