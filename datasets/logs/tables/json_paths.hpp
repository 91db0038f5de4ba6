// The values of one JSON text by their paths, "a.b", "data[0]": read event by event, no tree of the document.
#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

namespace odobench {

// What a line says at one path.
struct JsonLeaf {
  enum class Kind { Nothing, Whole, Real, Bool, Text };
  Kind kind = Kind::Nothing;  // Nothing for null
  std::int64_t line = 0;      // of the file; older than the current one: this line has none
  std::int64_t whole = 0;     // Whole, Bool
  double real = 0;            // Whole, Real, Bool
  std::string text;           // Text, and the digits of Real where text is kept
};

// Receives the events of nlohmann::json::sax_parse. Nodes are paths; node 0 is the whole document.
class JsonPaths : public nlohmann::json_sax<nlohmann::json> {
 public:
  static constexpr std::size_t kDeepest = 32, kNone = static_cast<std::size_t>(-1);

  // `grow`: every path gets a node (of arrays the first 16 elements; at most 10,000 nodes); else only those
  // of add().
  explicit JsonPaths(bool grow) : nodes_(1), leaves_(1), grow_(grow) {}

  // The node of "a.b[2].c".
  std::size_t add(std::string_view path, bool keep_text);
  // Reads a line into the leaves. DataError as of parse_json(), or for a line nested deeper than 32.
  void parse(std::string_view text, const std::string& file, std::size_t line);

  // Nodes that got a value in the line read last, in its order.
  const std::vector<std::size_t>& seen() const { return seen_; }
  const JsonLeaf& leaf(std::size_t node) const { return leaves_[node]; }
  bool has(std::size_t node) const {
    return leaves_[node].line == line_ && leaves_[node].kind != JsonLeaf::Kind::Nothing;
  }
  std::string path(std::size_t node) const;

  bool null() override;
  bool boolean(bool value) override;
  bool number_integer(number_integer_t value) override;
  bool number_unsigned(number_unsigned_t value) override;
  bool number_float(number_float_t value, const string_t& digits) override;
  bool string(string_t& value) override;
  bool binary(binary_t& value) override;
  bool start_object(std::size_t size) override;
  bool key(string_t& value) override;
  bool end_object() override;
  bool start_array(std::size_t size) override;
  bool end_array() override;
  bool parse_error(std::size_t at, const std::string& token,
                   const nlohmann::detail::exception& error) override;

 private:
  struct Node {
    std::string key;        // of an object
    std::size_t index = 0;  // of an array
    bool in_array = false, keep_text = false;
    std::size_t parent = kNone;
    std::vector<std::size_t> children;
    std::size_t next_child = 0;  // where the next key is looked for first: lines have their keys in one order
  };
  struct Level {
    std::size_t node;  // kNone: not wanted, with all below it
    bool array;
    std::size_t index;
  };

  std::size_t new_node(std::size_t parent, const Node& node);
  std::size_t member(std::size_t parent, std::string_view key, bool make);
  std::size_t element(std::size_t parent, std::size_t index, bool make);
  std::size_t take_node();
  JsonLeaf* take_leaf(JsonLeaf::Kind kind);
  bool open(bool array);
  bool close();

  std::vector<Node> nodes_;
  std::vector<JsonLeaf> leaves_;
  std::vector<Level> levels_;
  std::vector<std::size_t> seen_;
  std::size_t key_node_ = kNone;
  std::int64_t line_ = 0;
  bool grow_, too_deep_ = false, too_many_ = false;
};

}  // namespace odobench
