// JSON with errors that say where (base/json_node.hpp).
#include "base/json_node.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "tests/support/data_error.hpp"

namespace odobench {
namespace {

using testing::data_error;
using testing::says;

std::string parsing(const std::string& text, std::size_t line = 1) {
  return data_error([&] { parse_json(text, "f", line); });
}

template <class Action>
std::string refusal(const std::string& text, Action action) {
  return data_error([&] { action(JsonNode::parse(text, "f")); });
}

TEST(ParseJson, NamesTheLineOfBrokenText) {
  EXPECT_EQ(nlohmann::json(parse_json("{\"a\": [1, true, null, \"x\"]}", "f")).dump(),
            "{\"a\":[1,true,null,\"x\"]}");
  EXPECT_TRUE(says(parsing(""), {"f:1: broken JSON: syntax error", "unexpected end of input"}));
  EXPECT_TRUE(says(parsing("x"), {"f:1: broken JSON: syntax error"}));
  EXPECT_TRUE(says(parsing("\n\nx"), {"f:3: broken JSON: syntax error"}));
  EXPECT_TRUE(says(parsing("{\"a\": 1,\n\"b\" 2}"), {"f:2: broken JSON: ", "expected ':'"}));
  EXPECT_TRUE(says(parsing("[\"ab\ncd\"]"), {"f:1: broken JSON: "}));  // the break itself is the fault
  EXPECT_TRUE(says(parsing("[1,\n2", 40), {"f:41: broken JSON: "}));
  EXPECT_TRUE(says(parsing("[1] 2"), {"f:1: broken JSON: "}));
}

TEST(ParseJson, NamesThePlaceOfWhatIsNoNumber) {
  const std::string what = " expected a finite number";
  EXPECT_EQ(parsing("NaN"), "f:1: /: found NaN," + what);
  EXPECT_EQ(parsing("{\"a\":\n[1,\nNaN, 2]}"), "f:3: /a/1: found NaN," + what);
  EXPECT_EQ(parsing("{\"a\": {\"b\": -Infinity}}", 7), "f:7: /a/b: found -Infinity," + what);
  EXPECT_EQ(parsing("[+inf]"), "f:1: /0: found +inf," + what);
  for (const char* text : {"[Nanny]", "[anNaN]", "[Na]", "[nan-]"})
    EXPECT_TRUE(says(parsing(text), {"f:1: broken JSON: "})) << text;
}

TEST(ParseJson, ElementsAreNamedByTheirIds) {
  const auto place = [](const std::string& text) {
    const std::string message = parsing(text);
    return message.substr(5, message.find(": found") - 5);
  };
  EXPECT_EQ(place(R"({"w": [{"id": "p0"}, {"id": "p1", "ax": [1, 2, NaN]}]})"), "/w/1 (p1)/ax/2");
  EXPECT_EQ(place(R"({"w": [{"name": "p0", "ax": NaN}]})"), "/w/0 (p0)/ax");
  EXPECT_EQ(place(R"({"w": [{"name": "p0", "x": "y", "ax": NaN}]})"), "/w/0 (p0)/ax");
  EXPECT_EQ(place(R"({"w": [{"label": "p0", "ax": NaN}]})"), "/w/0/ax");
  EXPECT_EQ(place(R"({"w": [{"id": ["p0", "p1"], "ax": NaN}]})"), "/w/0/ax");
  EXPECT_EQ(place(R"({"id": "root", "w": [[0, 1], [2, NaN]]})"), "/w/1/1");
}

TEST(ParseJson, NamesTheLineOfANumberThatIsTooLarge) {
  const auto found = [](const std::string& place) {
    return place + ": found 1e999, expected a number within the range of a double";
  };
  EXPECT_EQ(parsing("1e999"), found("f:1: /"));
  EXPECT_EQ(parsing("\n[1,\n1e999]"), found("f:3: /1"));
  EXPECT_EQ(parsing("[1,\n1e999]", 10), found("f:11: /1"));
  // The same digits before, in texts and at the end of another number.
  EXPECT_EQ(parsing("{\"1e999\": \"1e999\",\n\"b\": 1e999}"), found("f:2: /b"));
  EXPECT_EQ(parsing("{\"a\\\"1e999\": \"\\\\\",\n\"b\": 1e999}"), found("f:2: /b"));
  EXPECT_EQ(parsing("[0." + std::string(700, '0') + "1e999,\n1e999]"), found("f:2: /1"));
  EXPECT_EQ(parsing("[\n-1e999]"), "f:2: /0: found -1e999, expected a number within the range of a double");
}

TEST(ParseJson, RefusesAKeyTwice) {
  const std::string twice = " found the key \"a\" twice in one object, expected once";
  EXPECT_EQ(parsing("{\"a\": 1, \"b\": {\"a\": 2}, \"a\": 3}"), "f:1: /a:" + twice);
  EXPECT_EQ(parsing("{\"a\": 1,\n\"b\": {\"a\":\n2},\n\"a\": 3,\n\"c\": 1}", 10), "f:13: /a:" + twice);
  // Texts that look like keys, braces and quotes in texts, keys in other objects.
  EXPECT_EQ(parsing("[\"a\",\n\"{\\\"a\\\":\",\n{\"b\": \"a\", \"c\": [\"a\", {\"a\": []}, \"a\"],\n\"a\": "
                    "1,\n\"a\": 2}]"),
            "f:5: /2/a:" + twice);
  EXPECT_EQ(parsing("{\"a\": 1,\n\"a\""), "f:2: /a:" + twice);
  EXPECT_EQ(parsing(R"({"\u001b[2J": {"a": 1, "a": 2}})"), "f:1: /\\x1b[2J/a:" + twice);
  EXPECT_EQ(parsing("[{\"a\": 1}, {\"a\": 2}]"), "");
}

TEST(JsonNode, MembersAndElements) {
  const JsonNode root =
      JsonNode::parse(R"({"b": [1, 2.5, -3], "a": {"t": "text", "yes": true, "no": false}})", "f");
  EXPECT_EQ(root.keys(), (std::vector<std::string>{"a", "b"}));
  EXPECT_TRUE(root.has("a"));
  EXPECT_FALSE(root.has("t"));
  EXPECT_FALSE(root.at("b").has("a"));
  EXPECT_EQ(root.at("a").at("t").text(), "text");
  EXPECT_EQ(root.at("a").at("t").path(), "/a/t");
  EXPECT_EQ(root.at("a").text_or_empty("t"), "text");
  EXPECT_EQ(root.at("a").text_or_empty("u"), "");
  EXPECT_TRUE(root.at("a").at("yes").boolean());
  EXPECT_FALSE(root.at("a").at("no").boolean());
  EXPECT_EQ(root.at("b").numbers(), (std::vector<double>{1, 2.5, -3}));
  ASSERT_EQ(root.at("b").elements().size(), 3u);
  EXPECT_EQ(root.at("b").elements()[2].integer(), -3);
  EXPECT_EQ(root.at("b").elements()[1].path(), "/b/1");
  EXPECT_EQ(root.file(), "f");
  EXPECT_NO_THROW(root.allow_only({"a", "b", "c"}));
  EXPECT_FALSE(root.find("t"));
  ASSERT_TRUE(root.find("a"));
  EXPECT_EQ(root.find("a")->at("t").text(), "text");
}

TEST(JsonNode, RefusalsSayWhatWasFound) {
  using Node = const JsonNode&;
  EXPECT_EQ(refusal("[1, 2]", [](Node n) { n.at("a"); }), "f: /: found an array of 2, expected an object");
  EXPECT_EQ(refusal("[]", [](Node n) { n.keys(); }), "f: /: found an array of 0, expected an object");
  EXPECT_EQ(refusal("[]", [](Node n) { n.find("a"); }), "f: /: found an array of 0, expected an object");
  EXPECT_EQ(refusal("7", [](Node n) { n.fail("a miracle"); }), "f: /: found 7, expected a miracle");
  EXPECT_EQ(refusal("{}", [](Node n) { n.at("a"); }), "f: /: found no key \"a\", expected it");
  EXPECT_EQ(refusal("{\"a\": 1, \"c\": 1}",
                    [](Node n) {
                      n.allow_only({"a", "b"});
                    }),
            "f: /: found unknown key \"c\", expected one of a, b");
  EXPECT_EQ(refusal("{\"a\": {}}", [](Node n) { n.at("a").elements(); }),
            "f: /a: found an object, expected an array");
  EXPECT_EQ(refusal("{\"a\": {}}", [](Node n) { n.at("a").numbers(); }),
            "f: /a: found an object, expected an array of numbers");
  EXPECT_EQ(refusal("3", [](Node n) { n.integers(); }), "f: /: found 3, expected an array of integers");
  EXPECT_EQ(refusal("3", [](Node n) { n.text(); }), "f: /: found 3, expected a text");
  EXPECT_EQ(refusal("0", [](Node n) { n.boolean(); }), "f: /: found 0, expected true or false");
  EXPECT_EQ(refusal("\"1\"", [](Node n) { n.number(); }), "f: /: found \"1\", expected a number");
  EXPECT_EQ(refusal("[1, \"x\"]", [](Node n) { n.numbers(); }), "f: /1: found \"x\", expected a number");
  EXPECT_EQ(refusal("[1, 2.0]", [](Node n) { n.integers(); }), "f: /1: found 2.0, expected an integer");
}

TEST(JsonNode, PathsAreFoundWhenAskedFor) {
  const JsonNode root = JsonNode::parse(R"([[], {}, {"a": [1, {"b": [[], 2]}], "c": 3}, {"a": [1]}])", "f");
  EXPECT_EQ(root.path(), "");
  EXPECT_EQ(root.elements()[0].path(), "/0");
  EXPECT_EQ(root.elements()[1].path(), "/1");
  EXPECT_EQ(root.elements()[2].at("a").elements()[1].at("b").elements()[1].path(), "/2/a/1/b/1");
  EXPECT_EQ(root.elements()[2].at("c").path(), "/2/c");
  EXPECT_EQ(root.elements()[3].at("a").elements()[0].path(), "/3/a/0");
  const std::string deep(100'000, '[');  // no recursion
  EXPECT_EQ(refusal(deep + std::string(deep.size(), ']'), [](const JsonNode& n) { n.elements()[0].text(); }),
            "f: /0: found an array of 1, expected a text");
}

TEST(JsonNode, OneLineOfManyIsNamed) {
  const auto text = [](const std::string& line) {
    return data_error([&] { JsonNode::parse_line(line, "f", 7).at("a").text(); });
  };
  EXPECT_EQ(text("{\"a\": \"b\"}"), "");
  EXPECT_EQ(text("{\"a\": 1}"), "f:7: /a: found 1, expected a text");
  EXPECT_EQ(text("{}"), "f:7: /: found no key \"a\", expected it");
  EXPECT_TRUE(says(text("{\"a\" 1}"), {"f:7: broken JSON: "}));
  EXPECT_EQ(text("{\"a\": 1, \"a\": 2}"), "f:7: /a: found the key \"a\" twice in one object, expected once");
}

TEST(JsonNode, TextThatEndsEarlyIsTold) {
  for (const char* cut : {"{", "{\"a\": 1", "{\"a\": \"b", "[1,", "tru", ""})
    EXPECT_THROW(parse_json(cut, "f"), JsonEndsEarly) << cut;
  for (const char* broken : {"{]", "{\"a\" 1}", "[1] 2", "nul }"}) {
    EXPECT_THROW(parse_json(broken, "f"), DataError) << broken;
    try {
      parse_json(broken, "f");
    } catch (const JsonEndsEarly& e) {
      ADD_FAILURE() << broken << ": " << e.what();
    } catch (const DataError&) {
    }
  }
}

TEST(JsonNode, WhatIsNotFiniteIsStoredAsNull) {
  using Node = const JsonNode&;
  EXPECT_EQ(finite_or_null(1.5).dump(), "1.5");
  EXPECT_EQ(finite_or_null(std::numeric_limits<double>::infinity()).dump(), "null");
  EXPECT_EQ(finite_or_null(std::optional<double>()).dump(), "null");
  EXPECT_EQ(finite_or_null(std::optional<double>(std::nan(""))).dump(), "null");
  const JsonNode root = JsonNode::parse(R"({"a": null, "b": 1e300, "c": [2, null, 1e60]})", "f");
  EXPECT_TRUE(std::isnan(root.at("a").stored_number()));
  EXPECT_FALSE(root.at("a").optional_number());
  EXPECT_EQ(root.at("b").stored_number(), 1e300);
  EXPECT_EQ(root.at("b").optional_number(), 1e300);
  const std::vector<double> list = root.at("c").stored_numbers();
  ASSERT_EQ(list.size(), 3u);
  EXPECT_EQ(list[0], 2);
  EXPECT_TRUE(std::isnan(list[1]));
  EXPECT_EQ(list[2], 1e60);
  EXPECT_EQ(refusal("{}", [](Node n) { n.stored_number(); }), "f: /: found an object, expected a number");
  EXPECT_EQ(refusal("[1, \"x\"]", [](Node n) { n.stored_numbers(); }),
            "f: /1: found \"x\", expected a number");
  EXPECT_EQ(refusal("1", [](Node n) { n.stored_numbers(); }), "f: /: found 1, expected an array of numbers");
}

TEST(JsonNode, IntegersOfEveryKind) {
  using Node = const JsonNode&;
  const auto node = [](const char* text) { return JsonNode::parse(text, "f"); };
  EXPECT_EQ(node("0").count(), 0);
  EXPECT_EQ(node("18446744073709551615").unsigned_integer(), std::numeric_limits<std::uint64_t>::max());
  EXPECT_EQ(node("2147483647").small_integer(), std::numeric_limits<int>::max());
  EXPECT_EQ(node("-2147483648").small_integer(), std::numeric_limits<int>::min());
  EXPECT_EQ(refusal("-1", [](Node n) { n.count(); }), "f: /: found -1, expected an integer >= 0");
  EXPECT_EQ(refusal("1.0", [](Node n) { n.count(); }), "f: /: found 1.0, expected an integer");
  for (const char* bad : {"-1", "1.5", "18446744073709551616"})
    EXPECT_TRUE(
        says(refusal(bad, [](Node n) { n.unsigned_integer(); }), {"expected an integer >= 0 of 64 bits"}))
        << bad;
  for (const char* bad : {"2147483648", "-2147483649"})
    EXPECT_EQ(refusal(bad, [](Node n) { n.small_integer(); }),
              std::string("f: /: found ") + bad + ", expected an integer of 32 bits");
}

TEST(JsonNode, NumbersAtTheirLimits) {
  using Node = const JsonNode&;
  const auto number = [](const char* text) { return JsonNode::parse(text, "f").number(); };
  const auto integer = [](const char* text) { return JsonNode::parse(text, "f").integer(); };
  EXPECT_EQ(number("1e50"), 1e50);
  EXPECT_EQ(number("-1e50"), -1e50);
  EXPECT_EQ(number("7"), 7);
  EXPECT_EQ(refusal("1.1e50", [](Node n) { n.number(); }),
            "f: /: found 1.1e+50, expected a number of at most 1e+50 in size");
  EXPECT_EQ(JsonNode::parse("[1e60]", "f").numbers(), std::vector<double>{1e60});  // of any size
  EXPECT_EQ(integer("9223372036854775807"), std::numeric_limits<std::int64_t>::max());
  EXPECT_EQ(integer("-9223372036854775808"), std::numeric_limits<std::int64_t>::min());
  EXPECT_EQ(refusal("9223372036854775808", [](Node n) { n.integer(); }),
            "f: /: found 9223372036854775808, expected an integer");
  EXPECT_EQ(JsonNode::parse("[0, 5, -1]", "f").integers(), (std::vector<std::int64_t>{0, 5, -1}));
}

}  // namespace
}  // namespace odobench
