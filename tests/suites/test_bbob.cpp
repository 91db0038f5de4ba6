// BBOB's functions against the numbers of an independent program in 40 digits and those of the COCO
// platform, and how their options are written.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "bench/catalogue/catalogue.hpp"
#include "problems/suites/bbob.hpp"
#include "problems/suites/bbob_functions.hpp"
#include "solvers/certificate/derivative_check.hpp"
#include "solvers/solve.hpp"

namespace odobench {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::SizeIs;

const Catalogue& catalogue() {
  static const Catalogue& known = []() -> const Catalogue& {
    static Catalogue all;
    add_known(all);
    return all;
  }();
  return known;
}

// What std::invalid_argument says, "" where nothing is refused.
template <class Act>
std::string refusal(const Act& act) {
  try {
    act();
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "";
}

std::string name_of(int function) {
  return fmt::format("bbob:f{}", function);
}

// A point of the box, another for every function.
Vector point(int function, int n) {
  Vector x(n);
  for (int k = 0; k < n; ++k) x[k] = ((7 * k + 3 * function) % 17 - 8) * 0.5 + 0.123;
  return x;
}

struct Reference {
  int function, n, instance;
  double value;
};

// python, mpmath with mp.dps = 40: generator in integers, rotations, maps and functions from the report's
// formulas at point(), rounded to 20 digits.
constexpr Reference kReferences[] = {{1, 5, 3, -184.39457387999999805},  {2, 5, 3, 864458.2704320345128},
                                     {3, 5, 3, 244.49563605994632615},   {4, 5, 3, 431.90455470155714539},
                                     {5, 5, 3, 204.82623626119418001},   {6, 5, 3, 13725.760656658948134},
                                     {7, 5, 3, 2685.379884890391024},    {8, 5, 3, 173212.97573177372759},
                                     {9, 5, 3, 18983.285184262381163},   {10, 5, 3, 13685935.775225528205},
                                     {11, 5, 3, 28144733.828250967328},  {12, 5, 3, 407419030.02966167672},
                                     {13, 5, 3, 2357.949134935403253},   {14, 5, 3, 90.255798761876252101},
                                     {15, 5, 3, 242.41564011484829818},  {16, 5, 3, 165.32114499760017328},
                                     {17, 5, 3, 317.54718103975027412},  {18, 5, 3, 315.00069067467864723},
                                     {19, 5, 3, 241.07989901250672058},  {20, 5, 3, 34527.820155784590038},
                                     {21, 5, 3, -300.74372756976531287}, {22, 5, 3, 24.651499867438093081},
                                     {23, 5, 3, -97.482845033493594468}, {24, 5, 3, 159.41080075684089936},
                                     {1, 2, 7, -993.90805496000000102},  {2, 2, 7, 21442983.495819839873},
                                     {3, 2, 7, 2877.4765347010617216},   {4, 2, 7, 333.83534319969649384},
                                     {5, 2, 7, -56.676999999999999797},  {6, 2, 7, 61948.681532673725893},
                                     {7, 2, 7, -62.7082889962669587},    {8, 2, 7, 1345.3900458824603362},
                                     {9, 2, 7, 10575.380477246193062},   {10, 2, 7, 5876524.638697279078},
                                     {11, 2, 7, 2308660.7732336246451},  {12, 2, 7, 29206024.808652231707},
                                     {13, 2, 7, 478.97303429950545812},  {14, 2, 7, -105.80005817730488295},
                                     {15, 2, 7, 1344.3509517039230357},  {16, 2, 7, -47.755298823143469438},
                                     {17, 2, 7, 148.60544141363686222},  {18, 2, 7, 134.10370634354031032},
                                     {19, 2, 7, 46.027033212080082843},  {20, 2, 7, 5948.643265793516375},
                                     {21, 2, 7, 131.55453192368368236},  {22, 2, 7, 155.87984589336923484},
                                     {23, 2, 7, -917.1579587871607819},  {24, 2, 7, -259.07008398050798294}};

TEST(Bbob, AgreesWithFortyDigits) {
  for (const Reference& r : kReferences) {
    const Problem problem = make_bbob_problem(name_of(r.function), r.n, r.instance);
    EXPECT_NEAR(problem.cost(point(r.function, r.n)) / r.value, 1, 2e-12) << problem.name() << " n = " << r.n;
  }
}

struct CocoValue {
  int function, instance;
  std::vector<double> x;
  double value;
};

// Of the platform's own regression data (numbbo/coco, code-experiments/test/regression-test/data,
// regression_test_2data_for_suite_bbob.py), those of instances 1 to 5 in its first pages; f8 is not among
// them. Points outside the box see the penalties.
TEST(Bbob, InstancesAreThoseOfCoco) {
  const std::vector<CocoValue> values{
      {1,
       1,
       {13.382317228473649, 10.13915864997532, -12.670622241727648, 21.616498180472121, 47.318782398113612},
       3409.8428938036641},
      {2,
       4,
       {-0.062879390165237095, -1.7783300315498827, -2.2367347879177029, 3.6214790063499538,
        -2.7120790689257612},
       1159373.9058300618},
      {3, 5, {0.85456301226369891, 0.23428555905143855}, 200.31670460007004},
      {3, 5, {-0.13836312584565544, -0.0062699120128144915, 0.30241968560881705}, 277.44938441488182},
      {3,
       5,
       {-3.935925244121302, 0.69265347381153974, 2.2202776942786882, 0.51633141218739387, 1.9092298603252029},
       901.99087633734507},
      {3,
       1,
       {0.3880986175959239, -1.0102090325630915, -0.037114701772910812, -0.054617866780047035,
        -0.42790314432297455},
       -293.72170457240748},
      {4,
       1,
       {-0.27274711930265672, -1.7323072286189416, -0.59051812044358831, 1.1513995553020884,
        0.039743062782827375, 1.9399764817648582, -1.0691844497400784, 2.342911487711183, 1.231824268399095,
        0.89427272062847618},
       -166.09388640027845},
      {5, 5, {0.13575375752784852, -0.18542552177416743, -0.20005936334009852}, 35.812595161846545},
      {6,
       3,
       {-13.970673659422706, -1.0206948487510619, 3.6770626809236622, -4.1208665865535909,
        -1.6407017247730142},
       32263.786884340625},
      {7, 3, {-0.15589564659987321, -1.0591918840804744}, 1136.0032451796758},
      {7,
       1,
       {0.07127896933514466, 0.069338680590770724, -0.24502386531612247, -0.10644094505932154,
        -0.0028361810880690869, -0.1177946802769979, 0.019156043745721999, -0.077308988685629867,
        -0.16250002729183, 0.054619761400912223},
       850.09425447190688},
      {9, 4, {-0.1312288906422803, 0.30606056563875489}, -90.099326082029492},
      {9, 4, {-0.89222203091800611, 3.4349868793399665, 1.271336000123148}, 12659.365274499965},
      {10, 3, {0.21128720030087789, 2.1260343430227158, -1.6946222457322055}, 6370665.3429419538},
      {11, 4, {1.9361136676810644, -1.5014043871608866}, 20918782.066791113},
      {11,
       4,
       {-0.5440304062592517, -0.66581036479101141, -0.19209640780203416, 0.57562982055464307,
        -0.40543081397694386},
       812189.02268257306},
      {12, 3, {-0.95544321164350832, 1.3711789569529362}, 401501186.44412392},
      {12, 2, {-0.010677645622718232, -0.035406508907044359, 0.045672484833287147}, 54445154.770492151},
      {13, 4, {-0.48527734685953461, 0.14582002833024926}, 1158.4171691629858},
      {13, 2, {0.20550759110750233, 0.16814545132798861}, 36.28797457861652},
      {14, 4, {-0.29748149218593301, -0.60194396702417319}, 45.572363184703732},
      {14,
       3,
       {0.06720362243865885, -0.72676370601228213, 1.558085877942013, 0.15076227086943253, 1.9101074499015021,
        -1.7326189045889875, 0.56252757175730106, 0.12599417173904215, -2.63321737903606,
        0.59281394873295201},
       112.13340304247183},
      {15, 4, {0.86338349350750954, 0.27026661394997964}, 304.54113867225078},
      {15, 4, {0.16910123313217323, 0.37681326152768796, -0.020489763470826899}, 437.73848529647807},
      {16,
       1,
       {4.4902050543853571, 7.5047932738821164, -3.5555615146332227, -4.3292029801932195, 1.8467130069479889,
        -3.8299962019875129, 2.2002880747616422, -3.4871378643186968, 4.3150367713006501, 3.79228151118381},
       181.87051648429971},
      {17, 4, {0.32598204350746929, -0.12240041586110581}, 64.360558825508548},
      {17, 2, {-0.78416573291133829, 0.9842306542390149, 1.4004376633019893}, 33.942314618832462},
      {18, 5, {0.17796471006581557, 0.03186263898305107}, -72.176649475003245},
      {18, 1, {0.0090382986014505735, 0.30236885032987804, -1.2088300912574275}, 96.111343882177493},
      {19,
       2,
       {1.5657791034241229, 0.10930405165583502, 0.37863861929176051, -5.144732009363806, 3.6120114690235079,
        -6.4636391405477553, 10.672361818228318, -3.639874498721396, 2.2581396494056474, 6.5424864117997759},
       409.93314374036737},
      {20,
       2,
       {-0.69127749997669652, -0.56591016643921599, -0.080367653175301729, 0.75868423733721357,
        0.1638342590846566,   -1.033338423740318,   0.5324494466764933,    -0.82130221919336088,
        -0.19966965160482109, 1.152944434138311,    -0.39573401983247564,  0.044532076654574052,
        0.62536256136244084,  -0.14420095297190558, -0.10099017158760994,  -0.24249357465444543,
        0.54745037675171004,  0.23022063687804978,  -0.23137608465317502,  -0.28783733894939817},
       28325.940228866988},
      {21, 2, {-0.0060400531773042799, 0.18134741311175115, 0.063260617424276924}, 12.918395773565544},
      {21,
       1,
       {3.6472217223054555, -3.9785310018064211, -3.7791315682464774, -9.2294643938015017,
        1.7179725043474665},
       142.31188369733121},
      {22,
       3,
       {5.6077603274018095,   0.1298922706070563,   5.0393688934929548,  2.3419941337700219,
        6.225508878811028,    1.5080570290612083,   -3.4348929580212957, -1.2149985882136869,
        -0.14548203834493695, -0.91394807940131351, 2.9277188600043709,  4.7699615791902659,
        -4.9061257604290702,  1.4176615165200794,   -8.3663263104662953, 6.0505586276815615,
        -0.6790909413348285,  -4.0068494269730586,  -3.4227340871740775, 2.2100461885925711},
       51.739967465463415},
      {23, 3, {0.094812294860924226, 0.33238069179051011}, -104.73656135785458},
      {23,
       4,
       {0.054664465076689969, 0.0038247183269724473, 0.0050028076042338086, -0.01160979023506252,
        0.24351156140149319},
       -210.07597929189794},
      {24, 2, {-29.374959365636979, -12.309192201539119, -44.054881355911938}, 21731895.747123357},
      {24, 5, {0.080430009282935061, 0.027208833865365444, 0.16435769277051079}, -100.79829762363747}};
  for (const CocoValue& v : values) {
    const Problem problem = make_bbob_problem(name_of(v.function), static_cast<int>(v.x.size()), v.instance);
    const Vector x = Eigen::Map<const Vector>(v.x.data(), static_cast<Eigen::Index>(v.x.size()));
    EXPECT_NEAR(problem.cost(x) / v.value, 1, 1e-11) << problem.name() << " instance " << v.instance;
  }
}

TEST(Bbob, OptimumIsExactAndInTheBox) {
  for (int k = 1; k <= kBbobFunctions; ++k)
    for (const int n : {2, 3, 10, 40})
      for (const int instance : {1, 2, 99}) {
        const Problem problem = make_bbob_problem(name_of(k), n, instance);
        const Vector best = *problem.known_minimiser();
        EXPECT_LE(best.cwiseAbs().maxCoeff(), 5) << problem.name();
        EXPECT_NEAR(problem.cost(best), *problem.known_optimum(), 1e-12) << problem.name() << " n = " << n;
        EXPECT_TRUE(reaches_known_optimum(problem, best, problem.cost(best)));
        // Nothing near it is lower; a centimetre away nearly everything is higher.
        for (int i = 0; i < n; ++i) {
          Vector beside = best;
          beside[i] += best[i] > 0 ? -0.01 : 0.01;
          EXPECT_GE(problem.cost(beside), *problem.known_optimum() - 1e-12) << problem.name();
        }
      }
}

TEST(Bbob, SolvedMeansTheTargetOfCoco) {
  const Problem problem = make_bbob_problem("bbob:f1", 5, 1);
  const double best = *problem.known_optimum();
  EXPECT_TRUE(reaches_known_optimum(problem, *problem.known_minimiser(), best + 0.9e-8));
  EXPECT_FALSE(reaches_known_optimum(problem, *problem.known_minimiser(), best + 1.1e-8));
}

TEST(Bbob, GradientsAgreeWithDifferences) {
  int checked = 0, undecided = 0;  // a small component beside a large cost
  for (int k = 1; k <= kBbobFunctions; ++k) {
    const Problem problem = make_bbob_problem(name_of(k), 5, 2);
    EXPECT_EQ(problem.has_gradient(), BbobInstance::has_gradient(k));
    for (const int shift : {0, 1}) {
      const Vector x = point(k + shift, 5);
      for (const DerivativeComparison& c : compare_derivatives(problem, x)) {
        EXPECT_TRUE(c.agrees()) << problem.name() << " " << c.parameter << ": " << c.stated << ", "
                                << c.differenced;
        if (c.undecided()) ++undecided;
        ++checked;
      }
      if (!problem.has_gradient()) continue;
      Vector g(5);
      EXPECT_DOUBLE_EQ(problem.cost_and_gradient(x, g), problem.cost(x));
    }
    if (!problem.has_gradient() || k == 5) continue;  // f5 slopes at its corner
    Vector g(5);
    problem.cost_and_gradient(*problem.known_minimiser(), g);
    EXPECT_LE(g.cwiseAbs().maxCoeff(), 1e-9) << problem.name();
  }
  EXPECT_EQ(checked, 12 * 2 * 5);
  EXPECT_LE(undecided, 3);
}

TEST(Bbob, RefusesWhatThereIsNot) {
  EXPECT_THROW(make_bbob_problem("bbob:f25", 5, 1), std::invalid_argument);
  EXPECT_THROW(make_bbob_problem("bbob:f1", 5, 0), std::invalid_argument);
  EXPECT_THROW(make_bbob_problem("bbob:f1", 1, 1), std::invalid_argument);
}

TEST(Bbob, OptionsInNames) {
  const auto name = [](const std::string& text) { return catalogue().problem(text).make({}).name(); };
  EXPECT_EQ(name("bbob:f1"), "bbob:f1");
  EXPECT_EQ(name("bbob:f1[n=10,instance=1]"), "bbob:f1");  // the usual ones
  EXPECT_EQ(name("bbob:f1[instance=3,n=5]"), "bbob:f1[n=5,instance=3]");
  EXPECT_EQ(name("rosenbrock[n=5]"), "rosenbrock[n=5]");
  const Problem five = catalogue().problem("bbob:f2[n=5,instance=3]").make({}).problem;
  EXPECT_EQ(five.dimension(), 5);
  EXPECT_EQ(five.known_optimum(), make_bbob_problem("bbob:f2", 5, 3).known_optimum());
  ProblemRequest request;
  request.dimension = 3;
  EXPECT_EQ(catalogue().problem("bbob:f2[instance=2]").make(request).name(), "bbob:f2[n=3,instance=2]");
  EXPECT_EQ(catalogue().problem("bbob:f2[n=5]").make(request).problem.dimension(), 5);
}

TEST(Bbob, PatternsWithOptions) {
  std::vector<std::string> notes;
  const auto names = [&](const std::string& text, int dimension = 0) {
    return resolve_problems(catalogue(), {text}, dimension, notes);
  };
  EXPECT_THAT(names("bbob:*[n=5,instance=1..3]"), SizeIs(3 * kBbobFunctions));
  EXPECT_THAT(names("bbob:f1[instance=2..3],sphere"),
              ElementsAre("bbob:f1[instance=2]", "bbob:f1[instance=3]", "sphere"));
  EXPECT_THAT(names("mgh:*[!0]"), SizeIs(35));  // the bracket of a pattern
  EXPECT_TRUE(notes.empty());
  EXPECT_THAT(names("*e*[instance=2]"), ::testing::Contains("robots:mecanum[instance=2]"));
  EXPECT_THAT(notes, ElementsAre(HasSubstr("do not take these options and are left out")));
}

TEST(Bbob, BadOptionsAreRefused) {
  std::vector<std::string> notes;
  const auto said = [&](const std::string& text) {
    return refusal([&] { resolve_problems(catalogue(), {text}, 0, notes); });
  };
  EXPECT_EQ(said("bbob:f1[m=5]"),
            "--problem: 'bbob:f1[m=5]': unknown option 'm', did you mean 'n'?, expected n or instance");
  EXPECT_THAT(said("bbob:f1[n=1]"), HasSubstr("dimension 1; expected 2..40"));
  EXPECT_THAT(said("bbob:f1[n=5,n=6]"), HasSubstr("n is given twice"));
  EXPECT_THAT(said("bbob:f1[n=5,6]"), HasSubstr("found '6', expected option=value"));
  EXPECT_THAT(said("bbob:f1[instance=0]"), HasSubstr("expected a whole number in 1.."));
  EXPECT_THAT(said("bbob:f1[instance=5..2]"), HasSubstr("expected the lower number first"));
  EXPECT_THAT(said("bbob:f1[instance=1001]"), HasSubstr("expected one instance in 1..1000"));
  EXPECT_THAT(said("sphere[instance=2]"), HasSubstr("has no numbered instances"));
  EXPECT_THAT(said("calibration[n=5]"), HasSubstr("takes no options here"));
  EXPECT_THAT(said("bbob:f1[n=5"), HasSubstr("no problem is called"));
  EXPECT_THAT(said("bbob:f0[n=5]"), HasSubstr("unknown problem 'bbob:f0'"));
}

// The sphere to COCO's last target, by every method that can work on it; two that sample the whole box by
// design get to 1e-4 only.
TEST(Bbob, EverySolverSolvesTheSphere) {
  const Problem problem = make_bbob_problem("bbob:f1", 3, 1);
  int ran = 0;
  for (const SolverEntry& entry : solver_registry()) {
    if (!entry.make({}, nullptr)->why_not(problem).empty()) continue;
    SolveOptions options;
    options.budget.max_evaluations = 30000;
    options.budget.target_cost = *problem.known_optimum() + kBbobPrecision;
    options.seed = 7;
    const Result result = solve(problem, {entry.name, {}}, problem.start(), options);
    const bool coarse = entry.name == "nlopt:esch" || entry.name == "nlopt:ags";
    EXPECT_LE(result.cost - *problem.known_optimum(), coarse ? 1e-4 : kBbobPrecision) << result.brief();
    ++ran;
  }
  EXPECT_GE(ran, 20);
}

}  // namespace
}  // namespace odobench
