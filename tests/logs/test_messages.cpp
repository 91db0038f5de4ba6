// Messages of any type from their definition's text.
#include "datasets/logs/ros/messages/message_definition.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "datasets/logs/ros/messages/message_path.hpp"
#include "datasets/logs/ros/messages/message_reader.hpp"
#include "datasets/logs/ros/messages/message_survey.hpp"
#include "tests/support/data_error.hpp"
#include "tests/support/log_writers.hpp"

namespace odobench {
namespace {

using ::testing::ElementsAre;
using testing::MessageBytes;
using testing::refusal_of;
using testing::says;

std::shared_ptr<const RosTypes> types_of(const std::string& definition,
                                         RosEncoding encoding = RosEncoding::Cdr) {
  return std::make_shared<const RosTypes>(parse_message_definition("a/A", &definition, encoding, {}));
}
std::string bad_definition(const std::string& definition) {
  return refusal_of<BadDefinition>([&] { types_of(definition); });
}

// Values of the one row of a message.
std::vector<double> values(const std::string& definition, const std::string& message,
                           const std::vector<std::string>& paths, RosEncoding encoding = RosEncoding::Cdr) {
  MessageReader reader(types_of(definition, encoding), encoding, {paths, {}, ""});
  const RowReader::Rows rows = reader.read(message);
  EXPECT_EQ(rows.count, 1u);
  return rows.count == 1 ? rows.begin->numbers : std::vector<double>{};
}
std::string bad_message(const std::string& definition, const std::string& message,
                        RosEncoding encoding = RosEncoding::Cdr) {
  MessageReader reader(types_of(definition, encoding), encoding, {});
  return refusal_of<BadMessage>([&] { reader.read(message); });
}

const std::string kSection = "\n" + std::string(80, '=') + "\nMSG: ";

TEST(Messages, EveryPrimitiveInEveryEncoding) {
  const std::string definition =
      "bool b\nint8 i8\nuint8 u8\nint16 i16\nuint16 u16\nint32 i32\nuint32 u32\nint64 i64\nuint64 "
      "u64\nfloat32 f\n"
      "float64 d\nchar c\nbyte y\nstring s\nuint8 last\n";
  for (const RosEncoding encoding : {RosEncoding::Ros1, RosEncoding::Cdr})
    for (const bool big : {false, true}) {
      if (big && encoding == RosEncoding::Ros1) continue;
      MessageBytes m(encoding, big);
      m.number(true)
          .number(std::int8_t{-3})
          .number(std::uint8_t{200})
          .number(std::int16_t{-300})
          .number(std::uint16_t{60000});
      m.number(-70000)
          .number(4000000000u)
          .number(std::int64_t{-5000000000})
          .number(std::uint64_t{6000000000});
      m.number(1.5f)
          .number(-2.25)
          .number(std::uint8_t{255})
          .number(std::uint8_t{255})
          .text("text")
          .number(std::uint8_t{9});
      EXPECT_THAT(
          values(definition, m.bytes(),
                 {"b", "i8", "u8", "i16", "u16", "i32", "u32", "i64", "u64", "f", "d", "c", "y", "last"},
                 encoding),
          ElementsAre(1, -3, 200, -300, 60000, -70000, 4e9, -5e9, 6e9, 1.5, -2.25, 255,
                      encoding == RosEncoding::Ros1 ? -1 : 255, 9));
      EXPECT_THAT(values(definition, m.bytes(), {"last"}, encoding), ElementsAre(9));
      EXPECT_THAT(values(definition, m.bytes(), {}, encoding), ElementsAre());
    }
}

TEST(Messages, AlignmentDependsOnThePlace) {
  // Names of all lengths shift what follows; elements of 9 bytes begin at every place.
  const std::string definition = "string name\nfloat64 x\nuint8 n\nP[3] fixed\nuint8 k\nP[] many\nfloat64 y" +
                                 kSection + "a/P\nuint8 a\nfloat64 b\n";
  for (std::size_t length = 0; length < 9; ++length) {
    MessageBytes m(RosEncoding::Cdr);
    m.text(std::string(length, 'n')).number(0.5).number(std::uint8_t{1});
    for (int i = 0; i < 3; ++i) m.number(std::uint8_t{3}).number(i + 0.25);
    m.number(std::uint8_t{2}).count(length);
    for (std::size_t i = 0; i < length; ++i) m.number(std::uint8_t{4}).number(10.0 + static_cast<double>(i));
    m.number(7.0);
    EXPECT_THAT(values(definition, m.bytes(), {"x", "y", "fixed[2].b", "k"}), ElementsAre(0.5, 7, 2.25, 2));
    if (length > 1) {
      EXPECT_THAT(values(definition, m.bytes(), {"many[1].b", "y"}), ElementsAre(11, 7));
    }
  }
}

TEST(Messages, ElementsOfFixedSizeArePassedOverAtOnce) {
  const std::string definition = "uint8 first\nE[] e\nuint8 last" + kSection + "a/E\nuint16 a\nuint8 b\n";
  MessageBytes m(RosEncoding::Cdr);
  m.number(std::uint8_t{1}).count(1001);
  for (int i = 0; i < 1001; ++i) m.number(std::uint16_t{5}).number(std::uint8_t{6});
  m.number(std::uint8_t{8});
  EXPECT_THAT(values(definition, m.bytes(), {"last"}), ElementsAre(8));
  EXPECT_THAT(values(definition, m.bytes(), {"last", "e[1000].b"}), ElementsAre(8, 6));
}

TEST(Messages, NamesMayStandBehindTheirValues) {
  const std::string definition = "float32[] v\nstring[2] who\nint16[2] w\n";
  MessageBytes m(RosEncoding::Cdr);
  m.count(2).number(1.5f).number(2.5f).text("a").text("b").number(std::int16_t{7}).number(std::int16_t{8});
  EXPECT_THAT(values(definition, m.bytes(), {"v[who=b]", "w[who=a]", "v[0]", "v[who=c]"}),
              ElementsAre(2.5, 7, 1.5, ::testing::IsNan()));
}

TEST(Messages, EveryElementThatIsMeantIsARow) {
  const std::string definition =
      "int32 all\nE[] e\nint32 end" + kSection + "a/E\nfloat64 v\nuint16 id\nstring s\n";
  MessageBytes m(RosEncoding::Cdr);
  m.number(4)
      .count(3)
      .number(1.0)
      .number(std::uint16_t{5})
      .text("x")
      .number(2.0)
      .number(std::uint16_t{6})
      .text("y");
  m.number(3.0).number(std::uint16_t{5}).text("z").number(9);
  MessageReader reader(types_of(definition), RosEncoding::Cdr,
                       {{"all", "e[id=5].v", "end"}, {"e[id=5].s"}, "e[id=5].v"});
  const RowReader::Rows rows = reader.read(m.bytes());
  ASSERT_EQ(rows.count, 2u);
  EXPECT_THAT(rows.begin[0].numbers, ElementsAre(4, 1, 9));
  EXPECT_THAT(rows.begin[1].numbers, ElementsAre(4, 3, 9));
  EXPECT_EQ(rows.begin[1].text[0], "z");
  EXPECT_EQ(rows.begin[1].time_real, 3);
  // Two kinds of elements in one request: the first of each, in one row.
  EXPECT_THAT(values(definition, m.bytes(), {"e[id=5].v", "e[id=6].v", "e[s=z].v"}), ElementsAre(1, 2, 3));
}

TEST(Messages, EmptyOnesHaveAByteInCdrOnly) {
  const std::string definition = "Empty e\nuint8 x" + kSection + "a/Empty\n# nothing\n";
  EXPECT_THAT(
      values(definition,
             MessageBytes(RosEncoding::Cdr).number(std::uint8_t{0}).number(std::uint8_t{4}).bytes(), {"x"}),
      ElementsAre(4));
  EXPECT_THAT(values(definition, MessageBytes(RosEncoding::Ros1).number(std::uint8_t{4}).bytes(), {"x"},
                     RosEncoding::Ros1),
              ElementsAre(4));
}

TEST(Messages, DefinitionsAsPeopleWriteThem) {
  const std::string definition =
      "# a comment\r\nint32   A = 5\nstring S=with # no comment\nint8 x -3 # default\n\nfloat64[<=3]  list "
      "[1, 2]\nstring<=10 short\n"
      "string<=5[<=2] names\nbuiltin_interfaces/msg/Time when\nother_msgs/msg/B b" +
      kSection + "other_msgs/B\nC c\n" + kSection.substr(1) + "other_msgs/C\nint8 v\n";
  MessageBytes m(RosEncoding::Cdr);
  m.number(std::int8_t{-1}).numbers({4}).text("s").texts({"n"}).stamp(5'000'000'001).number(std::int8_t{6});
  EXPECT_THAT(values(definition, m.bytes(), {"x", "list[0]", "when", "b.c.v"}),
              ElementsAre(-1, 4, 5.000000001, 6));
}

TEST(Messages, DefinitionsWithLimits) {
  EXPECT_TRUE(says(bad_definition("a/A self"), {"type a/A contains itself"}));
  EXPECT_TRUE(says(bad_definition("B b" + kSection + "a/B\nA[] a"), {"type a/A contains itself"}));
  EXPECT_TRUE(says(bad_definition("B b"), {"no type B"}));
  EXPECT_TRUE(says(bad_definition("wstring w"), {"wstring"}));
  EXPECT_TRUE(says(bad_definition("int8 a\n---\nint8 b"), {"service"}));
  EXPECT_TRUE(says(bad_definition("int8"), {"expected a type and a name"}));
  EXPECT_TRUE(says(bad_definition("int8 a-b"), {"expected a name"}));
  EXPECT_TRUE(says(bad_definition("int8[x] a"), {"expected an array's length"}));
  EXPECT_TRUE(says(bad_definition("int8[99999999999999999999] a"), {"expected an array's length"}));
  EXPECT_TRUE(says(bad_definition(std::string(70000, '\n')), {"more than 65536 bytes"}));
  std::string many, deep = "T0 t";
  for (int i = 0; i < 2001; ++i) many += fmt::format("int8 f{}\n", i);
  EXPECT_TRUE(says(bad_definition(many), {"more than 2000 fields"}));
  for (int i = 0; i < 20; ++i) deep += kSection + fmt::format("a/T{}\nT{} t", i, i + 1);
  EXPECT_TRUE(says(bad_definition(deep), {"nested deeper than 16"}));
  // What was read before counts, too.
  std::string reused = "T9 t";
  for (int i = 9; i > 0; --i) reused += kSection + fmt::format("a/T{}\nT{} t", i, i - 1);
  reused += kSection + "a/T0\nint8 x";
  std::string longer = "T9 first\nU0 u" + reused.substr(4);
  for (int i = 0; i < 8; ++i)
    longer += kSection + fmt::format("a/U{}\n{} t", i, i < 7 ? fmt::format("U{}", i + 1) : "T9");
  EXPECT_EQ(bad_definition(reused), "");
  EXPECT_TRUE(says(bad_definition(longer), {"nested deeper than 16"}));
}

TEST(Messages, BombsInDefinitionsAreHarmless) {
  // 65535^3 elements of nothing and of something, and 100^16 empty messages.
  const std::string cube =
      "B[65535] b" + kSection + "a/B\nC[65535] c" + kSection + "a/C\nD[65535] d" + kSection + "a/D\n";
  EXPECT_THAT(values("uint8 x\n" + cube, std::string(1, '\5'), {"x"}, RosEncoding::Ros1), ElementsAre(5));
  EXPECT_TRUE(says(bad_message(cube + "uint8 x", std::string(100, '\0')), {"found 96 bytes", "expected"}));
  EXPECT_TRUE(says(bad_message(cube + "string s", std::string(100, '\0'), RosEncoding::Ros1),
                   {"found 0 bytes behind byte 100"}));
  std::string wide;
  for (int i = 0; i < 15; ++i) {
    if (i > 0) wide += kSection + fmt::format("a/T{}\n", i);
    for (int k = 0; k < 100; ++k) wide += fmt::format("T{} t{}\n", i + 1, k);
  }
  for (const char* last : {"uint8[] x", "string x", ""}) {
    const std::string definition = wide + kSection + "a/T15\n" + last;
    const auto types = types_of(definition, RosEncoding::Ros1);
    MessageReader reader(types, RosEncoding::Ros1, {});
    MessageSurvey survey(types, RosEncoding::Ros1);
    try {
      reader.read(std::string(1000, '\0'));
    } catch (const BadMessage&) {
    }
    EXPECT_THROW(survey.add(std::string(1000, '\0')), BadMessage);
    EXPECT_TRUE(says(testing::usage_error([&] {
                       MessageReader(types, RosEncoding::Ros1, {{"nope"}, {}, ""});
                     }),
                     {"no field 'nope'"}));
  }
}

TEST(Messages, BytesThatDoNotFitAreRefused) {
  const std::string definition = "string s\nfloat64[] v\nstring[] n\n";
  EXPECT_TRUE(says(bad_message(definition, ""), {"found 0 bytes, expected 4 of CDR"}));
  EXPECT_TRUE(says(bad_message(definition, MessageBytes(RosEncoding::Cdr).count(4000000000).bytes()),
                   {"expected 4000000000"}));
  EXPECT_TRUE(says(bad_message(definition, MessageBytes(RosEncoding::Cdr).text("").count(4000000000).bytes()),
                   {"expected"}));
  EXPECT_TRUE(says(
      bad_message(definition, MessageBytes(RosEncoding::Cdr).text("").count(0).count(4000000000).bytes()),
      {"elements"}));
  const std::string whole = MessageBytes(RosEncoding::Cdr).text("").count(0).count(0).bytes();
  EXPECT_EQ(bad_message(definition, whole + "\0\0\0"), "");
  EXPECT_TRUE(
      says(bad_message(definition, whole + std::string(4, '\0')), {"4 bytes are left behind its fields"}));
  EXPECT_TRUE(says(bad_message("int8 x", std::string("\0\2\0\0\1", 5)), {"encapsulation 00 02"}));
}

TEST(Messages, Xcdr2AlignsToFour) {
  MessageBytes m(RosEncoding::Cdr);
  m.number(1).number(std::uint32_t{0}).number(std::uint32_t{0x40000000});  // 2.0 at byte 4
  std::string bytes = m.bytes();
  bytes[1] = '\x07';
  EXPECT_THAT(values("int32 a\nfloat64 b", bytes, {"a", "b"}), ElementsAre(1, 2));
  MessageReader reader(types_of("int32 a\nstring[] b"), RosEncoding::Cdr, {});
  EXPECT_THROW(reader.read(bytes), BadDefinition);
}

TEST(Messages, PathsThatFitNothingAreRefused) {
  const std::string definition =
      "std_msgs/Header header\nstring[] name\nfloat64[] position\nE[] e\nstring s\n" + kSection.substr(1) +
      "a/E\nint8 v\nE2[] e" + kSection + "a/E2\nint8 w\n";
  const auto refusal = [&](const std::string& path, bool text = false) {
    const std::vector<std::string> one{path};
    return testing::usage_error([&] {
      MessageReader(types_of(definition), RosEncoding::Cdr,
                    text ? MessageRequest{{}, one, ""} : MessageRequest{one, {}, ""});
    });
  };
  EXPECT_TRUE(says(refusal("positon[0]"),
                   {"no field 'positon[0]' in a/A, did you mean 'position[0]'? it has header.stamp, "}));
  EXPECT_TRUE(says(refusal("header.stmp"), {"no field 'header.stmp'", "did you mean 'header.stamp'?"}));
  EXPECT_TRUE(says(refusal("position"), {"'position' is an array"}));
  EXPECT_TRUE(says(refusal("header[0]"), {"'header' is no array"}));
  EXPECT_TRUE(says(refusal("header"), {"it is a message with stamp, frame_id"}));
  EXPECT_TRUE(says(refusal("position[who=a]"), {"'who' is no array of names beside it"}));
  EXPECT_TRUE(says(refusal("s"), {"it is text, expected a number"}));
  EXPECT_TRUE(says(refusal("position[0]", true), {"it is a float64, expected text"}));
  EXPECT_TRUE(says(refusal("s.x"), {"'s' has no fields"}));
  EXPECT_TRUE(says(refusal("e[v=1]"), {"expected a field"}));
  EXPECT_TRUE(says(refusal("e[v=1].e[w=2].w"), {"inside of selected elements"}));
  for (const char* path : {"", ".", "a..b", "e[", "e[]", "e[x", "e[=3].v", "a."})
    EXPECT_TRUE(says(refusal(path), {"field '"})) << path;
}

TEST(Messages, NamesMayHaveBracketsAndCommas) {
  const auto steps = parse_message_path("v[name=wheel[0],left].x");
  ASSERT_EQ(steps.size(), 2u);
  ASSERT_EQ(steps[0].selectors.size(), 1u);
  EXPECT_EQ(steps[0].selectors[0].value, "wheel[0],left");
  EXPECT_EQ(path_step_text(steps[0]), "v[name=wheel[0],left]");
}

TEST(Messages, SizesRepeat) {
  // Three bytes of which the first two are aligned to two, against counting one by one.
  SizeByPlace size;
  for (std::uint64_t o = 0; o < 8; ++o) size[o] = o % 2 + 3;
  for (std::uint64_t place = 0; place < 8; ++place) {
    std::uint64_t one_by_one = 0;
    for (std::uint64_t n = 0; n < 200; ++n) {
      EXPECT_EQ(repeated_size(size, place, n), one_by_one);
      one_by_one += size[(place + one_by_one) % 8];
    }
  }
  EXPECT_EQ(repeated_size(size, 0, 0xFFFFFFFF), std::uint64_t{0xFFFFFFFF} * 4 - 1);
  EXPECT_EQ(
      repeated_size({kHugeSize, kHugeSize, kHugeSize, kHugeSize, kHugeSize, kHugeSize, kHugeSize, kHugeSize},
                    0, 0xFFFFFFFF),
      kHugeSize);
}

}  // namespace
}  // namespace odobench
